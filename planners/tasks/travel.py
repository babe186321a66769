"""How far it is to walk: straight within a room, from door to door between rooms."""

from itertools import product
from math import hypot, inf

from wire.model import Vec2
from wire.outline import inside, mean_m
from wire.site import Room, Site

SPEED_MPS = 0.5
DETOUR = 1.15
"""Furniture makes a way this much longer than the straight line."""
UNREACHABLE_M = 200.0
"""Stands for a way that the plan does not show: possible, but the last thing to try."""


class Travel:
    """Walking distances on the floor plan, from the shortest ways between all pairs of doors."""

    def __init__(self, site: Site) -> None:
        self._rooms = site.room
        self._doors: list[tuple[Vec2, tuple[str, str]]] = [
            (((d.start_m[0] + d.end_m[0]) / 2.0, (d.start_m[1] + d.end_m[1]) / 2.0), d.rooms) for d in site.door
        ]
        self._doors_of: dict[str, list[int]] = {room.id: [] for room in site.room}
        for index, (_, rooms) in enumerate(self._doors):
            for room in rooms:
                self._doors_of.setdefault(room, []).append(index)
        self._between = self._all_pairs()
        self._known: dict[tuple[Vec2, Vec2], float] = {}
        self._at: dict[Vec2, str | None] = {}

    def _all_pairs(self) -> list[list[float]]:
        count = len(self._doors)
        table = [[0.0 if i == j else inf for j in range(count)] for i in range(count)]
        for doors in self._doors_of.values():
            for i, j in product(doors, doors):
                table[i][j] = min(table[i][j], _straight_m(self._doors[i][0], self._doors[j][0]))
        for middle, i, j in product(range(count), repeat=3):
            table[i][j] = min(table[i][j], table[i][middle] + table[middle][j])
        return table

    def room_at(self, point_m: Vec2) -> str | None:
        """The room around a point; the nearest one for a point in a wall."""
        if point_m not in self._at:
            around = next((room.id for room in self._rooms if inside(point_m, room.polygon_m)), None)
            nearest = min(self._rooms, key=lambda r: _straight_m(mean_m(r.polygon_m), point_m), default=None)
            self._at[point_m] = around or (nearest.id if nearest else None)
        return self._at[point_m]

    def metres(self, start_m: Vec2, end_m: Vec2) -> float:
        """Length of the way."""
        key = (start_m, end_m)
        if key not in self._known:
            self._known[key] = self._metres(start_m, end_m)
        return self._known[key]

    def seconds(self, start_m: Vec2, end_m: Vec2) -> float:
        return self.metres(start_m, end_m) / SPEED_MPS

    def _metres(self, start_m: Vec2, end_m: Vec2) -> float:
        first, last = self.room_at(start_m), self.room_at(end_m)
        if first == last:
            return DETOUR * _straight_m(start_m, end_m)
        ways = (
            _straight_m(start_m, self._doors[i][0]) + self._between[i][j] + _straight_m(self._doors[j][0], end_m)
            for i in self._doors_of.get(first or "", ())
            for j in self._doors_of.get(last or "", ())
        )
        best = min(ways, default=inf)
        return DETOUR * best if best < inf else UNREACHABLE_M + _straight_m(start_m, end_m)

    def forget(self) -> None:
        """Drop remembered ways: the points of the last world state will not come again."""
        self._known.clear()
        self._at.clear()


def area_m2(room: Room) -> float:
    corners = room.polygon_m
    pairs = zip(corners, corners[1:] + corners[:1], strict=True)
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs)) / 2.0


def _straight_m(a_m: Vec2, b_m: Vec2) -> float:
    return hypot(a_m[0] - b_m[0], a_m[1] - b_m[1])
