"""Skills of the hand: stand beside the thing, see it, reach to where it is seen, and deal with what goes wrong."""

from collections.abc import Generator
from dataclasses import dataclass, field
from math import inf

from devices.quadruped import places
from devices.quadruped.body import WALK_TILT_RAD, Body
from devices.quadruped.gaze import look_around, look_at
from devices.quadruped.grid import Cell
from devices.quadruped.moves import Skilled
from devices.quadruped.reasons import code_of
from devices.quadruped.robot import Robot
from devices.quadruped.walk import Steps, await_odometry, walk
from devices.worker import Outcome
from wire.frames import distance_m
from wire.messages.command import Command, ReasonCode, Target
from wire.messages.driver import GripperAction
from wire.model import Message, Vec2, Vec3

KNIVES = ("Knife", "ButterKnife")
GRIP_S = 10.0
"""Longer than any grasp takes."""
STEP_BACK_S, STEP_BACK_MPS = 1.0, -0.3
MOST_TRIES = 5
MOST_SIDES, MOST_SIDES_TO_PUT = 3, 2
"""What is full on one side is rarely free on a third; what is hidden may be seen from there."""
NEARER_M = 0.2
GATE_M, GATE_MOST_M = 0.6, 1.5


class OnTarget(Message):
    """The object to act on."""

    target: Target


class OnTargetWithItem(Message):
    """Where to put what is in the hand."""

    target: Target
    item: Target | None = None


@dataclass
class Attempt:
    """What was learnt so far about one thing to handle."""

    target: Target
    action: GripperAction
    point_enu_m: Vec3
    seen: bool = False
    looked_around: bool = False
    tried_from_m: list[Vec2] = field(default_factory=list)
    farthest_m: float = inf
    """Standing further off than this was out of reach."""

    @property
    def gate_m(self) -> float:
        """How far from where it is believed to be a thing of its type is still taken for it."""
        return min(GATE_MOST_M, GATE_M + 2.0 * self.target.spread_m)


def pickup(robot: Robot, command: Command) -> Skilled:
    """Take a small object into the hand. The hand must be empty, and a receptacle that the object is in be open."""
    if robot.body.holding:
        return Outcome("failed", "hand_full", f"the hand already holds {_held(robot.body)}")
    return (yield from _with_opening(robot, command, "pickup", command.target and command.target.inside))


def put(robot: Robot, command: Command) -> Skilled:
    """Put what is in the hand into or onto a receptacle, which must be open if it has a door."""
    if not robot.body.holding:
        return Outcome("failed", "not_holding", "there is nothing in the hand to put down")
    return (yield from _with_opening(robot, command, "put", command.target))


def open_(robot: Robot, command: Command) -> Skilled:
    """Open a door, lid or drawer of an object (fridge, cabinet, box, laptop, book, ...)."""
    return (yield from _handle(robot, command.target, "open"))


def close(robot: Robot, command: Command) -> Skilled:
    """Close a door, lid or drawer of an object."""
    return (yield from _handle(robot, command.target, "close"))


def toggle_on(robot: Robot, command: Command) -> Skilled:
    """Switch an appliance, a lamp or a tap on."""
    return (yield from _with_opening(robot, command, "toggle_on", command.target))


def toggle_off(robot: Robot, command: Command) -> Skilled:
    """Switch an appliance, a lamp or a tap off."""
    return (yield from _handle(robot, command.target, "toggle_off"))


def slice_(robot: Robot, command: Command) -> Skilled:
    """Cut food into slices where it lies. A knife must be in the hand."""
    held = robot.body.gripper.holding_type if robot.body.gripper else None
    if not robot.body.holding or held not in KNIVES:
        return Outcome("failed", "precondition", f"slicing needs a knife in the hand, which holds {_held(robot.body)}")
    return (yield from _handle(robot, command.target, "slice"))


def clean(robot: Robot, command: Command) -> Skilled:
    """Clean a dirty object where it is."""
    return (yield from _handle(robot, command.target, "clean"))


def _held(body: Body) -> str:
    if not body.holding or body.gripper is None:
        return "nothing"
    return f"a {body.gripper.holding_type}" if body.gripper.holding_type else "something"


def _with_opening(robot: Robot, command: Command, action: GripperAction, around: Target | None) -> Skilled:
    """Handle a thing; when what it is in (or goes into) turns out closed, open that and handle it then."""
    outcome = yield from _handle(robot, command.target, action)
    if outcome.code != "closed" or around is None:
        return outcome
    opened = yield from _handle(robot, around, "open")
    if opened.status != "done":
        return Outcome("failed", "closed", f"{outcome.reason}; opening {around.type} failed: {opened.reason}")
    again = yield from _handle(robot, command.target, action)
    return Outcome(again.status, again.code, f"{again.reason} (opened {around.type} first)", again.point_enu_m)


def _handle(robot: Robot, target: Target | None, action: GripperAction) -> Skilled:
    assert target is not None, "the parameters were checked when the command was accepted"
    body = robot.body
    attempt = Attempt(target, action, target.position_enu_m)
    yield from await_odometry(body)
    last = nothing_tried = Outcome("failed", "unreachable", f"{target.type}: nowhere to stand within reach")
    for _ in range(MOST_TRIES):
        if len(attempt.tried_from_m) >= (MOST_SIDES_TO_PUT if action == "put" else MOST_SIDES):
            break
        trouble = yield from _come_near(robot, attempt)
        if trouble is not None:
            return trouble if last is nothing_tried or trouble.code != "unreachable" else last
        if not places.within_reach(body.position_m, attempt.point_enu_m[:2], target.type):
            continue
        body.note = f"{action} {target.type}"
        last = yield from _grip(body, attempt)
        if last.status == "done" or last.code not in ("blocked", "unreachable", "not_there"):
            break
        yield from _recover(body, attempt, last.code)
        if last.code == "not_there" and not attempt.seen:
            break
    body.tilt(WALK_TILT_RAD)
    return last


def _come_near(robot: Robot, attempt: Attempt) -> Generator[None, None, Outcome | None]:
    """Stand within reach and look; None when ready for the hand."""
    body, target, point = robot.body, attempt.target, attempt.point_enu_m
    home, swings = robot.room(target.room or ""), attempt.action in ("open", "close")
    body.note = f"going to {target.type} to {attempt.action} it"

    def goals() -> dict[Cell, float]:
        tried, farthest_m = tuple(attempt.tried_from_m), attempt.farthest_m
        return dict(places.beside(body.floor, point[:2], target.type, home, tried, swings, farthest_m))

    walked = yield from walk(body, goals)
    if not walked.arrived:
        return Outcome("failed", walked.code, f"{target.type}: {walked.reason}")
    thing = yield from look_at(body, target.type, point, attempt.gate_m)
    if thing is None and body.sighted and not attempt.looked_around and not attempt.seen:
        attempt.looked_around = True
        thing = yield from look_around(body, target.type, point, attempt.gate_m)
    if thing is not None:
        attempt.seen, attempt.point_enu_m = True, thing.position_enu_m
        yield from look_at(body, target.type, thing.position_enu_m, attempt.gate_m, count=0)
    return None


def _grip(body: Body, attempt: Attempt) -> Generator[None, None, Outcome]:
    """One use of the hand, and what the driver says of it."""
    target, begun_s = attempt.target, body.clock_s
    body.stand()
    command_id = body.grip(attempt.action, attempt.point_enu_m, target.type)
    while body.gripping and body.clock_s - begun_s < GRIP_S:
        yield
    state = body.gripper
    if body.gripping or state is None or state.command_id != command_id:
        body.stop_waiting()
        return Outcome("failed", "driver", f"the gripper did not answer within {GRIP_S:.0f} s")
    point = state.point_enu_m or attempt.point_enu_m
    if state.ok:
        return Outcome("done", "ok", f"{attempt.action} {target.type}: done", point)
    code: ReasonCode = code_of(state.reason)
    said = f"{attempt.action} {target.type}: {state.reason}"
    return Outcome("done" if code == "already" else "failed", code, said, point)


def _recover(body: Body, attempt: Attempt, code: ReasonCode) -> Steps:
    """Change what can be changed before the next try."""
    if code == "blocked" and attempt.action in ("open", "close"):
        # The robot's own body may stand where the door swings.
        until_s = body.clock_s + STEP_BACK_S
        while body.clock_s < until_s:
            body.move(STEP_BACK_MPS, 0.0)
            yield
        body.stand()
    if code == "unreachable":
        attempt.farthest_m = distance_m(body.position_m, attempt.point_enu_m) - NEARER_M
    else:
        attempt.tried_from_m.append(body.position_m)
    if code == "not_there" and body.sighted and not attempt.looked_around:
        attempt.looked_around = True
        target = attempt.target
        thing = yield from look_around(body, target.type, attempt.point_enu_m, attempt.gate_m)
        attempt.seen = thing is not None
        if thing is not None and distance_m(thing.position_enu_m, attempt.point_enu_m) > 0.0:
            attempt.point_enu_m = thing.position_enu_m
