"""Skills that only move the robot."""

from collections.abc import Generator

from pydantic import model_validator

from devices.quadruped import places
from devices.quadruped.grid import Cell
from devices.quadruped.robot import Robot
from devices.quadruped.walk import await_odometry, face_point, walk
from devices.worker import Outcome
from wire.messages.command import Command, Target
from wire.model import Id, Message, Vec2

Skilled = Generator[None, None, Outcome]


class Destination(Message):
    """Exactly one of the three."""

    target: Target | None = None
    room: Id | None = None
    point_m: Vec2 | None = None

    @model_validator(mode="after")
    def _is_one(self) -> "Destination":
        if sum(value is not None for value in (self.target, self.room, self.point_m)) != 1:
            raise ValueError("give exactly one of target, room and point_m")
        return self


def goto(robot: Robot, command: Command) -> Skilled:
    """Walk to a point of the floor, into a room, or to where an object can be reached, and face the object."""
    body, floor = robot.body, robot.body.floor
    yield from await_odometry(body)
    target, point_m = command.target, command.point_m
    room = robot.room(command.room or "")

    def goals() -> dict[Cell, float]:
        if target is not None:
            home = robot.room(target.room or "")
            return dict(places.beside(floor, target.position_enu_m[:2], target.type, home))
        if room is not None:
            return dict(places.in_room(floor, room, robot.site.door))
        return dict(places.near_point(floor, point_m or body.position_m))

    walked = yield from walk(body, goals)
    where = target.id if target else (room.name if room else "the point")
    if not walked.arrived:
        return Outcome("failed", walked.code, f"{where}: {walked.reason}")
    if target is not None:
        yield from face_point(body, target.position_enu_m[:2])
    return Outcome("done", "ok", f"at {where}", (*body.position_m, 0.0))
