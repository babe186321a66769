"""One room being furnished: puts a thing down only where nothing is in the way and everything stays in reach."""

from collections.abc import Iterator
from itertools import count
from math import cos, pi, sin
from random import Random

from sim.generator.areas import Area
from sim.generator.floor import WITHIN_M, Floor, Mask
from sim.generator.plan import PlannedRoom
from sim.generator.props import draw_props
from sim.generator.statistics import WALL_THICKNESS_M, draw_size_m
from sim.scene import Body, Door, Vec2, Vec3
from wire.catalogue import catalogue

DOOR_ZONE_M = 0.6
WALL_GAP_M = 0.01
FRONT_M: dict[str, float] = {
    "CounterTop": 0.85,
    "Desk": 0.6,
    "Dresser": 0.6,
    "Fridge": 1.0,
    "LaundryHamper": 0.6,
    "ShelvingUnit": 0.7,
    "Sink": 0.7,
    "TVStand": 0.8,
    "Toilet": 0.5,
}
"""Floor kept free in front."""
TRIES = 12
WALLS: tuple[tuple[float, int, int], ...] = ((0.0, -1, 0), (pi, 1, 0), (pi / 2.0, 0, -1), (-pi / 2.0, 0, 1))
"""Yaw of what stands against a wall, and the side that the wall is on."""


class RoomPlacing:
    def __init__(
        self, room: PlannedRoom, doors: tuple[Door, ...], rng: Random, keys: Iterator[int] | None = None
    ) -> None:
        self.room, self.rng = room, rng
        self._keys = keys or count(1)
        self.inner = room.area.grown(-WALL_THICKNESS_M / 2.0)
        own = [d for d in doors if room.id in d.rooms]
        self.floor = Floor(self.inner, tuple(_inside_m(d, room) for d in own))
        self._kept = [_door_zone(d) for d in own]
        self._standing: list[Area] = []
        self._serving: list[Mask] = []
        self.bodies: dict[int, Body] = {}

    def against_wall(self, kind: str, size_m: Vec3 | None = None, yaw_rad: float | None = None) -> Body | None:
        """With its back to a wall, some of the time in a corner."""
        size = size_m or draw_size_m(kind, self.rng)
        corner = "inCorner" in catalogue()[kind].placement
        for _ in range(TRIES):
            yaw, side_x, side_y = self.rng.choice([w for w in WALLS if yaw_rad is None or w[0] == yaw_rad])
            depth, width = size[0] / 2.0 + WALL_GAP_M, size[1] / 2.0 + WALL_GAP_M
            along = self.rng.choice((0.0, 1.0)) if corner and self.rng.random() < 0.5 else self.rng.random()
            if side_x:
                x = self.inner.x0 + depth if side_x < 0 else self.inner.x1 - depth
                y = self.inner.y0 + width + along * (self.inner.depth_m - 2.0 * width)
            else:
                y = self.inner.y0 + depth if side_y < 0 else self.inner.y1 - depth
                x = self.inner.x0 + width + along * (self.inner.width_m - 2.0 * width)
            body = self.at(kind, size, (x, y), yaw)
            if body is not None:
                return body
        return None

    def at(self, kind: str, size_m: Vec3, centre_m: Vec2, yaw_rad: float, tuck: bool = False) -> Body | None:
        """There or nowhere. `tuck`: may stand on floor kept free for something else (a chair at its desk)."""
        area = footprint(centre_m, size_m, yaw_rad)
        front = front_zone(area, yaw_rad, FRONT_M.get(kind, 0.0))
        if not self.inner.holds(area) or not self.inner.holds(front):
            return None
        doors = self._kept[: len(self.floor.must_reach_m)]
        if any(area.overlaps(other) for other in self._standing + (doors if tuck else self._kept)):
            return None
        if any(front.overlaps(other) for other in self._standing):
            return None
        gap_m = self.floor.distance_m(area)
        clearance_m = self.floor.clearance_m.copy()
        clearance_m[clearance_m > gap_m] = gap_m[clearance_m > gap_m]
        walkable = self.floor.walkable(clearance_m)
        serving = self._served_from(area, yaw_rad, kind)
        if walkable is None or not all((mask & walkable).any() for mask in [*self._serving, serving]):
            return None
        self._standing.append(area)
        self._serving.append(serving)
        self._kept.append(front)
        self.floor.clearance_m = clearance_m
        return self._add(kind, (*centre_m, 0.0), yaw_rad, size_m, None)

    def on_top(self, kind: str, size_m: Vec3, below: Body, offset_m: Vec2, served: bool = True) -> Body | None:
        """Furniture that stands on other furniture, facing the same way, at an offset in the frame of what is below."""
        c, s = cos(below.yaw_rad), sin(below.yaw_rad)
        x, y, z = below.position_m
        centre = (x + c * offset_m[0] - s * offset_m[1], y + s * offset_m[0] + c * offset_m[1])
        walkable = self.floor.walkable()
        if served:
            serving = self._served_from(footprint(centre, size_m, below.yaw_rad), below.yaw_rad, kind)
            if walkable is None or not (serving & walkable).any():
                return None
            self._serving.append(serving)
        return self._add(kind, (*centre, z + below.size_m[2]), below.yaw_rad, size_m, below.key)

    def hang(self, kind: str, size_m: Vec3, centre_m: Vec3, yaw_rad: float) -> Body:
        """On a wall, out of everybody's way."""
        return self._add(kind, centre_m, yaw_rad, size_m, None)

    def _served_from(self, area: Area, yaw_rad: float, kind: str) -> Mask:
        """Cells from which a robot reaches it; in front of it, if it has a front that matters."""
        near: Mask = self.floor.distance_m(area) <= WITHIN_M
        if kind in FRONT_M or catalogue()[kind].can("openable"):
            near &= self.floor.distance_m(front_zone(area, yaw_rad, WITHIN_M)) <= 0.0
        return near

    def _add(self, kind: str, position_m: Vec3, yaw_rad: float, size_m: Vec3, parent: int | None) -> Body:
        key = next(self._keys)
        x, y, z = (round(v, 4) for v in position_m)
        self.bodies[key] = Body(
            key, kind, (x, y, z), yaw_rad, size_m, self.rng.randrange(1 << 30), draw_props(kind, self.rng), parent
        )
        return self.bodies[key]


def footprint(centre_m: Vec2, size_m: Vec3, yaw_rad: float) -> Area:
    """Of a thing that stands along the walls."""
    return Area.around(centre_m, size_m[0], size_m[1], abs(sin(yaw_rad)) > 0.5)


def front_zone(area: Area, yaw_rad: float, deep_m: float) -> Area:
    """The floor before the front of what stands on an area."""
    forward_x, forward_y = round(cos(yaw_rad)), round(sin(yaw_rad))
    if forward_x:
        x = area.x1 if forward_x > 0 else area.x0
        return Area(min(x, x + forward_x * deep_m), area.y0, max(x, x + forward_x * deep_m), area.y1)
    y = area.y1 if forward_y > 0 else area.y0
    return Area(area.x0, min(y, y + forward_y * deep_m), area.x1, max(y, y + forward_y * deep_m))


def _inside_m(door: Door, room: PlannedRoom) -> Vec2:
    """A point half a metre inside the room, before the door."""
    x, y = (door.start_m[0] + door.end_m[0]) / 2.0, (door.start_m[1] + door.end_m[1]) / 2.0
    step_m = 0.55 + WALL_THICKNESS_M / 2.0
    if abs(door.start_m[1] - door.end_m[1]) < 1e-6:
        return (x, y + (step_m if room.area.centre_m[1] > y else -step_m))
    return (x + (step_m if room.area.centre_m[0] > x else -step_m), y)


def _door_zone(door: Door) -> Area:
    """On both sides of the door; the part outside the room harms nobody."""
    (x0, y0), (x1, y1) = door.start_m, door.end_m
    reach_m = DOOR_ZONE_M + WALL_THICKNESS_M / 2.0
    if abs(y0 - y1) < 1e-6:
        return Area(x0, y0 - reach_m, x1, y0 + reach_m)
    return Area(x0 - reach_m, y0, x0 + reach_m, y1)
