"""What a gripper can do to things: preconditions and effects after AI2-THOR's, one function each per action."""

from collections.abc import Callable
from dataclasses import dataclass

from sim.boxes import Box, body_box, footprints_overlap
from sim.physics import Physics
from sim.placing import Spot, find_spot
from sim.reaching import REACH_M, Refused, Stance
from sim.scene import Body, Scene, Vec3
from wire.catalogue import catalogue
from wire.messages.driver import GripperAction

DURATION_S: dict[GripperAction, float] = {
    "pickup": 2.0,
    "put": 2.0,
    "open": 2.0,
    "close": 2.0,
    "toggle_on": 1.0,
    "toggle_off": 1.0,
    "slice": 3.0,
    "clean": 4.0,
}
BLADES = ("Knife", "ButterKnife")
FRONT_OPENING = ("Fridge",)
"""Things that stand on the floor and whose door swings out into the room."""
DOOR_SWING_M = 0.30


@dataclass(frozen=True)
class Attempt:
    """One action on one thing, about to be done or just done."""

    scene: Scene
    physics: Physics
    stance: Stance
    target: Body
    held: Body | None
    point_m: Vec3

    def has(self, prop: str) -> bool:
        return self.target.props.get(prop, False)


def check_pickup(a: Attempt) -> None:
    if a.held is not None:
        raise Refused(f"the hand is full: it holds a {a.held.type}")
    if a.has("isSliced"):
        raise Refused(f"the {a.target.type} has been sliced and cannot be picked up whole")


def do_pickup(a: Attempt) -> Vec3:
    taken_m = body_box(a.target).centre_m
    a.target.parent, a.target.held_by = None, a.stance.robot
    a.physics.place(a.target.key)
    return taken_m


def check_put(a: Attempt) -> None:
    _spot(a)


def do_put(a: Attempt) -> Vec3:
    item, spot = _spot(a)
    item.parent, item.held_by = a.target.key, None
    a.physics.carry(item.key, spot.position_m, spot.yaw_rad)
    a.physics.place(item.key)
    return body_box(item).centre_m


def _spot(a: Attempt) -> tuple[Body, Spot]:
    if a.held is None:
        raise Refused("the hand is empty: there is nothing to put down")
    if catalogue()[a.target.type].must_open and not a.has("isOpen"):
        raise Refused(f"the {a.target.type} is closed; open it first")
    spot = find_spot(a.scene, a.target, a.held, a.point_m, a.stance.centre_m, REACH_M)
    if spot is None:
        raise Refused(f"there is no free spot within reach for the {a.held.type} in or on the {a.target.type}")
    return a.held, spot


def check_open(a: Attempt) -> None:
    if a.has("isOpen"):
        raise Refused(f"the {a.target.type} is already open")
    if a.target.type == "Microwave" and a.has("isToggled"):
        raise Refused("the Microwave is running; switch it off before opening it")
    _check_swing(a)


def check_close(a: Attempt) -> None:
    if not a.has("isOpen"):
        raise Refused(f"the {a.target.type} is already closed")
    _check_swing(a)


def _check_swing(a: Attempt) -> None:
    """A robot in the way of a door makes it roll back."""
    if a.target.type not in FRONT_OPENING:
        return
    box = body_box(a.target)
    front_m = box.site((box.half_m[0] + DOOR_SWING_M / 2.0, 0.0, 0.0))
    swing = Box(front_m, (DOOR_SWING_M / 2.0, box.half_m[1], box.half_m[2]), box.yaw_rad)
    if any(footprints_overlap(swing, rover.box()) for rover in a.physics.robots.values()):
        raise Refused(f"the door of the {a.target.type} is blocked by a robot and rolled back")


def check_toggle_on(a: Attempt) -> None:
    if a.has("isToggled"):
        raise Refused(f"the {a.target.type} is already on")
    if a.target.type == "Microwave" and a.has("isOpen"):
        raise Refused("the Microwave is open; close it before switching it on")
    if a.target.type == "Laptop" and not a.has("isOpen"):
        raise Refused("the Laptop is closed; open it before switching it on")


def check_toggle_off(a: Attempt) -> None:
    if not a.has("isToggled"):
        raise Refused(f"the {a.target.type} is already off")


def check_slice(a: Attempt) -> None:
    if a.held is None or a.held.type not in BLADES:
        raise Refused(f"slicing the {a.target.type} needs a knife in the hand")
    if a.has("isSliced"):
        raise Refused(f"the {a.target.type} is already sliced")


def check_clean(a: Attempt) -> None:
    if not a.has("isDirty"):
        raise Refused(f"the {a.target.type} is already clean")


def _set(prop: str, value: bool) -> Callable[[Attempt], Vec3]:
    def effect(a: Attempt) -> Vec3:
        a.target.props[prop] = value
        a.physics.moved.add(a.target.key)
        return body_box(a.target).centre_m

    return effect


@dataclass(frozen=True)
class Rule:
    """`check` raises Refused; `effect` changes the scene and returns where the hand was."""

    check: Callable[[Attempt], None]
    effect: Callable[[Attempt], Vec3]


RULES: dict[GripperAction, Rule] = {
    "pickup": Rule(check_pickup, do_pickup),
    "put": Rule(check_put, do_put),
    "open": Rule(check_open, _set("isOpen", True)),
    "close": Rule(check_close, _set("isOpen", False)),
    "toggle_on": Rule(check_toggle_on, _set("isToggled", True)),
    "toggle_off": Rule(check_toggle_off, _set("isToggled", False)),
    "slice": Rule(check_slice, _set("isSliced", True)),
    "clean": Rule(check_clean, _set("isDirty", False)),
}
