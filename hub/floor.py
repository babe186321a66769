"""The floor plan as the hub needs it: which room is a point in, which doors lie between rooms."""

from dataclasses import dataclass
from math import floor, hypot

from wire.model import Vec2
from wire.outline import inside, segment_distance_m
from wire.site import Site

_CACHE_M = 0.1


@dataclass(frozen=True, slots=True)
class Doorway:
    """A door's place: its middle, and a point on each side of it."""

    id: str
    rooms: tuple[str, str]
    middle_m: Vec2
    width_m: float
    normal: Vec2
    """Unit vector through the door."""


class FloorPlan:
    """Rooms and doors of a site; points are looked up through a cache of 0.1 m squares."""

    def __init__(self, site: Site) -> None:
        self.rooms = site.room
        self.polygons: dict[str, tuple[Vec2, ...]] = {room.id: room.polygon_m for room in site.room}
        self.doors = tuple(_doorway(d.id, d.rooms, d.start_m, d.end_m) for d in site.door)
        self._cache: dict[tuple[int, int], str | None] = {}

    def room_at(self, x: float, y: float) -> str | None:
        """The room of a point; inside a wall the nearest room; None only where there are no rooms."""
        key = (floor(x / _CACHE_M), floor(y / _CACHE_M))
        if key not in self._cache:
            if len(self._cache) > 200_000:
                self._cache.clear()
            self._cache[key] = self._find(((key[0] + 0.5) * _CACHE_M, (key[1] + 0.5) * _CACHE_M))
        return self._cache[key]

    def _find(self, point_m: Vec2) -> str | None:
        for id, polygon in self.polygons.items():
            if inside(point_m, polygon):
                return id
        return min(self.polygons, key=lambda id: (edge_distance_m(point_m, self.polygons[id]), id), default=None)

    def neighbours(self, room: str) -> list[str]:
        return [b if a == room else a for a, b in (door.rooms for door in self.doors) if room in (a, b)]

    def connected(self, start: str) -> set[str]:
        """Every room that can be walked to from one."""
        seen, todo = {start}, [start]
        while todo:
            for room in self.neighbours(todo.pop()):
                if room not in seen:
                    seen.add(room)
                    todo.append(room)
        return seen


def edge_distance_m(point_m: Vec2, polygon_m: tuple[Vec2, ...]) -> float:
    """Distance from a point to the nearest edge."""
    ends = (*polygon_m[1:], polygon_m[0])
    return min(segment_distance_m(point_m, a, b) for a, b in zip(polygon_m, ends, strict=True))


def _doorway(id: str, rooms: tuple[str, str], start_m: Vec2, end_m: Vec2) -> Doorway:
    dx, dy = end_m[0] - start_m[0], end_m[1] - start_m[1]
    width = hypot(dx, dy) or 1.0
    middle = ((start_m[0] + end_m[0]) / 2.0, (start_m[1] + end_m[1]) / 2.0)
    return Doorway(id, rooms, middle, width, (-dy / width, dx / width))
