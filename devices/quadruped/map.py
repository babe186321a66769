"""What a robot knows of the floor: walls from the site file, furniture from the lidar, how far the nearest is.

Only the cells in which something was seen are kept, a few hundred of ten thousand: a sweep costs as much as its beams.
"""

from array import array
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from math import asin, atan2, ceil, cos, floor, hypot, inf, pi, remainder, sin, sqrt, tau

from devices.quadruped.grid import CELL_M, Cell, CellGrid, Grid
from wire.messages.driver import LaserScan
from wire.model import Vec2
from wire.site import Door, Site, Wall

REACH_M, ASKED_M = 1.0, 0.8
"""Distances are told up to the first; those of cells to obstacles are exact up to the second, more than anybody needs."""
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
DIAGONAL_M = CELL_M * sqrt(2.0)
SECTORS = 32
PER_RAD = SECTORS / tau
ONE_SECTOR_M = DIAGONAL_M / sin(tau / SECTORS)
"""A cell further off than this reaches no further than into the sectors beside its own."""
ON_WALL_END_M, WALL_FACE_M = 0.2, 0.03
ON_WALL_M = 0.12
"""A door whose jambs are this near to a wall's line is a gap in it."""


@dataclass(slots=True)
class Mark:
    """Something that was seen in one cell."""

    weight: float
    seen_s: float
    point_m: Vec2


class FloorMap(CellGrid):
    """What a robot knows of where it can go. Deterministic: the same scans make the same map."""

    def __init__(self, site: Site) -> None:
        super().__init__(site)
        self.walls_m: Grid = array("f", [REACH_M]) * self.size
        for wall in site.wall:
            for start_m, end_m in without_doors(wall, site.door):
                self._build(start_m, end_m, wall.thickness_m)
        self._marks: dict[Cell, Mark] = {}
        self._last: LaserScan | None = None
        self._repeats, self._noted_s = 0, 0.0
        self._clearance: Grid | None = None
        self._near: dict[tuple[int, int], list[Vec2]] | None = None

    def see(self, scan: LaserScan, others_m: Iterable[Vec2] = ()) -> None:
        """Mark where beams end and weaken what they pass. Other robots are not furniture."""
        if self._says_nothing_new(scan):
            return
        x, y = scan.position_enu_m[:2]
        first_rad = scan.yaw_rad + scan.angle_min_rad
        angles_rad = [first_rad + scan.angle_step_rad * k for k in range(len(scan.ranges_m))]
        beams = [(a, cos(a), sin(a), r) for a, r in zip(angles_rad, scan.ranges_m, strict=True)]
        self._pass((x, y), [(a, dx, dy, (r or scan.range_max_m) - SHORT_OF_HIT_M) for a, dx, dy, r in beams])
        ends = [(x + dx * r, y + dy * r) for _, dx, dy, r in beams if 0.0 < r < TRUSTED_M]
        for other_m in others_m:
            self._clear_under(other_m)
            ends = [end for end in ends if hypot(end[0] - other_m[0], end[1] - other_m[1]) > OTHER_ROBOT_M]
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

    def mark(self, ends_m: Iterable[Vec2], now_s: float, weight: float = HIT) -> None:
        """There is something at these points; those in one cell count once."""
        fresh: dict[Cell, Vec2] = {}
        for end_m in ends_m:
            cell = self.cell_inside(end_m)
            if cell is not None and self.walls_m[cell] > WALL_SKIN_M:
                fresh.setdefault(cell, end_m)
        for cell, end_m in fresh.items():
            known = self._marks.get(cell)
            before = known.weight if known else 0.0
            self._marks[cell] = Mark(min(before + weight, max(weight, MOST)), now_s, end_m)
        self._changed()

    def forget(self, before_s: float) -> None:
        """Drop obstacles not seen since: things move, and a blocked way is worth another look."""
        self._drop([cell for cell, mark in self._marks.items() if mark.seen_s < before_s])

    def _clear_under(self, other_m: Vec2) -> None:
        """No furniture is where another robot stands: what was marked there was the robot, seen before it was told of.

        Beams end at its body, so that while it stays none would pass through these places and clear them.
        """
        self._drop(
            [c for c, away_m in self.around(other_m, OTHER_BODY_M) if c in self._marks and away_m < OTHER_BODY_M]
        )

    @property
    def clearance_m(self) -> Grid:
        """From every cell's centre to the nearest wall or obstacle that was seen, at most REACH_M."""
        if self._clearance is None:
            self._clearance = self._measure()
        return self._clearance

    def room_m(self, start_m: Vec2, end_m: Vec2) -> float:
        """From a straight line to the nearest obstacle that was seen, at most REACH_M: cheap enough for every step."""
        (x0, y0), (x1, y1) = start_m, end_m
        dx, dy = x1 - x0, y1 - y0
        square = max(dx * dx + dy * dy, 1e-9)
        least = REACH_M**2
        for x, y in self._obstacles_by(start_m, end_m):
            t = min(max(((x - x0) * dx + (y - y0) * dy) / square, 0.0), 1.0)
            beside_x, beside_y = x - x0 - t * dx, y - y0 - t * dy
            least = min(least, beside_x * beside_x + beside_y * beside_y)
        return sqrt(least)

    def clear_of_walls(self, start_m: Vec2, end_m: Vec2) -> bool:
        """Whether the straight line crosses no wall of the site. The thing at its end may hang on a wall."""
        length = hypot(end_m[0] - start_m[0], end_m[1] - start_m[1])
        share = max(0.0, 1.0 - ON_WALL_END_M / max(length, 1e-6))
        short = (start_m[0] + share * (end_m[0] - start_m[0]), start_m[1] + share * (end_m[1] - start_m[1]))
        return all(self.walls_m[cell] > WALL_FACE_M for cell in self.along(start_m, short))

    def _pass(self, origin_m: Vec2, beams: list[tuple[float, float, float, float]]) -> None:
        """Weaken what lies under beams (bearing, dx, dy, length in metres) from one point; each cell once."""
        if not self._marks or self.cell_inside(origin_m) is None:
            return
        nearest_m = self._nearest_by_sector(origin_m)
        x, y, columns = (origin_m[0] - self.west_m) / CELL_M, (origin_m[1] - self.south_m) / CELL_M, self.columns
        edge, passed = min(x, columns - x, y, self.rows - y), set[Cell]()
        for bearing_rad, dx, dy, free_m in beams:
            begin_m = nearest_m[floor(bearing_rad * PER_RAD) % SECTORS]
            if begin_m < free_m:
                end = free_m / CELL_M
                if end > edge:
                    end = min(end, _to_edge(x, dx, columns), _to_edge(y, dy, self.rows))
                steps = range(max(0, int(begin_m / CELL_M)), ceil(end))
                passed.update([int(y + dy * k) * columns + int(x + dx * k) for k in steps])
        weakened = passed & self._marks.keys()
        for cell in weakened:
            self._marks[cell].weight += MISS
        self._drop([cell for cell in weakened if self._marks[cell].weight <= 0.0])

    def _nearest_by_sector(self, origin_m: Vec2) -> list[float]:
        """From a point, how far at least a beam in each sector goes before it comes to a cell with something in it."""
        x, y = origin_m
        far, near = [inf] * SECTORS, [inf] * SECTORS
        for mark in self._marks.values():
            dx, dy = mark.point_m[0] - x, mark.point_m[1] - y
            away_m, sector = hypot(dx, dy), floor(atan2(dy, dx) * PER_RAD) % SECTORS
            if away_m > ONE_SECTOR_M:
                if away_m < far[sector]:
                    far[sector] = away_m
                continue
            spread = ceil(asin(DIAGONAL_M / away_m) * PER_RAD) if away_m > DIAGONAL_M else SECTORS // 2
            for beside in range(sector - spread, sector + spread + 1):
                near[beside % SECTORS] = min(near[beside % SECTORS], away_m)
        ring = [far[-1], *far, far[0]]
        return [min(near[k], *ring[k : k + 3]) - DIAGONAL_M for k in range(SECTORS)]

    def _drop(self, cells: list[Cell]) -> None:
        for cell in cells:
            del self._marks[cell]
        self._changed()

    def _changed(self) -> None:
        self._clearance = self._near = None

    def _obstacles_by(self, start_m: Vec2, end_m: Vec2) -> list[Vec2]:
        """All obstacles within REACH_M of a line, and some more: they are kept by squares of that size."""
        if self._near is None:
            self._near = defaultdict(list)
            for mark in self._marks.values():
                if mark.weight >= SOLID:
                    self._near[floor(mark.point_m[0] / REACH_M), floor(mark.point_m[1] / REACH_M)].append(mark.point_m)
        west, east = sorted((floor(start_m[0] / REACH_M), floor(end_m[0] / REACH_M)))
        south, north = sorted((floor(start_m[1] / REACH_M), floor(end_m[1] / REACH_M)))
        squares = ((c, r) for c in range(west - 1, east + 2) for r in range(south - 1, north + 2))
        return [point_m for square in squares for point_m in self._near.get(square, ())]

    def _build(self, start_m: Vec2, end_m: Vec2, thickness_m: float) -> None:
        """Keep every cell's distance to a straight piece of wall, which ends flush at its jambs, where it is nearer."""
        length = max(hypot(end_m[0] - start_m[0], end_m[1] - start_m[1]), 1e-9)
        ux, uy = (end_m[0] - start_m[0]) / length, (end_m[1] - start_m[1]) / length
        middle_x, middle_y = (start_m[0] + end_m[0]) / 2.0, (start_m[1] + end_m[1]) / 2.0
        for row, columns in self.box(start_m, end_m, REACH_M + thickness_m):
            dy = self._y[row] - middle_y
            for column in columns:
                dx = self._x[column] - middle_x
                beyond = max(abs(dx * ux + dy * uy) - length / 2.0, 0.0)
                beside = max(abs(dy * ux - dx * uy) - thickness_m / 2.0, 0.0)
                cell = row * self.columns + column
                self.walls_m[cell] = min(self.walls_m[cell], hypot(beyond, beside))

    def _measure(self) -> Grid:
        squares = [gap_m * gap_m for gap_m in self.walls_m]
        for mark in self._marks.values():
            if mark.weight < SOLID:
                continue
            x, y = mark.point_m
            across: list[float] = []
            for row, columns in self.box(mark.point_m, mark.point_m, ASKED_M):
                across = across or [(self._x[column] - x) ** 2 for column in columns]
                up = (self._y[row] - y) ** 2
                for cell, right in enumerate(across, row * self.columns + columns.start):
                    if up + right < squares[cell]:
                        squares[cell] = up + right
        return array("f", map(sqrt, squares))


def _to_edge(begin: float, share: float, count: int) -> float:
    """How many cells long a beam stays on the grid, along one axis of it."""
    if share == 0.0:
        return inf
    return (count - begin) / share if share > 0.0 else -begin / share


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
