"""Where to step aside: a free spot near by, off everybody's way, best where robots have walked before."""

from collections.abc import Callable, Sequence
from math import cos, floor, hypot, inf, pi, sin
from typing import Protocol

from hub.distance import Distances
from hub.floor import FloorPlan, edge_distance_m, inside
from hub.ways import path_to_path_m, point_to_path_m
from wire.model import Vec2

_RINGS_M = (0.7, 1.0, 1.4, 1.9, 2.5, 3.2, 4.0)
_BEARINGS = 20
_CELL_M = 0.3
_WALL_M = 0.08
_DOOR_M = 1.05
_UNTRODDEN_M = 1.5
"""Floor nobody has walked on costs this much more way: something unseen may stand there."""
_MARGIN_M = 0.15


class Body(Protocol):
    """A robot, as far as parking goes."""

    @property
    def id(self) -> str: ...

    @property
    def position_m(self) -> Vec2: ...

    @property
    def radius_m(self) -> float: ...


Way = tuple[Body, Sequence[Vec2]]


class Parking:
    """Remembers where robots have been."""

    def __init__(self, plan: FloorPlan, blocked: Callable[[Vec2, float], bool]) -> None:
        self._plan, self._blocked = plan, blocked
        self._distances = Distances(plan)
        self._trodden: set[tuple[int, int]] = set()

    def tread(self, point_m: Vec2) -> None:
        self._trodden.add(_cell(point_m))

    def find(self, mover: Body, ways: Sequence[Way], others: Sequence[Body]) -> Vec2 | None:
        """The cheapest good spot, or None: straight ahead if there is one, else where the robot has to find a way."""
        return self._cheapest(mover, ways, others, True) or self._cheapest(mover, ways, others, False)

    def _cheapest(self, mover: Body, ways: Sequence[Way], others: Sequence[Body], straight: bool) -> Vec2 | None:
        least, best = inf, None
        for ring_m in _RINGS_M:
            if least < ring_m:
                break
            for spot in _around(mover.position_m, ring_m):
                cost = self._distances.walk_m(mover.position_m, spot)
                cost += 0.0 if _cell(spot) in self._trodden else _UNTRODDEN_M
                if cost >= least or (straight and not self._straight(spot, mover, others)):
                    continue
                if self.good(spot, mover, ways, others):
                    least, best = cost, spot
        return best

    def good(self, spot: Vec2, mover: Body, ways: Sequence[Way], others: Sequence[Body]) -> bool:
        """Whether a robot may stand there, as far as is known."""
        polygon = next((p for p in self._plan.polygons.values() if inside(spot, p)), None)
        if polygon is None or edge_distance_m(spot, polygon) < mover.radius_m + _WALL_M:
            return False
        doors = self._plan.doors
        if any(hypot(spot[0] - d.middle_m[0], spot[1] - d.middle_m[1]) < _DOOR_M for d in doors):
            return False
        if any(point_to_path_m(spot, path) < mover.radius_m + b.radius_m + _MARGIN_M for b, path in ways):
            return False
        if any(_apart_m(spot, other.position_m) < mover.radius_m + other.radius_m + _MARGIN_M for other in others):
            return False
        return not self._blocked(spot, mover.radius_m)

    def _straight(self, spot: Vec2, mover: Body, others: Sequence[Body]) -> bool:
        """Whether nothing is known to be between a robot and a spot in its own room."""
        room = self._plan.room_at(*mover.position_m)
        if room is None or not inside(spot, self._plan.polygons[room]):
            return False
        return all(self._passes(spot, mover, other) for other in others)

    def _passes(self, spot: Vec2, mover: Body, other: Body) -> bool:
        """No nearer to a standing body on the way there than now."""
        close, gap = mover.radius_m + other.radius_m, _apart_m(mover.position_m, other.position_m)
        return path_to_path_m([mover.position_m, spot], [other.position_m]) >= min(close + 0.05, gap - 0.02)


def _around(middle_m: Vec2, ring_m: float) -> list[Vec2]:
    """Points all around a place."""
    angles = (2.0 * pi * turn / _BEARINGS for turn in range(_BEARINGS))
    return [(round(middle_m[0] + ring_m * cos(a), 3), round(middle_m[1] + ring_m * sin(a), 3)) for a in angles]


def _apart_m(a: Vec2, b: Vec2) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


def _cell(point_m: Vec2) -> tuple[int, int]:
    return (floor(point_m[0] / _CELL_M), floor(point_m[1] / _CELL_M))
