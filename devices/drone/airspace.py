"""Where a drone may be: inside rooms, clear of walls, below ceilings and lintels, clear of tall things."""

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor, hypot, inf

from devices.drone.outlines import Outline
from wire.model import Vec2, Vec3
from wire.outline import segment_distance_m, spans
from wire.site import UNDER_CEILING_M, Door, Site, Wall

CELL_M = 0.1
NEEDED_M, WANTED_M = 0.35, 0.7
"""From the middle of the drone to a wall: at least, and where there is room."""
UNDER_LINTEL_M = 0.3
LEAST_HEIGHT_M = 0.4
DOORWAY_M = 0.6
"""The drone is under a lintel this far from the middle line of a door."""
OVER_THING_M = 0.35
ON_WALL_M = 0.3
BODY_M = 0.15
"""What stands nearer to its middle would be touched by its body, wherever that is a little out."""

Cell = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A thing that stands in the way up to a height."""

    outline: Outline
    top_m: float


class Airspace:
    """A grid of squares over the building, each with its distance to the nearest wall."""

    def __init__(self, site: Site) -> None:
        points = [p for room in site.room for p in room.polygon_m]
        self._west_m = min(p[0] for p in points) - CELL_M
        self._south_m = min(p[1] for p in points) - CELL_M
        self.rooms, self.doors = site.room, site.door
        self._top_m: dict[Cell, float] = {}
        self._wall_m: dict[Cell, float] = {}
        for room in site.room:
            self._fill(room.polygon_m, room.height_m)
        for door in site.door:
            self._open(door)
        for wall in site.wall:
            self._keep_clear_of(wall)
        self.obstacles: Mapping[str, Obstacle] = {}

    def cell(self, point_m: Vec2 | Vec3) -> Cell:
        return (floor((point_m[0] - self._west_m) / CELL_M), floor((point_m[1] - self._south_m) / CELL_M))

    def centre_m(self, cell: Cell) -> Vec2:
        return (self._west_m + (cell[0] + 0.5) * CELL_M, self._south_m + (cell[1] + 0.5) * CELL_M)

    def wall_m(self, cell: Cell) -> float:
        """Room around a square's middle before a wall, as far as it matters; negative outside the building."""
        return self._wall_m.get(cell, WANTED_M) if cell in self._top_m else -inf

    def top_m(self, point_m: Vec2 | Vec3) -> float:
        """The greatest height at which a drone may be over a point."""
        return self._top_m.get(self.cell(point_m), -inf)

    def fault(self, point_m: Vec3) -> str:
        """Why a drone cannot be at a point, in a sentence; empty when it can."""
        place = f"({point_m[0]:.1f}, {point_m[1]:.1f})"
        cell = self.cell(point_m)
        if cell not in self._top_m:
            return f"{place} is outside the rooms of the site"
        if self.wall_m(cell) < NEEDED_M:
            return f"{place} is {max(0.0, self.wall_m(cell)):.1f} m from a wall; a drone needs {NEEDED_M:.2f} m"
        if point_m[2] > self.top_m(point_m) + 1e-6:
            return f"{point_m[2]:.1f} m is too high at {place}: at most {self.top_m(point_m):.1f} m there"
        if point_m[2] < LEAST_HEIGHT_M - 1e-6:
            return f"{point_m[2]:.1f} m is too low at {place}: at least {LEAST_HEIGHT_M:.1f} m"
        thing = self.thing_at(point_m)
        return f"{thing} stands at {place}, {self.obstacles[thing].top_m:.1f} m high" if thing else ""

    def thing_at(self, point_m: Vec3) -> str:
        """What a drone at this point would be in or too near to."""
        return next((id for id, thing in self._in_the_way(point_m[2]) if _touches(thing, point_m)), "")

    def open_cells(self, height_m: float, from_m: Vec3 | None = None) -> set[Cell]:
        """Squares over whose middles a drone may be at that height. Nothing is where a drone is: what `from_m`, where
        one is, lies in, is believed to be elsewhere than it is."""
        open = {
            cell
            for cell, top_m in self._top_m.items()
            if top_m >= height_m - 1e-6 and self._wall_m.get(cell, WANTED_M) >= NEEDED_M
        }
        for _, thing in self._in_the_way(height_m):
            if from_m is not None and from_m[2] < thing.top_m and thing.outline.distance_m(from_m[:2]) < BODY_M:
                continue
            reach = ceil((thing.outline.reach_m + NEEDED_M) / CELL_M)
            x, y = self.cell(thing.outline.middle_m)
            around = ((x + i, y + j) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1))
            open.difference_update(cell for cell in around if _touches(thing, self.centre_m(cell)))
        return open

    def without_things(self) -> "Airspace":
        """The same building, empty."""
        empty = copy(self)
        empty.obstacles = {}
        return empty

    def in_the_way(self, corners_m: Sequence[Vec3]) -> list[str]:
        """What stands in a way given by its corners."""
        return [
            id
            for id, thing in self.obstacles.items()
            if any(
                thing.top_m + OVER_THING_M > min(a[2], b[2]) and thing.outline.way_distance_m(a[:2], b[:2]) < NEEDED_M
                for a, b in pairwise(corners_m)
            )
        ]

    def first_fault(self, points_m: Iterable[Vec3]) -> str:
        """What is wrong with the first point of a curve at which something is."""
        return next((fault for point in points_m if (fault := self.fault(point))), "")

    def in_sight(self, from_m: Vec2 | Vec3, point_m: Vec2) -> bool:
        """Whether no wall is between; what hangs on a wall is in front of it."""
        dx, dy = point_m[0] - from_m[0], point_m[1] - from_m[1]
        length = hypot(dx, dy)
        count = ceil(max(0.0, length - ON_WALL_M) / (CELL_M / 2.0))
        shares = (k * CELL_M / 2.0 / length for k in range(count))
        return all(self.wall_m(self.cell((from_m[0] + s * dx, from_m[1] + s * dy))) > CELL_M / 2.0 for s in shares)

    def _in_the_way(self, height_m: float) -> Iterable[tuple[str, Obstacle]]:
        return ((id, thing) for id, thing in self.obstacles.items() if thing.top_m + OVER_THING_M > height_m)

    def _fill(self, polygon_m: tuple[Vec2, ...], height_m: float) -> None:
        """The squares whose middles are in a room."""
        low, high = (self.cell((0.0, edge(p[1] for p in polygon_m)))[1] for edge in (min, max))
        for row in range(low, high + 1):
            y = self.centre_m((0, row))[1]
            for a, b in spans(polygon_m, y):
                for column in range(self.cell((a, y))[0], self.cell((b, y))[0] + 1):
                    if a <= self.centre_m((column, row))[0] <= b:
                        self._top_m[column, row] = height_m - UNDER_CEILING_M

    def _open(self, door: Door) -> None:
        """Low under the lintel; part of the building where the polygons of its rooms do not meet, too."""
        for cell in self._around(door.start_m, door.end_m, DOORWAY_M):
            away_m, top_m = (
                segment_distance_m(self.centre_m(cell), door.start_m, door.end_m),
                door.height_m - UNDER_LINTEL_M,
            )
            if away_m < DOORWAY_M and (cell in self._top_m or away_m < DOORWAY_M / 2.0):
                self._top_m[cell] = min(top_m, self._top_m.get(cell, top_m))

    def _keep_clear_of(self, wall: Wall) -> None:
        for cell in self._around(wall.start_m, wall.end_m, WANTED_M + wall.thickness_m):
            away_m = segment_distance_m(self.centre_m(cell), wall.start_m, wall.end_m) - wall.thickness_m / 2.0
            if away_m < self._wall_m.get(cell, WANTED_M):
                self._wall_m[cell] = away_m

    def _around(self, a_m: Vec2, b_m: Vec2, margin_m: float) -> Iterable[Cell]:
        west, south = self.cell((min(a_m[0], b_m[0]) - margin_m, min(a_m[1], b_m[1]) - margin_m))
        east, north = self.cell((max(a_m[0], b_m[0]) + margin_m, max(a_m[1], b_m[1]) + margin_m))
        return ((i, j) for i in range(west, east + 1) for j in range(south, north + 1))


def _touches(thing: Obstacle, point_m: Vec2 | Vec3) -> bool:
    return thing.outline.distance_m(point_m[:2]) < NEEDED_M
