"""From a node of a plan to the command that a robot is given."""

from math import sqrt

from hub.dispatch import Dispatch
from hub.fleet import Robot
from hub.plan import Step
from hub.records import Thing
from hub.things import Things
from wire.messages.command import Command, Target
from wire.messages.plan import Action

_START_WITHIN_S = 20.0
_SLOWEST_MPS = 0.2
_WORK_S: dict[Action, float] = {"explore": 180.0, "goto": 25.0, "inspect": 40.0, "clean": 60.0, "slice": 60.0}
_HANDS_S = 50.0


def order(
    step: Step, robot: Robot, goal_id: str, epoch: int, things: Things, dispatch: Dispatch, now_s: float
) -> Command:
    """The command for one node and one robot, with what is believed now of the things in it."""
    node = step.node
    place = dispatch.place(step)
    walk_m = dispatch.distances.walk_m(robot.xy, (place[0], place[1])) if place is not None else 0.0
    thing, item = things.get(node.object), things.get(node.item)
    return Command(
        goal_id=goal_id,
        epoch=epoch,
        robot=robot.id,
        action=node.action,
        target=target(thing, things) if thing is not None else None,
        item=target(item, things) if item is not None else None,
        room=node.room,
        point_m=node.point_m,
        looking_for=node.looking_for,
        params=node.params,
        valid_until_s=now_s + _START_WITHIN_S,
        timeout_s=_WORK_S.get(node.action, _HANDS_S) + min(walk_m, 200.0) / _SLOWEST_MPS,
    )


def put_down(
    robot: Robot, surface: Thing, walk_m: float, goal_id: str, epoch: int, things: Things, now_s: float
) -> Command:
    """The command to lay whatever is in the hand onto a surface."""
    return Command(
        goal_id=goal_id,
        epoch=epoch,
        robot=robot.id,
        action="put",
        target=target(surface, things),
        valid_until_s=now_s + _START_WITHIN_S,
        timeout_s=_HANDS_S + min(walk_m, 200.0) / _SLOWEST_MPS,
    )


def target(thing: Thing, things: Things) -> Target:
    """What the hub believes of a thing and of what it is in."""
    holder = things.get(thing.receptacle)
    return Target(
        id=thing.id,
        type=thing.type,
        position_enu_m=(thing.x, thing.y, thing.z),
        spread_m=sqrt(max(thing.xx, thing.yy)),
        room=thing.room,
        inside=_shallow(holder) if holder is not None else None,
    )


def _shallow(thing: Thing) -> Target:
    return Target(
        id=thing.id,
        type=thing.type,
        position_enu_m=(thing.x, thing.y, thing.z),
        spread_m=sqrt(max(thing.xx, thing.yy)),
        room=thing.room,
    )
