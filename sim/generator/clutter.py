"""Small things, where people leave them: most where they belong, some elsewhere, all where a robot's hand gets to."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from math import cos, pi, sin
from random import Random

from sim.boxes import Box, body_box, boxes_overlap
from sim.generator.floor import Mask
from sim.generator.placing import RoomPlacing
from sim.generator.props import draw_props
from sim.generator.statistics import draw_size_m
from sim.models.surfaces import Surface, surfaces
from sim.scene import Body, Vec2
from wire.catalogue import catalogue, modelled_types

HAND_M = 1.02
"""From a robot's middle to the middle of the thing."""
COMMON, RARE, ASTRAY = 0.62, 0.26, 0.22
MOST: dict[str, int] = {
    "Book": 3,
    "Pillow": 4,
    "Plate": 3,
    "Bowl": 2,
    "Mug": 2,
    "Box": 2,
    "HousePlant": 2,
    "DeskLamp": 2,
}
MOST_ON_ONE = 4
INSIDE: dict[str, float] = {"Fridge": 0.9, "Microwave": 0.3, "Box": 0.35, "LaundryHamper": 0.0, "GarbageCan": 0.35}
"""Chance that a thing of the right kind is put inside rather than onto something."""
LIFT_M = 0.001


class Clutter:
    """Fills the receptacles of a home. Counts what there is, so that no home drowns in books."""

    def __init__(self, rooms: list[RoomPlacing], rng: Random, keys: Iterator[int]) -> None:
        self._rooms, self._rng, self._keys = rooms, rng, keys
        self._count: Counter[str] = Counter()
        self._load: Counter[int] = Counter()
        self._walkable: dict[str, Mask] = {}
        for placing in rooms:
            mask = placing.floor.walkable()
            assert mask is not None
            self._walkable[placing.room.id] = mask
            self._count.update(b.type for b in placing.bodies.values())

    def spread(self, most: int) -> None:
        """Draw the things of every room, then put each somewhere."""
        wanted = [(name, placing) for placing in self._rooms for name in self._draw(placing)]
        self._rng.shuffle(wanted)
        for name, placing in wanted:
            if sum(len(p.bodies) for p in self._rooms) >= most:
                return
            if self._count[name] < MOST.get(name, 1):
                astray = self._rng.random() < ASTRAY
                self.place(name, self._rng.choice(self._rooms) if astray else placing)

    def _draw(self, placing: RoomPlacing) -> list[str]:
        kind = placing.room.kind
        small = [n for n in modelled_types() if catalogue()[n].kind == "pickup" or n in ("DeskLamp", "HousePlant")]
        weights = {n: catalogue()[n].room_weights.get(kind, 0.0) for n in small}
        return [n for n in small if self._rng.random() < (COMMON if weights[n] >= 2.0 else RARE if weights[n] else 0.0)]

    def place(self, name: str, placing: RoomPlacing) -> Body | None:
        """On the receptacles of a room, the likely ones first; None when there is no room on any."""
        size = draw_size_m(name, self._rng)
        if name == "Knife":
            size = (size[0], size[2], size[1])
        body = Body(0, name, (0.0, 0.0, 0.0), 0.0, size, self._rng.randrange(1 << 30), draw_props(name, self._rng))
        for receptacle in self._candidates(name, placing):
            for surface in surfaces(receptacle):
                put = self._try_surface(body, receptacle, surface, placing)
                if put is not None:
                    self._count[name] += 1
                    self._load[receptacle.key] += 1
                    return put
        return None

    def _candidates(self, name: str, placing: RoomPlacing) -> list[Body]:
        """Receptacles of a room that commonly hold it, in an order drawn by how likely each is."""
        chance = {}
        for body in placing.bodies.values():
            row = catalogue()[body.type]
            fits = body.type in catalogue()[name].allowed_in or name in row.holds
            if not fits or (row.kind == "pickup" and body.type != "Box") or self._load[body.key] >= MOST_ON_ONE:
                continue
            inside = INSIDE.get(body.type)
            weight = row.holds.get(name, 0.0) + 0.04 if inside is None else inside * 0.4
            chance[body.key] = weight * self._rng.uniform(0.2, 1.0)
        return [placing.bodies[key] for key in sorted(chance, key=lambda k: -chance[k]) if chance[key] > 0.0]

    def _try_surface(self, body: Body, receptacle: Body, surface: Surface, placing: RoomPlacing) -> Body | None:
        """Somewhere on a surface where it fits, touches nothing and can be reached."""
        if body.size_m[2] > surface.room_above_m:
            return None
        walkable = self._walkable[placing.room.id]
        others = [body_box(b) for b in placing.bodies.values() if b.parent == receptacle.key]
        for _ in range(8):
            turn = self._turn(body.type, receptacle)
            reach = _reach(body, turn)
            slack = (surface.size_m[0] / 2.0 - reach[0], surface.size_m[1] / 2.0 - reach[1])
            if min(slack) < 0.0:
                continue
            local = (
                surface.centre_m[0] + self._rng.uniform(-slack[0], slack[0]),
                surface.centre_m[1] + self._rng.uniform(-slack[1], slack[1]),
            )
            x, y = _site(receptacle, local)
            z = receptacle.position_m[2] + surface.height_m + LIFT_M
            put = replace(body, position_m=(round(x, 4), round(y, 4), round(z, 4)), yaw_rad=receptacle.yaw_rad + turn)
            near = placing.floor.near(walkable, (x, y)) <= HAND_M
            if near and not any(boxes_overlap(body_box(put), other) for other in others):
                put.key, put.parent = next(self._keys), receptacle.key
                placing.bodies[put.key] = put
                return put
        return None

    def _turn(self, name: str, receptacle: Body) -> float:
        """Lamps, clocks and laptops face the way the furniture does; the rest lies as it fell."""
        if name in ("AlarmClock", "DeskLamp", "Laptop", "Pillow", "TeddyBear") or receptacle.type in INSIDE:
            return round(self._rng.uniform(-0.25, 0.25), 4)
        return round(self._rng.uniform(-pi, pi), 4)


def _reach(body: Body, turn_rad: float) -> Vec2:
    """Half extents of a turned thing along its receptacle's axes."""
    c, s = abs(cos(turn_rad)), abs(sin(turn_rad))
    d, w, _ = body.size_m
    return ((d * c + w * s) / 2.0, (d * s + w * c) / 2.0)


def _site(receptacle: Body, local_m: Vec2) -> Vec2:
    x, y, _ = Box(receptacle.position_m, (0.0, 0.0, 0.0), receptacle.yaw_rad).site((*local_m, 0.0))
    return (x, y)
