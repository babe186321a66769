"""Skills that only move the drone. All but landing end in hover."""

from collections.abc import Generator
from math import radians

from pydantic import Field, field_validator, model_validator

from devices.drone.course import Course, Limits
from devices.drone.craft import Craft
from devices.drone.flight import ahead, face, failed, fly, fly_to, get_up, go_to, turn
from devices.drone.landing import come_down
from devices.drone.places import near_target, place_of
from devices.drone.spline import through
from devices.worker import Outcome
from wire.messages.command import Command, Target
from wire.model import Id, Message, Vec2, Vec3

Skilled = Generator[None, None, Outcome]
MOST_POINTS = 60
LEAST_M, MOST_M = 0.4, 50.0


class Nothing(Message):
    """Takes nothing."""


class Height(Message):
    """`height_m` above the floor; the drone's usual one when it is left out."""

    height_m: float | None = Field(default=None, ge=LEAST_M, le=MOST_M)


class Pause(Message):
    """So long it does not go on to the next thing."""

    seconds: float = Field(default=0.0, ge=0.0, le=600.0)


class Place(Message):
    """Exactly one of object, room and point."""

    target: Target | None = None
    room: Id | None = None
    point_m: Vec2 | None = None

    @model_validator(mode="after")
    def _is_one(self) -> "Place":
        if sum(value is not None for value in (self.target, self.room, self.point_m)) != 1:
            raise ValueError("give exactly one of target, room and point_m")
        return self


class Destination(Place):
    """A place, how high above the floor, and where to face in the end (degrees from east, counter-clockwise)."""

    height_m: float | None = Field(default=None, ge=LEAST_M, le=MOST_M)
    yaw_deg: float | None = Field(default=None, ge=-360.0, le=360.0)


class Way(Message):
    """`way_m`: points "east north height; east north height; ..." in metres."""

    way_m: str = Field(max_length=2000)
    speed_mps: float = Field(default=0.8, gt=0.0, le=3.0)

    @field_validator("way_m")
    @classmethod
    def _is_way(cls, value: str) -> str:
        way_points(value)
        return value


def way_points(text: str) -> list[Vec3]:
    """Raises ValueError with a sentence."""
    points: list[Vec3] = []
    for part in filter(str.strip, text.split(";")):
        try:
            x, y, z = (float(word) for word in part.replace(",", " ").split())
        except ValueError:
            raise ValueError(f"{part.strip()!r} is not three numbers, as in '1.0 2.5 1.5; 3.0 2.5 1.5'") from None
        if not all(-1e4 < value < 1e4 for value in (x, y, z)):
            raise ValueError(f"{part.strip()!r} is not in the building")
        if not points or points[-1] != (x, y, z):
            points.append((x, y, z))
    if not 2 <= len(points) <= MOST_POINTS:
        raise ValueError(f"{len(points)} points are given; a way has 2 to {MOST_POINTS}")
    return points


def take_off(craft: Craft, command: Command) -> Skilled:
    """Take off and hover."""
    height_m = float(command.params.get("height_m") or craft.cruise_m)
    if craft.airborne:
        return Outcome("done", "already", f"in the air already, at {craft.position_m[2]:.1f} m")
    trouble = yield from get_up(craft, height_m)
    return trouble or Outcome("done", "ok", f"hovering at {craft.position_m[2]:.1f} m", craft.position_m)


def land(craft: Craft, command: Command) -> Skilled:
    """Land where it is and stop the rotors."""
    return (yield from land_here(craft))


def land_here(craft: Craft) -> Skilled:
    if not craft.airborne:
        return Outcome("done", "already", "on the ground already")
    trouble = yield from come_down(craft)
    return trouble or Outcome("done", "ok", "landed", craft.position_m)


def goto(craft: Craft, command: Command) -> Skilled:
    """Fly to a point, into a room, or near an object and face it; through doors, clear of walls. Takes off if needed."""
    height_m = float(command.params.get("height_m") or craft.cruise_m)
    middle_m, name = place_of(craft, command)
    craft.note = f"flying to {name}"
    goal_m = near_target(craft, middle_m, height_m) if command.target else place_to_be(craft, command, height_m)
    if goal_m is None:
        return failed("unreachable", f"{name}: there is nowhere to hover near it at {height_m:.1f} m")
    trouble = yield from go_to(craft, goal_m)
    if trouble is None and command.target is not None:
        trouble = yield from face(craft, middle_m)
    if trouble is None and "yaw_deg" in command.params:
        trouble = yield from turn(craft, radians(float(command.params["yaw_deg"])))
    if trouble is not None:
        return Outcome(trouble.status, trouble.code, f"{name}: {trouble.reason}")
    return Outcome("done", "ok", f"hovering at {name}", craft.position_m)


def place_to_be(craft: Craft, command: Command, height_m: float) -> Vec3 | None:
    """A point is meant as it stands; the middle of a room as near as it can be."""
    middle_m, _ = place_of(craft, command)
    if command.room is None:
        return (*middle_m, height_m)
    return near_target(craft, middle_m, height_m, 0.0)


def follow_path(craft: Craft, command: Command) -> Skilled:
    """Fly a smooth curve through points, facing where it flies; each point is "east north height" in metres."""
    params = Way.model_validate(command.params)
    points = way_points(params.way_m)
    course = Course(through(points), Limits(speed_mps=params.speed_mps))
    if fault := craft.space.first_fault(course.points_m):
        return failed("blocked", f"the curve through these points is blocked: {fault}")
    craft.note = "flying to the beginning of the path"
    with craft.part(0.0, 0.5):
        trouble = yield from go_to(craft, points[0])
    craft.note = f"following the path of {course.length_m:.1f} m"
    with craft.part(0.5, 1.0):
        trouble = trouble or (yield from fly(craft, course, ahead))
    return trouble or Outcome("done", "ok", f"flew {course.length_m:.1f} m of path", craft.position_m)


def hold(craft: Craft, command: Command) -> Skilled:
    """Hover where it is, for some seconds if they are given."""
    if not craft.airborne:
        return failed("precondition", "it stands on the ground; take off first")
    craft.hover()
    until_s = craft.now_s + float(command.params.get("seconds", 0.0))
    craft.note = "hovering"
    while craft.now_s < until_s:
        yield
    return Outcome("done", "ok", "hovering", craft.position_m)


def return_home(craft: Craft, command: Command) -> Skilled:
    """Fly back to where it took off, through the doors, and land there."""
    return (yield from go_home(craft))


def go_home(craft: Craft) -> Skilled:
    if not craft.airborne:
        return Outcome("done", "already", "on the ground already")
    if craft.home_m is None:
        return failed("precondition", "it was in the air already when this process began, so home is not known")
    home_m = (*craft.home_m[:2], min(craft.cruise_m, craft.space.top_m(craft.home_m)))
    craft.note = "flying home"
    trouble = yield from fly_to(craft, home_m)
    trouble = trouble or (yield from come_down(craft))
    return trouble or Outcome("done", "ok", "home, and landed", craft.position_m)
