"""The floor as a grid: walls from the site file, furniture from the lidar, how far every place is from the nearest."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, hypot, pi, remainder
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wire.messages.driver import LaserScan
from wire.model import Vec2
from wire.site import Door, Site, Wall

CELL_M = 0.1
MARGIN_M = 0.3
REACH_M = 1.0
"""Clearances are exact up to here."""
HIT, MISS, MOST, SOLID = 0.5, -0.25, 3.0, 0.7
"""Two hits make an obstacle; a beam that passes weakens it, up to twelve of them clear it."""
ENOUGH = 12
"""After so many equal sweeps neither hits nor misses change anything any more."""
NOTE_AGAIN_S = 1.0
"""Even so what is there is noted as still there."""
STOOD_M = 0.05
"""Between two sweeps from one place the robot's own idea of where it is wanders by less."""
SHORT_OF_HIT_M = 0.15
WALL_SKIN_M = 0.12
"""A beam that ends this near to a wall has hit the wall."""
OTHER_ROBOT_M, OTHER_BODY_M = 0.6, 0.42
"""What is seen this near to where another robot was said to be is that robot, and what is marked within its body too."""
TRUSTED_M = 3.4
"""What is seen further off may be a robot of which the traffic has not told yet."""
ON_WALL_END_M, WALL_FACE_M = 0.2, 0.03
ON_WALL_M = 0.12
"""A door whose jambs are this near to a wall's line is a gap in it."""

Grid = NDArray[np.float32]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Cell:
    """Row 0 is the south-most."""

    row: int
    column: int


class FloorMap:
    """What a robot knows of where it can go. Deterministic: the same scans make the same map."""

    def __init__(self, site: Site) -> None:
        corners = np.array([p for room in site.room for p in room.polygon_m])
        self._origin = corners.min(axis=0) - MARGIN_M
        size = corners.max(axis=0) + MARGIN_M - self._origin
        self.columns, self.rows = ceil(size[0] / CELL_M), ceil(size[1] / CELL_M)
        x = self._origin[0] + (np.arange(self.columns) + 0.5) * CELL_M
        y = self._origin[1] + (np.arange(self.rows) + 0.5) * CELL_M
        self._x, self._y = np.meshgrid(x, y)
        self.walls_m: Grid = np.full((self.rows, self.columns), REACH_M, np.float32)
        for wall in site.wall:
            for start_m, end_m in without_doors(wall, site.door):
                self.walls_m = np.minimum(self.walls_m, self._to_wall(start_m, end_m, wall.thickness_m))
        self._weight: Grid = np.zeros((self.rows, self.columns), np.float32)
        self._seen_s: Grid = np.zeros((self.rows, self.columns), np.float32)
        self._hit_m = np.zeros((self.rows, self.columns, 2), np.float32)
        self._window = _window(ceil(REACH_M / CELL_M))
        self._last: LaserScan | None = None
        self._repeats, self._noted_s = 0, 0.0
        self._obstacles: Grid | None = None
        self._hits: NDArray[np.float32] | None = None

    def cell(self, point_m: Vec2) -> Cell:
        """The cell of a point; a point outside gets the nearest."""
        column = int((point_m[0] - self._origin[0]) // CELL_M)
        row = int((point_m[1] - self._origin[1]) // CELL_M)
        return Cell(min(max(row, 0), self.rows - 1), min(max(column, 0), self.columns - 1))

    def centre_m(self, cell: Cell) -> Vec2:
        return self.centre_of(cell.row, cell.column)

    def centre_of(self, row: int, column: int) -> Vec2:
        return (float(self._x[row, column]), float(self._y[row, column]))

    def cells_of(self, points_m: NDArray[np.floating[Any]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """(rows, columns) of many points; points outside get the nearest cells."""
        columns, rows, _ = self._indices(points_m)
        return rows, columns

    def inside(self, polygon_m: Sequence[Vec2]) -> Mask:
        """Cells whose centre lies in the polygon."""
        result = np.zeros((self.rows, self.columns), np.bool_)
        for (x0, y0), (x1, y1) in zip(polygon_m, [*polygon_m[1:], polygon_m[0]], strict=True):
            if y0 != y1:
                crosses = (self._y >= min(y0, y1)) & (self._y < max(y0, y1))
                result ^= crosses & (self._x < x0 + (self._y - y0) / (y1 - y0) * (x1 - x0))
        return result

    def distance_m(self, point_m: Vec2) -> Grid:
        """From every cell's centre to the point."""
        distances: Grid = np.hypot(self._x - point_m[0], self._y - point_m[1]).astype(np.float32)
        return distances

    def see(self, scan: LaserScan, others_m: Iterable[Vec2] = ()) -> None:
        """Mark where beams end and weaken what they pass. Other robots are not furniture."""
        if self._says_nothing_new(scan):
            return
        ranges = np.array(scan.ranges_m)
        angles = scan.yaw_rad + scan.angle_min_rad + scan.angle_step_rad * np.arange(len(ranges))
        ray = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        origin = np.array(scan.position_enu_m[:2])
        self._pass(origin, ray, np.where(ranges > 0.0, ranges, scan.range_max_m) - SHORT_OF_HIT_M)
        ends = (origin + ray * ranges[:, None])[(ranges > 0.0) & (ranges < TRUSTED_M)]
        for other_m in others_m:
            self._clear_under(other_m)
            ends = ends[np.hypot(ends[:, 0] - other_m[0], ends[:, 1] - other_m[1]) > OTHER_ROBOT_M]
        self.mark(ends, scan.stamp_s)

    def _says_nothing_new(self, scan: LaserScan) -> bool:
        """It is the same sweep again, of a robot that stands, often enough that every weight has come to its end."""
        last, self._last = self._last, scan
        same = last is not None and last.ranges_m == scan.ranges_m and _moved_m(last, scan) < STOOD_M
        self._repeats = self._repeats + 1 if same else 0
        if self._repeats > ENOUGH and scan.stamp_s - self._noted_s < NOTE_AGAIN_S:
            return True
        self._noted_s = scan.stamp_s
        return False

    def mark(self, ends_m: NDArray[np.float64], now_s: float, weight: float = HIT) -> None:
        """There is something at these points."""
        columns, rows, known = self._indices(ends_m)
        fresh = known & (self.walls_m[rows, columns] > WALL_SKIN_M)
        rows, columns, ends_m = rows[fresh], columns[fresh], ends_m[fresh]
        cells, first = np.unique(rows * self.columns + columns, return_index=True)
        flat = self._weight.reshape(-1)
        flat[cells] = np.minimum(flat[cells] + weight, max(weight, MOST))
        self._seen_s.reshape(-1)[cells] = now_s
        self._hit_m.reshape(-1, 2)[cells] = ends_m[first]
        self._changed()

    def forget(self, before_s: float) -> None:
        """Drop obstacles not seen since: things move, and a blocked way is worth another look."""
        self._weight[self._seen_s < before_s] = 0.0
        self._changed()

    def _clear_under(self, other_m: Vec2) -> None:
        """No furniture is where another robot stands: what was marked there was the robot, seen before it was told of.

        Beams end at its body, so that while it stays none would pass through these places and clear them.
        """
        low = self.cell((other_m[0] - OTHER_BODY_M, other_m[1] - OTHER_BODY_M))
        high = self.cell((other_m[0] + OTHER_BODY_M, other_m[1] + OTHER_BODY_M))
        around = np.s_[low.row : high.row + 1, low.column : high.column + 1]
        weight = self._weight[around]
        away_m = np.hypot(self._x[around] - other_m[0], self._y[around] - other_m[1])
        under = (weight > 0.0) & (away_m.astype(np.float32) < OTHER_BODY_M)
        if under.any():
            weight[under] = 0.0
            self._changed()

    @property
    def obstacles_m(self) -> Grid:
        """From every cell's centre to the nearest obstacle that was seen, at most REACH_M."""
        if self._obstacles is None:
            self._obstacles = self._measure()
        return self._obstacles

    @property
    def clearance_m(self) -> Grid:
        """From every cell's centre to the nearest wall or obstacle, at most REACH_M."""
        return np.minimum(self.walls_m, self.obstacles_m)

    def room_m(self, start_m: Vec2, end_m: Vec2) -> float:
        """From a straight line to the nearest obstacle that was seen: cheap enough for every step."""
        if self._hits is None:
            self._hits = self._hit_m[self._weight >= SOLID]
        along = np.subtract(end_m, start_m)
        away = self._hits - np.array(start_m, np.float32)
        t = np.clip(away @ along / max(float(along @ along), 1e-9), 0.0, 1.0)
        gaps = away - t[:, None] * along
        return float(np.sqrt((gaps**2).sum(axis=1).min(initial=REACH_M**2)))

    def clear_of_walls(self, start_m: Vec2, end_m: Vec2) -> bool:
        """Whether the straight line crosses no wall of the site. The thing at its end may hang on a wall."""
        length = hypot(end_m[0] - start_m[0], end_m[1] - start_m[1])
        share = max(0.0, 1.0 - ON_WALL_END_M / max(length, 1e-6))
        short = (start_m[0] + share * (end_m[0] - start_m[0]), start_m[1] + share * (end_m[1] - start_m[1]))
        return bool((self.along(self.walls_m, start_m, short) > WALL_FACE_M).all())

    def along(self, grid: Grid, start_m: Vec2, end_m: Vec2) -> Grid:
        """The grid's values along a straight line, every half cell."""
        count = max(2, ceil(2.0 * hypot(end_m[0] - start_m[0], end_m[1] - start_m[1]) / CELL_M) + 1)
        points = np.linspace(start_m, end_m, count)
        columns, rows, _ = self._indices(points)
        values: Grid = grid[rows, columns]
        return values

    def _indices(self, points_m: NDArray[np.floating[Any]]) -> tuple[NDArray[np.int64], NDArray[np.int64], Mask]:
        index = self._whole_cells(points_m - self._origin)
        columns, rows = index[:, 0], index[:, 1]
        known = (columns >= 0) & (columns < self.columns) & (rows >= 0) & (rows < self.rows)
        return np.clip(columns, 0, self.columns - 1), np.clip(rows, 0, self.rows - 1), known

    def _whole_cells(self, offset_m: NDArray[np.floating[Any]]) -> NDArray[np.int64]:
        return np.asarray(np.floor(offset_m / CELL_M), np.int64)

    def _pass(self, origin: NDArray[np.float64], ray: NDArray[np.float64], free_m: NDArray[np.float64]) -> None:
        steps = np.arange(0.0, float(free_m.max(initial=0.0)), CELL_M)
        free = steps < free_m[:, None]
        columns = self._whole_cells((origin[0] + ray[:, :1] * steps)[free] - self._origin[0])
        rows = self._whole_cells((origin[1] + ray[:, 1:] * steps)[free] - self._origin[1])
        known = (columns >= 0) & (columns < self.columns) & (rows >= 0) & (rows < self.rows)
        passed = np.zeros(self._weight.size, np.bool_)
        passed[(rows * self.columns + columns)[known]] = True
        weight = self._weight.reshape(-1)
        weakened = np.flatnonzero(passed & (weight > 0.0))
        weight[weakened] = np.maximum(weight[weakened] + MISS, 0.0)
        self._changed()

    def _changed(self) -> None:
        self._obstacles = self._hits = None

    def _to_wall(self, start_m: Vec2, end_m: Vec2, thickness_m: float) -> Grid:
        """Distance of every cell's centre to a straight piece of wall, which ends flush at its jambs."""
        length = max(hypot(end_m[0] - start_m[0], end_m[1] - start_m[1]), 1e-9)
        ux, uy = (end_m[0] - start_m[0]) / length, (end_m[1] - start_m[1]) / length
        dx, dy = self._x - (start_m[0] + end_m[0]) / 2.0, self._y - (start_m[1] + end_m[1]) / 2.0
        beyond = np.maximum(np.abs(dx * ux + dy * uy) - length / 2.0, 0.0)
        beside = np.maximum(np.abs(dy * ux - dx * uy) - thickness_m / 2.0, 0.0)
        distances: Grid = np.hypot(beyond, beside).astype(np.float32)
        return distances

    def _measure(self) -> Grid:
        result: Grid = np.full_like(self.walls_m, REACH_M)
        rows, columns = np.nonzero(self._weight >= SOLID)
        near_rows = (rows[:, None] + self._window[:, 0]).ravel()
        near_columns = (columns[:, None] + self._window[:, 1]).ravel()
        inside = (near_rows >= 0) & (near_rows < self.rows) & (near_columns >= 0) & (near_columns < self.columns)
        near_rows, near_columns = near_rows[inside], near_columns[inside]
        hits = np.repeat(self._hit_m[rows, columns], len(self._window), axis=0)[inside]
        gaps = np.hypot(self._x[near_rows, near_columns] - hits[:, 0], self._y[near_rows, near_columns] - hits[:, 1])
        np.minimum.at(result, (near_rows, near_columns), gaps.astype(np.float32))
        return result


def _window(radius: int) -> NDArray[np.int64]:
    """Offsets of the cells within a radius."""
    span = np.arange(-radius, radius + 1)
    rows, columns = np.meshgrid(span, span, indexing="ij")
    near = np.hypot(rows, columns) <= radius
    offsets: NDArray[np.int64] = np.stack([rows[near], columns[near]], axis=1)
    return offsets


def _moved_m(before: LaserScan, after: LaserScan) -> float:
    """How far the ends of beams of the same ranges are apart, at most."""
    away_m = hypot(*(a - b for a, b in zip(after.position_enu_m[:2], before.position_enu_m[:2], strict=True)))
    return away_m + TRUSTED_M * abs(remainder(after.yaw_rad - before.yaw_rad, 2.0 * pi))


def without_doors(wall: Wall, doors: Iterable[Door]) -> list[tuple[Vec2, Vec2]]:
    """The solid pieces of a wall, whether the site file draws it through its doors or not."""
    (x0, y0), (x1, y1) = wall.start_m, wall.end_m
    length = max(hypot(x1 - x0, y1 - y0), 1e-9)
    ux, uy = (x1 - x0) / length, (y1 - y0) / length
    gaps = []
    for door in doors:
        jambs = [((x - x0) * ux + (y - y0) * uy, (y - y0) * ux - (x - x0) * uy) for x, y in (door.start_m, door.end_m)]
        if all(abs(beside) < ON_WALL_M for _, beside in jambs):
            gaps.append(sorted(along for along, _ in jambs))
    pieces, here = [], 0.0
    for begin, end in [*sorted(gaps), [length, length]]:
        stop = min(begin, length)
        if stop > here + 1e-6:
            pieces.append(((x0 + here * ux, y0 + here * uy), (x0 + stop * ux, y0 + stop * uy)))
        here = max(here, end)
    return pieces
