"""Where to step aside: a free spot near by, off everybody's way, best where robots have walked before."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import cos, dist, floor, inf, pi, sin
from typing import Protocol

from hub.floor import FloorPlan, edge_distance_m
from hub.ways import path_to_path_m, point_to_path_m
from wire.model import Vec2
from wire.outline import inside

_RINGS_M = (0.7, 1.0, 1.4, 1.9, 2.5, 3.2, 4.0)
_BEARINGS = 20
_CELL_M = 0.3
_WALL_M = 0.08
_DOOR_M = 1.05
_UNTRODDEN_M = 1.5
"""Floor nobody has walked on costs this much more way: something unseen may stand there."""
_OTHER_ROOM_M = 2.0
"""So does another room: only where one's own has no spot near by."""
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
        self._trodden: set[tuple[int, int]] = set()

    def tread(self, point_m: Vec2) -> None:
        self._trodden.add(_cell(point_m))

    def find(self, mover: Body, ways: Sequence[Way], others: Sequence[Body]) -> Vec2 | None:
        """The cheapest good spot, or None."""
        least, best = inf, None
        for ring_m in _RINGS_M:
            if least < ring_m:
                break
            for spot in _around(mover.position_m, ring_m):
                cost = self._cost(spot, mover, others)
                if cost < least and self.good(spot, mover, ways, others):
                    least, best = cost, spot
        return best

    def _cost(self, spot: Vec2, mover: Body, others: Sequence[Body]) -> float:
        """Metres to walk, with what speaks against the spot counted in; infinite when others are in between."""
        own, there = self._plan.room_at(*mover.position_m), self._room(spot)
        if there is None:
            return inf
        extra = 0.0 if _cell(spot) in self._trodden else _UNTRODDEN_M
        if own == there:
            corners: list[list[Vec2]] = [[]]
        else:
            corners = [[door.middle_m] for door in self._plan.doors if set(door.rooms) == {own, there}]
            extra += _OTHER_ROOM_M
        ways = [[mover.position_m, *middle, spot] for middle in corners]
        lengths = [sum(dist(a, b) for a, b in pairwise(w)) for w in ways if all(_passes(w, mover, o) for o in others)]
        return min(lengths, default=inf) + extra

    def _room(self, point_m: Vec2) -> str | None:
        """The room that a point is really in."""
        return next((id for id, polygon in self._plan.polygons.items() if inside(point_m, polygon)), None)

    def good(self, spot: Vec2, mover: Body, ways: Sequence[Way], others: Sequence[Body]) -> bool:
        """Whether a robot may stand there, as far as is known."""
        room = self._room(spot)
        if room is None or edge_distance_m(spot, self._plan.polygons[room]) < mover.radius_m + _WALL_M:
            return False
        if any(dist(spot, door.middle_m) < _DOOR_M for door in self._plan.doors):
            return False
        if any(point_to_path_m(spot, path) < mover.radius_m + b.radius_m + _MARGIN_M for b, path in ways):
            return False
        if any(dist(spot, other.position_m) < mover.radius_m + other.radius_m + _MARGIN_M for other in others):
            return False
        return not self._blocked(spot, mover.radius_m)


def _passes(way_m: Sequence[Vec2], mover: Body, other: Body) -> bool:
    """No nearer to a standing body on the way than now."""
    close, gap = mover.radius_m + other.radius_m, dist(mover.position_m, other.position_m)
    return path_to_path_m(way_m, [other.position_m]) >= min(close + 0.05, gap - 0.02)


def _around(middle_m: Vec2, ring_m: float) -> list[Vec2]:
    """Points all around a place."""
    angles = (2.0 * pi * turn / _BEARINGS for turn in range(_BEARINGS))
    return [(round(middle_m[0] + ring_m * cos(a), 3), round(middle_m[1] + ring_m * sin(a), 3)) for a in angles]


def _cell(point_m: Vec2) -> tuple[int, int]:
    return (floor(point_m[0] / _CELL_M), floor(point_m[1] / _CELL_M))
