"""Where to step aside: a free spot near by, off everybody's way, best where robots have walked before."""

from collections.abc import Callable, Sequence
from math import cos, floor, hypot, pi, sin
from typing import Protocol

from hub.floor import FloorPlan, edge_distance_m
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
        self._trodden: set[tuple[int, int]] = set()

    def tread(self, point_m: Vec2) -> None:
        self._trodden.add(_cell(point_m))

    def find(self, mover: Body, ways: Sequence[Way], others: Sequence[Body]) -> Vec2 | None:
        """The cheapest good spot, or None."""
        x, y = mover.position_m
        best: tuple[float, Vec2] | None = None
        for ring_m in _RINGS_M:
            if best is not None and best[0] < ring_m:
                break
            for turn in range(_BEARINGS):
                angle = 2.0 * pi * turn / _BEARINGS
                spot = (round(x + ring_m * cos(angle), 3), round(y + ring_m * sin(angle), 3))
                cost = ring_m + (0.0 if _cell(spot) in self._trodden else _UNTRODDEN_M)
                if (best is None or cost < best[0]) and self.good(spot, mover, ways, others):
                    best = (cost, spot)
        return best[1] if best is not None else None

    def good(self, spot: Vec2, mover: Body, ways: Sequence[Way], others: Sequence[Body]) -> bool:
        """Whether a robot may stand there and can walk there straight."""
        room = self._plan.room_at(*mover.position_m)
        if room is None or self._plan.room_at(*spot) != room:
            return False
        if edge_distance_m(spot, self._plan.polygons[room]) < mover.radius_m + _WALL_M:
            return False
        doors = self._plan.doors
        if any(hypot(spot[0] - d.middle_m[0], spot[1] - d.middle_m[1]) < _DOOR_M for d in doors):
            return False
        if any(point_to_path_m(spot, path) < mover.radius_m + b.radius_m + _MARGIN_M for b, path in ways):
            return False
        if self._blocked(spot, mover.radius_m):
            return False
        return all(self._passes(spot, mover, other) for other in others)

    def _passes(self, spot: Vec2, mover: Body, other: Body) -> bool:
        """Clear of a standing body at the spot, and no nearer to it than now on the way there."""
        close = mover.radius_m + other.radius_m
        if hypot(spot[0] - other.position_m[0], spot[1] - other.position_m[1]) < close + _MARGIN_M:
            return False
        gap = hypot(mover.position_m[0] - other.position_m[0], mover.position_m[1] - other.position_m[1])
        return path_to_path_m([mover.position_m, spot], [other.position_m]) >= min(close + 0.05, gap - 0.02)


def _cell(point_m: Vec2) -> tuple[int, int]:
    return (floor(point_m[0] / _CELL_M), floor(point_m[1] / _CELL_M))
