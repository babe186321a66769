"""An instruction that suits a home, and the goals it stands for: false now, and within the robots' power."""

from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from itertools import islice
from math import cos, inf, sin
from random import Random
from typing import TypeVar

import numpy as np

from sim.boxes import body_box, structure_boxes
from sim.generator.access import ROBOT_CLEAR_M, body_area, home_floor
from sim.generator.floor import Floor, Mask
from sim.placing import find_spot
from sim.reaching import REACH_M, Refused, Stance, check_reach
from sim.rover import MAST_FORWARD_M, MAST_TOP_M
from sim.scene import Body, Room, Scene, Vec2
from sim.truth import room_of
from wire.catalogue import catalogue
from wire.frames import bearing_rad
from wire.messages.goal import Goal, Selector
from wire.messages.truth import TruthTask

NAMES: dict[str, str] = {
    "AlarmClock": "alarm clock",
    "ArmChair": "armchair",
    "BasketBall": "basketball",
    "CellPhone": "phone",
    "CoffeeMachine": "coffee machine",
    "CoffeeTable": "coffee table",
    "CounterTop": "counter",
    "DeskLamp": "desk lamp",
    "DiningTable": "dining table",
    "FloorLamp": "floor lamp",
    "GarbageCan": "garbage can",
    "HousePlant": "house plant",
    "LaundryHamper": "laundry hamper",
    "RemoteControl": "remote control",
    "ShelvingUnit": "shelf",
    "SideTable": "side table",
    "SprayBottle": "spray bottle",
    "TVStand": "TV stand",
    "TeddyBear": "teddy bear",
    "Television": "TV",
    "WineBottle": "wine bottle",
}
"""What people call a type whose name is not simply its word."""

PLAIN_TO_SEE_M = 0.07
"""The second largest side of a thing that a robot is sent for."""
NOT_SENT_FOR = ("Box", "Pillow", "Knife")
"""Too many look alike, or too large or too thin for a gripper."""
DESTINATIONS = (
    "Fridge",
    "GarbageCan",
    "Sink",
    "DiningTable",
    "CoffeeTable",
    "Sofa",
    "Bed",
    "Desk",
    "Dresser",
    "CounterTop",
)
SWITCHED = ("Television", "FloorLamp", "DeskLamp", "CoffeeMachine", "Toaster")
OPENED = ("Microwave", "Fridge", "LaundryHamper")
STANCES_APART, STANCES_NEEDED = 3, 3
"""Of the places within reach of a thing every so many are tried, and so many must do."""
LIKELY = ("Fridge", "GarbageCan")
"""Destinations that say the most about a thing."""

Thing = TypeVar("Thing")


@dataclass(frozen=True)
class Clause:
    """A part of an instruction, the goal it states and the types it is about."""

    text: str
    goal: Goal
    types: frozenset[str]


def make_task(scene: Scene, seed: int) -> TruthTask:
    """One or two errands, and most times something to switch off wherever it is."""
    rng = Random(f"task {scene.seed} {seed}")
    home = _Home(scene)
    clauses: list[Clause] = []
    for family in _families(rng):
        used = {kind for clause in clauses for kind in clause.types}
        clause = family(home, rng, used)
        if clause is not None:
            clauses.append(clause)
    if not clauses:
        clauses.append(_visit(home, rng))
    text = _sentence([clause.text for clause in clauses])
    goals = tuple(clause.goal.model_copy(update={"text": clause.text}) for clause in clauses)
    return TruthTask(instruction=text, goals=goals)


Family = Callable[["_Home", Random, AbstractSet[str]], Clause | None]
"""A home, a source of chance, the types already spoken of: one more clause, if there is one."""


def _families(rng: Random) -> list[Family]:
    chosen: list[Family] = [_errand]
    if rng.random() < 0.5:
        chosen.append(_delivery if rng.random() < 0.4 else _errand)
    chosen.append(_door if rng.random() < 0.15 else _switch)
    return chosen


class _Home:
    """What a scene offers to be done."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.bodies = [b for b in scene.bodies.values() if not b.gone]
        self.floor: Floor = home_floor(scene)
        walkable = self.floor.walkable(needed_m=ROBOT_CLEAR_M)
        assert walkable is not None, "a home has floor to walk on"
        self.walkable: Mask = walkable
        self._structure = structure_boxes(scene)

    def of(self, kind: str, room: str | None = None) -> list[Body]:
        return [b for b in self.bodies if b.type == kind and (room is None or self.room(b) == room)]

    def room(self, body: Body) -> str | None:
        return room_of(self.scene, (body.position_m[0], body.position_m[1]))

    def items(self) -> list[Body]:
        """The only ones of their type, in plain sight, good to carry."""
        return [
            b
            for b in self.bodies
            if catalogue()[b.type].can("pickupable")
            and b.type not in NOT_SENT_FOR
            and len(self.of(b.type)) == 1
            and sorted(b.size_m)[1] >= PLAIN_TO_SEE_M
            and self.room(b) is not None
            and self._in_sight(b)
        ]

    def _in_sight(self, body: Body) -> bool:
        """On something, not in something."""
        while body.parent is not None:
            body = self.scene.bodies[body.parent]
            if catalogue()[body.type].receptacle_mode != "on":
                return False
        return True

    def stand_m(self, body: Body) -> Vec2:
        """The nearest floor to a thing where a robot can be."""
        gap = np.where(self.walkable, self.floor.distance_m(body_area(body)), inf)
        row, column = np.unravel_index(int(np.argmin(gap)), gap.shape)
        return (float(self.floor.x[row, column]), float(self.floor.y[row, column]))

    def graspable(self, item: Body) -> bool:
        """Whether there are places to stand from which the arm gets to it and nothing hides it from the robot's eye."""
        box = body_box(item)
        places = zip(self.floor.x[self.walkable].tolist(), self.floor.y[self.walkable].tolist(), strict=True)
        near = [place for place in places if box.floor_gap_m(place) <= REACH_M][::STANCES_APART]
        good = (place for place in near if self._sees(place, item))
        return len(list(islice(good, STANCES_NEEDED))) == STANCES_NEEDED

    def _sees(self, place_m: Vec2, item: Body) -> bool:
        yaw_rad = bearing_rad(place_m, (item.position_m[0], item.position_m[1]))
        x, y = place_m[0] + MAST_FORWARD_M * cos(yaw_rad), place_m[1] + MAST_FORWARD_M * sin(yaw_rad)
        try:
            check_reach(self.scene, Stance("", place_m, (x, y, MAST_TOP_M), (), self._structure), item)
        except Refused:
            return False
        return True

    def fits(self, item: Body, receptacle: Body) -> bool:
        """Whether there is a free spot that an arm gets to."""
        centre = body_box(receptacle).centre_m
        return find_spot(self.scene, receptacle, item, centre, self.stand_m(receptacle), REACH_M) is not None


def _errand(home: _Home, rng: Random, used: AbstractSet[str]) -> Clause | None:
    """Put a thing in or on a piece of furniture that is the only one of its type."""
    places = {kind: home.of(kind)[0] for kind in DESTINATIONS if len(home.of(kind)) == 1 and kind not in used}
    for item in _shuffled(home.items(), rng):
        kinds = [kind for kind, place in places.items() if kind in catalogue()[item.type].allowed_in]
        for kind in sorted(kinds, key=lambda k: rng.random() * (0.5 if k in LIKELY else 1.0)):
            place = places[kind]
            if item.type in used or item.parent == place.key or not home.graspable(item):
                continue
            if home.fits(item, place):
                word = "on" if catalogue()[kind].receptacle_mode == "on" else "in"
                return Clause(
                    f"put the {name_of(item.type)} {word} the {name_of(kind)}",
                    Goal(predicate="in", subject=Selector(type=item.type), object=Selector(type=kind)),
                    frozenset((item.type, kind)),
                )
    return None


def _delivery(home: _Home, rng: Random, used: AbstractSet[str]) -> Clause | None:
    """Bring a thing to another room that has somewhere to put it."""
    for item in _shuffled(home.items(), rng):
        for room in _shuffled(home.scene.rooms, rng):
            if item.type in used or home.room(item) == room.id or not home.graspable(item):
                continue
            if _welcomes(home, item, room):
                return Clause(
                    f"bring the {name_of(item.type)} to {_room_name(room)}",
                    Goal(predicate="at", subject=Selector(type=item.type), object=Selector(room=room.id)),
                    frozenset((item.type,)),
                )
    return None


def _welcomes(home: _Home, item: Body, room: Room) -> bool:
    allowed = [kind for kind in catalogue()[item.type].allowed_in if kind in DESTINATIONS and kind != "Fridge"]
    return any(home.fits(item, place) for kind in allowed for place in home.of(kind, room.id))


def _room_name(room: Room) -> str:
    return room.name if room.name[-1].isdigit() else f"the {room.name}"


def _switch(home: _Home, rng: Random, used: AbstractSet[str]) -> Clause | None:
    """Turn off all of a kind, some of which are on. Televisions are what people forget most."""
    kinds = [k for k in SWITCHED if k not in used and any(b.props["isToggled"] for b in home.of(k))]
    if not kinds:
        return None
    kind = "Television" if "Television" in kinds and rng.random() < 0.6 else rng.choice(kinds)
    alone = len(home.of(kind)) == 1
    return Clause(
        f"turn off {'the' if alone else 'every'} {name_of(kind)}",
        Goal(predicate="off", subject=Selector(type=kind, count=1 if alone else None)),
        frozenset((kind,)),
    )


def _door(home: _Home, rng: Random, used: AbstractSet[str]) -> Clause | None:
    """Open or close the only one of its type."""
    alone = [home.of(kind)[0] for kind in OPENED if kind not in used and len(home.of(kind)) == 1]
    still = [body for body in alone if not body.props.get("isToggled", False)]
    if not still:
        return None
    body = rng.choice(still)
    is_open = body.props["isOpen"]
    return Clause(
        f"{'close' if is_open else 'open'} the {name_of(body.type)}",
        Goal(predicate="closed" if is_open else "open", subject=Selector(type=body.type)),
        frozenset((body.type,)),
    )


def _visit(home: _Home, rng: Random) -> Clause:
    """Every home has rooms to look into."""
    room = rng.choice(home.scene.rooms)
    goal = Goal(predicate="visited", subject=Selector(room=room.id))
    return Clause(f"go to {_room_name(room)}", goal, frozenset((room.id,)))


def _shuffled(things: Sequence[Thing], rng: Random) -> list[Thing]:
    return rng.sample(things, len(things))


def name_of(kind: str) -> str:
    """What people call a type."""
    return NAMES.get(kind, kind.lower())


def _sentence(texts: list[str]) -> str:
    return texts[0] if len(texts) == 1 else ", ".join(texts[:-1]) + " and " + texts[-1]
