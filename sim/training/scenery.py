"""A home put in disorder, so that every type, state and place is seen often enough to be learnt."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import hypot

import numpy as np

from sim.models import surfaces
from sim.render import Renderer
from sim.scene import Body, Scene, Vec2, Vec3
from sim.training.labels import Thing
from sim.training.poses import ROBOT_RADIUS_M, any_room, is_free, point_in
from wire.catalogue import PROP_FLAG, PROPS, catalogue, modelled_types

ROBOT_SIZE_M: Vec3 = (0.65, 0.35, 0.90)
"""Of the box whose centre is taken as a robot's; its mast is higher."""
ROBOTS = 3
EXTRAS = 60
ON_FLOOR = 0.25
ON_FURNITURE = ("CoffeeMachine", "DeskLamp", "HousePlant", "Microwave", "Television", "Toaster")
ON_FREE_FLOOR = ("ArmChair", "Chair", "FloorLamp", "GarbageCan", "HousePlant", "LaundryHamper", "SideTable")
FURNITURE_SHARE = 0.08
"""Of the extras, of each of the two kinds of small furniture, which a home has one or two of."""


@dataclass
class Scenery:
    """One home, its renderer, and the extra things scattered in it."""

    scene: Scene
    renderer: Renderer
    rng: np.random.Generator
    robots: dict[str, tuple[Vec2, float]] = field(default_factory=dict)
    extras: list[int] = field(default_factory=list)

    def shuffle(self) -> None:
        """Other states, other extra things in other places, other robots."""
        for body in list(self.scene.bodies.values()):
            if body.key not in self.extras and self._turn(body):
                self.renderer.update(body)
        self._scatter()
        self.place_robots()

    def things(self, robot_id: int) -> dict[int, Thing]:
        """By the id that pictures show."""
        found = {
            key: Thing(b.type, b.position_m, b.yaw_rad, b.size_m, b.props)
            for key, b in self.scene.bodies.items()
            if not b.gone
        }
        for number, ((x, y), yaw) in enumerate(self.robots.values()):
            found[robot_id + number] = Thing("Robot", (x, y, 0.0), yaw, ROBOT_SIZE_M, {})
        return found

    def _turn(self, body: Body) -> bool:
        """New random properties of a body; whether it has any."""
        row = catalogue()[body.type]
        mine = [p for p in PROPS if row.can(PROP_FLAG[p])]
        for prop in mine:
            body.props[prop] = bool(self.rng.random() < 0.5)
        return bool(mine)

    def _scatter(self) -> None:
        supports = [b for b in self.scene.bodies.values() if b.key not in self.extras and not b.gone and surfaces(b)]
        taken: list[tuple[Vec3, float]] = []
        first = max(self.scene.bodies) + 1 if not self.extras else self.extras[0]
        for number in range(EXTRAS):
            body = self._extra(first + number, self._any_type())
            body.gone = not self._place(body, supports, taken)
            self.scene.bodies[body.key] = body
            self.renderer.update(body)
        self.extras = list(range(first, first + EXTRAS))

    def _any_type(self) -> str:
        chance = self.rng.random()
        types: Sequence[str] = [t for t in modelled_types() if catalogue()[t].kind == "pickup"]
        if chance < 2.0 * FURNITURE_SHARE:
            types = ON_FURNITURE if chance < FURNITURE_SHARE else ON_FREE_FLOOR
        return types[int(self.rng.integers(len(types)))]

    def _extra(self, key: int, name: str) -> Body:
        row = catalogue()[name]
        low, high = np.array(row.size_p10_m), np.array(row.size_p90_m)
        size = low + (high - low) * self.rng.uniform(0.0, 1.0)
        body = Body(
            key,
            name,
            (0.0, 0.0, 0.0),
            float(self.rng.uniform(-np.pi, np.pi)),
            (float(size[0]), float(size[1]), float(size[2])),
            int(self.rng.integers(1 << 30)),
        )
        self._turn(body)
        return body

    def _place(self, body: Body, supports: Sequence[Body], taken: list[tuple[Vec3, float]]) -> bool:
        """Somewhere on furniture or the floor, apart from other extras."""
        radius = hypot(body.size_m[0], body.size_m[1]) / 2.0
        for _ in range(12):
            point = self._spot(body, supports)
            if point is None:
                continue
            if all(hypot(point[0] - p[0], point[1] - p[1]) > 0.8 * (radius + r) for p, r in taken):
                body.position_m = point
                taken.append((point, radius))
                return True
        return False

    def _spot(self, body: Body, supports: Sequence[Body]) -> Vec3 | None:
        large = catalogue()[body.type].kind != "pickup"
        if not supports or (body.type in ON_FREE_FLOOR if large else self.rng.random() < ON_FLOOR):
            x, y = point_in(any_room(self.scene, self.rng), self.rng).tolist()
            return (x, y, 0.0) if is_free(self.scene, (x, y), 0.3 if large else 0.1) else None
        support = supports[int(self.rng.integers(len(supports)))]
        places = surfaces(support)
        place = places[int(self.rng.integers(len(places)))]
        room_m = np.array(place.size_m) - min(body.size_m[:2])
        if body.size_m[2] > place.room_above_m or room_m.min() < 0.0:
            return None
        x, y = np.array(place.centre_m) + self.rng.uniform(-0.5, 0.5, 2) * room_m
        c, s = np.cos(support.yaw_rad), np.sin(support.yaw_rad)
        return (
            float(support.position_m[0] + c * x - s * y),
            float(support.position_m[1] + s * x + c * y),
            support.position_m[2] + place.height_m,
        )

    def place_robots(self) -> None:
        """Robots standing about, some with a load."""
        self.robots = {}
        for number in range(ROBOTS):
            name = f"dog-{number + 1}"
            x, y = point_in(any_room(self.scene, self.rng), self.rng).tolist()
            yaw = float(self.rng.uniform(-np.pi, np.pi))
            if not is_free(self.scene, (x, y), ROBOT_RADIUS_M):
                x, y = 1000.0, 1000.0
            holding = bool(self.rng.random() < 0.3)
            self.renderer.set_robot(name, (x, y, 0.0), yaw, holding)
            self.robots[name] = ((x, y), yaw)
