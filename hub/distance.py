"""How far is it to walk? Straight within a room, through the doors between rooms; shortest ways are kept."""

from heapq import heappop, heappush
from math import hypot, inf

from hub.floor import FloorPlan
from wire.model import Vec2


class Distances:
    """Walking distances on the floor plan."""

    def __init__(self, floor: FloorPlan) -> None:
        self._floor = floor
        self._doors = {door.id: door for door in floor.doors}
        self._of_room: dict[str, list[str]] = {}
        for door in floor.doors:
            for room in door.rooms:
                self._of_room.setdefault(room, []).append(door.id)
        self._between: dict[str, dict[str, float]] = {}

    def walk_m(self, start_m: Vec2, end_m: Vec2) -> float:
        """Metres from one point to another; infinite when no doors connect their rooms."""
        a, b = self._floor.room_at(*start_m), self._floor.room_at(*end_m)
        if a == b or a is None or b is None:
            return _straight(start_m, end_m)
        return min(
            (
                _straight(start_m, self._doors[p].middle_m)
                + self._from(p).get(q, inf)
                + _straight(self._doors[q].middle_m, end_m)
                for p in self._of_room.get(a, ())
                for q in self._of_room.get(b, ())
            ),
            default=inf,
        )

    def _from(self, door: str) -> dict[str, float]:
        """Metres from one door to every other (Dijkstra, once per door)."""
        known = self._between.get(door)
        if known is not None:
            return known
        best = {door: 0.0}
        heap = [(0.0, door)]
        while heap:
            length, here = heappop(heap)
            if length > best[here]:
                continue
            for room in self._doors[here].rooms:
                for there in self._of_room[room]:
                    further = length + _straight(self._doors[here].middle_m, self._doors[there].middle_m)
                    if further < best.get(there, inf):
                        best[there] = further
                        heappush(heap, (further, there))
        self._between[door] = best
        return best


def _straight(a: Vec2, b: Vec2) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])
