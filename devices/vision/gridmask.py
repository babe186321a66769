"""GridMask of the second paper: a coordinate grid over a picture for a vision model, and the way back to the site.

The grid's origin is the middle of the picture, x to the right, y up, in cells. Equation numbers are those of the paper.
"""

from dataclasses import dataclass
from math import atan, cos, log2, sin, tan

import cv2
import numpy as np

from devices.vision.lens import Image, Lens
from wire.model import Vec2, Vec3

USUAL_DIVISIONS = 8
"""Of the picture's width, which are the paper's 80 pixels of 640."""
FEWEST, MOST = 4, 16
DENSE_PX = 60
"""Cells smaller than this are labelled at every other vertex."""
LEAST_CELL_PX = 32
"""Labels do not fit into less."""
CELL_FROM_M, CELL_TO_M = 0.25, 1.0
"""Cells as large as things that are picked up or walked around can be counted in."""
LINE, AXIS, INK = (200, 200, 200), (235, 40, 40), (250, 220, 40)
HALO = (20, 20, 20)
MIN_DROP = 1e-3


@dataclass(frozen=True)
class Grid:
    """A grid of square cells over a picture."""

    width_px: int
    height_px: int
    cell_px: float

    @property
    def divisions(self) -> float:
        """Equation 4: how many cells the picture is wide."""
        return self.width_px / self.cell_px

    @property
    def half_width(self) -> float:
        """Cells from the middle to the right edge."""
        return self.width_px / 2.0 / self.cell_px

    @property
    def half_height(self) -> float:
        return self.height_px / 2.0 / self.cell_px

    def pixel(self, x_cells: float, y_cells: float) -> Vec2:
        """Equation 1, for any point and not the vertices alone."""
        return (self.width_px / 2.0 + x_cells * self.cell_px, self.height_px / 2.0 - y_cells * self.cell_px)

    def cells(self, u_px: float, v_px: float) -> Vec2:
        """Equation 1 the other way round."""
        return ((u_px - self.width_px / 2.0) / self.cell_px, (self.height_px / 2.0 - v_px) / self.cell_px)

    def contains(self, x_cells: float, y_cells: float) -> bool:
        """Whether a point in cells lies in the picture."""
        return abs(x_cells) <= self.half_width and abs(y_cells) <= self.half_height

    def columns(self) -> range:
        """The i of equation 1: lines that lie in the picture."""
        return _lines(self.width_px, self.cell_px, first_is_left=True)

    def rows(self) -> range:
        """The j of equation 1, upwards."""
        return _lines(self.height_px, self.cell_px, first_is_left=False)

    def labelled(self) -> list[tuple[int, int]]:
        """The vertices at which their numbers are written."""
        step = 1 if self.cell_px >= DENSE_PX else 2
        return [(i, j) for i in self.columns() for j in self.rows() if i % step == j % step == 0]


def _lines(size_px: int, cell_px: float, *, first_is_left: bool) -> range:
    """Whole numbers of cells from the middle whose line is at 0 <= pixel < size; rows count against the pixels."""
    half = size_px / 2.0 / cell_px
    before, after = int(half + 1e-9), int(np.ceil(half - 1e-9)) - 1
    return range(-before, after + 1) if first_is_left else range(-after, before + 1)


def ground_width_m(height_m: float, fov_rad: float) -> float:
    """Equation 5: how much level ground the picture of a camera that looks straight down is wide."""
    return 2.0 * height_m * tan(fov_rad / 2.0)


def cell_m(height_m: float, fov_rad: float, divisions: float) -> float:
    """Equation 6: how long a cell is on the ground."""
    return ground_width_m(height_m, fov_rad) / divisions


def fov_rad(lens: Lens) -> float:
    """Of the picture's width."""
    return 2.0 * atan(lens.width_px / 2.0 / lens.focal_px)


def grid_for(lens: Lens) -> Grid:
    """A grid as dense as resolution, field of view and altitude ask for.

    Eight cells across, halved or doubled until a cell at the distance at which the optical axis meets the ground is
    between a quarter of a metre and a metre long, as far as labels stay readable. Doubling, and not any number, so that
    a drone that rises a little does not change its grid.
    """
    far_m = lens.position_enu_m[2] / max(0.2, -float(lens.axes[2, 2]))
    length_m = cell_m(max(far_m, 0.1), fov_rad(lens), USUAL_DIVISIONS)
    steps = 0
    if length_m > CELL_TO_M:
        steps = int(np.ceil(log2(length_m / CELL_TO_M)))
    elif length_m < CELL_FROM_M:
        steps = -int(np.ceil(log2(CELL_FROM_M / length_m)))
    divisions = min(MOST, max(FEWEST, USUAL_DIVISIONS * 2.0**steps))
    while divisions > FEWEST and lens.width_px / divisions < LEAST_CELL_PX:
        divisions /= 2.0
    return Grid(lens.width_px, lens.height_px, lens.width_px / divisions)


def flat_place_m(grid: Grid, lens: Lens, x_cells: float, y_cells: float) -> Vec2:
    """Equation 7 as the paper has it: a camera that looks straight down, and things without height."""
    scale_m = cell_m(lens.position_enu_m[2], fov_rad(lens), grid.divisions)
    right_m, ahead_m = scale_m * x_cells, scale_m * y_cells
    c, s = cos(lens.yaw_rad), sin(lens.yaw_rad)
    x, y, _ = lens.position_enu_m
    return (x + c * ahead_m + s * right_m, y + s * ahead_m - c * right_m)


def place_m(grid: Grid, lens: Lens, x_cells: float, y_cells: float, height_m: float = 0.0) -> Vec3 | None:
    """Equation 7 for the camera as it really looked, and for what is `height_m` above the floor.

    A tilt of two degrees at 2.5 m moves a place by 9 cm, more than a good model errs by. None when the ray does not
    meet that height before the camera.
    """
    ray = lens.rays(*grid.pixel(x_cells, y_cells))[0]
    drop_m = lens.position_enu_m[2] - height_m
    if abs(ray[2]) < MIN_DROP or drop_m / -ray[2] <= 0.0:
        return None
    x, y, z = (np.array(lens.position_enu_m) + ray * (drop_m / -ray[2])).tolist()
    return (x, y, z)


def cells_of(grid: Grid, lens: Lens, point_enu_m: Vec3) -> Vec2 | None:
    """Where a point of the site is in the grid; None when it is not before the camera."""
    u, v, depth_m = lens.pixels(point_enu_m)[0].tolist()
    return grid.cells(u, v) if depth_m > 1e-6 else None


def draw(rgb: Image, grid: Grid) -> Image:
    """The picture with the grid over it: lines of one pixel, red axes, and `i,j` beside every vertex, or every other one
    where cells are small: labels hide what is under them."""
    drawn = rgb.copy()
    height_px, width_px = grid.height_px, grid.width_px
    for i in grid.columns():
        u = round(grid.pixel(i, 0.0)[0])
        cv2.line(drawn, (u, 0), (u, height_px - 1), AXIS if i == 0 else LINE, 1)
    for j in grid.rows():
        v = round(grid.pixel(0.0, j)[1])
        cv2.line(drawn, (0, v), (width_px - 1, v), AXIS if j == 0 else LINE, 1)
    scale = min(0.4, 0.32 * grid.cell_px / 60.0 + 0.02)
    for i, j in grid.labelled():
        u_px, v_px = grid.pixel(i, j)
        at = (round(u_px) + 2, round(v_px) - 3)
        for ink, thick in ((HALO, 2), (INK, 1)):
            cv2.putText(drawn, f"{i},{j}", at, cv2.FONT_HERSHEY_SIMPLEX, scale, ink, thick, cv2.LINE_AA)
    return drawn
