"""Skills that look: at a thing or a place from beside or above, all around it, over a whole room."""

from collections.abc import Generator, Sequence
from itertools import islice
from math import ceil, dist, pi

from pydantic import Field, model_validator

from devices.drone.course import Course, Limits
from devices.drone.craft import Craft
from devices.drone.flight import face, failed, fly, go_to, keep, obey, towards
from devices.drone.moves import LEAST_M, MOST_M, Place, Skilled
from devices.drone.pilot import Shoot
from devices.drone.places import half_size_m, near_target, place_of, room_of
from devices.drone.spline import through
from devices.drone.survey import ring, sweep
from devices.worker import Outcome
from wire.frames import bearing_rad
from wire.messages.command import Command, Target
from wire.model import Id, Message, Vec2

PICTURE_S = 4.0
"""From the order to the camera's word that the picture is taken."""
WALL_M = 0.5
ORBIT_MPS, SURVEY_MPS = 0.6, 0.8
POINTS_PER_TURN = 16
MOST_STATIONS = 400


class LookAt(Place):
    """What to look at, from how far from its side and how high."""

    distance_m: float = Field(default=1.0, ge=0.4, le=10.0)
    height_m: float | None = Field(default=None, ge=LEAST_M, le=MOST_M)


class FromAbove(Place):
    """What to hover over, and how high; as high as the ceiling allows when it is left out."""

    height_m: float | None = Field(default=None, ge=LEAST_M, le=MOST_M)


class Orbit(Message):
    """An object or a point, how far from its middle, how high, and how many turns (negative: clockwise)."""

    target: Target | None = None
    point_m: Vec2 | None = None
    radius_m: float = Field(default=1.2, ge=0.4, le=10.0)
    height_m: float | None = Field(default=None, ge=LEAST_M, le=MOST_M)
    turns: float = Field(default=1.0, ge=-5.0, le=5.0)

    @model_validator(mode="after")
    def _is_one(self) -> "Orbit":
        if (self.target is None) == (self.point_m is None):
            raise ValueError("give exactly one of target and point_m")
        if self.turns == 0.0:
            raise ValueError("turns: 0 is no orbit; give 1 for once around")
        return self


class Survey(Message):
    """A room, or a rectangle from its south-west corner. Pictures are `spacing_m` apart."""

    room: Id | None = None
    west_m: float | None = None
    south_m: float | None = None
    width_m: float | None = Field(default=None, gt=0.0, le=200.0)
    depth_m: float | None = Field(default=None, gt=0.0, le=200.0)
    height_m: float | None = Field(default=None, ge=LEAST_M, le=MOST_M)
    spacing_m: float = Field(default=1.0, ge=0.2, le=20.0)

    @model_validator(mode="after")
    def _is_one(self) -> "Survey":
        corners = [value is not None for value in (self.west_m, self.south_m, self.width_m, self.depth_m)]
        if any(corners) != all(corners) or (self.room is None) != all(corners):
            raise ValueError("give either room or all of west_m, south_m, width_m and depth_m")
        return self


def take_picture(craft: Craft, command: Command) -> Skilled:
    """Take a picture with the vehicle's camera."""
    craft.note = "taking a picture"
    taken, said = yield from _shoot(craft)
    if not taken:
        return failed("driver", said)
    x, y, z = craft.position_m
    return Outcome("done", "ok", f"{said} at ({x:.1f}, {y:.1f}), {z:.1f} m high", craft.position_m)


def look_at(craft: Craft, command: Command) -> Skilled:
    """Fly to a place beside an object, a room's middle or a point, look at it, and take a picture."""
    params = LookAt.model_validate(_given(command))
    middle_m, name = place_of(craft, command)
    away_m = params.distance_m + (half_size_m(command.target.type) if command.target is not None else 0.0)
    return (yield from _see(craft, middle_m, name, away_m, params.height_m or craft.row.flight_height_m))


def inspect_from_above(craft: Craft, command: Command) -> Skilled:
    """Hover above an object, the middle of a room or a point, and take a picture of it from there."""
    params = FromAbove.model_validate(_given(command))
    middle_m, name = place_of(craft, command)
    height_m = params.height_m or max(craft.row.flight_height_m, craft.space.top_m(middle_m))
    return (yield from _see(craft, middle_m, name, 0.0, min(height_m, MOST_M)))


def orbit(craft: Craft, command: Command) -> Skilled:
    """Fly around an object or a point, looking at it all the time."""
    params = Orbit.model_validate(_given(command))
    middle_m, name = place_of(craft, command)
    height_m = params.height_m or craft.row.flight_height_m
    count = ceil(abs(params.turns) * POINTS_PER_TURN)
    from_rad = bearing_rad(middle_m, craft.position_m[:2])
    circle = ring(middle_m, params.radius_m, from_rad, 2.0 * pi * params.turns, count)
    course = Course(through([(x, y, height_m) for x, y in circle]), Limits(speed_mps=ORBIT_MPS))
    if fault := craft.space.first_fault(course.points_m):
        return failed("blocked", f"no room to fly around {name} at {params.radius_m:.1f} m: {fault}")
    craft.note = f"flying to {name}"
    with craft.part(0.0, 0.5):
        trouble = yield from go_to(craft, course.points_m[0])
    trouble = trouble or (yield from face(craft, middle_m))
    craft.note = f"flying around {name}"
    with craft.part(0.5, 1.0):
        trouble = trouble or (yield from fly(craft, course, towards(middle_m)))
    return trouble or Outcome("done", "ok", f"flew around {name}", craft.position_m)


def construct_map(craft: Craft, command: Command) -> Skilled:
    """Survey a room or a rectangle: fly over it in lanes at one height and take a picture at every station."""
    params = Survey.model_validate(_given(command))
    height_m = params.height_m or craft.row.flight_height_m
    planned = list(islice(sweep(_ground(craft, params), params.spacing_m, WALL_M), MOST_STATIONS + 1))
    if len(planned) > MOST_STATIONS:
        return failed("precondition", f"more than {MOST_STATIONS} pictures; give a wider spacing_m")
    stations = [point for x, y in planned if not craft.space.fault(point := (x, y, height_m))]
    if not stations:
        return failed("unreachable", f"there is nowhere in it to fly at {height_m:.1f} m")
    taken, why = 0, ""
    for number, station in enumerate(stations):
        craft.note = f"surveying: station {number + 1} of {len(stations)}"
        with craft.part(number / len(stations), (number + 1) / len(stations)):
            trouble = yield from go_to(craft, station, keep, Limits(speed_mps=SURVEY_MPS))
        if trouble is not None and trouble.code not in ("unreachable", "blocked"):
            return Outcome(trouble.status, trouble.code, f"after {taken} pictures: {trouble.reason}")
        if trouble is None:
            ok, said = yield from _shoot(craft)
            if not ok and not taken:
                return failed("driver", said)
            taken += ok
            why = why if ok else said
        else:
            why = trouble.reason
    seen = f"{taken} of {len(stations)} pictures taken"
    if not taken:
        return failed("driver", f"{seen}: {why}")
    return Outcome("done", "ok", f"{seen}; {why}" if taken < len(stations) else seen, craft.position_m)


def _ground(craft: Craft, params: Survey) -> Sequence[Vec2]:
    if params.west_m is None or params.south_m is None or params.width_m is None or params.depth_m is None:
        room = room_of(craft, params.room)
        return room.polygon_m if room is not None else ()
    west, south = params.west_m, params.south_m
    east, north = west + params.width_m, south + params.depth_m
    return ((west, south), (east, south), (east, north), (west, north))


def _given(command: Command) -> dict[str, object]:
    """What was checked when the command was accepted: its fields and the skill's own parameters."""
    fields = {"target": command.target, "room": command.room, "point_m": command.point_m}
    return {**{name: value for name, value in fields.items() if value is not None}, **command.params}


def _shoot(craft: Craft) -> Generator[None, None, tuple[bool, str]]:
    """Take a picture: whether the camera says that it has, and what to say of it."""
    craft.pictures.clear()
    if reason := (yield from obey(craft, Shoot())):
        return False, f"no picture was taken: {reason}"
    craft.action_steps += 1
    until_s = craft.now_s + PICTURE_S
    while not craft.pictures:
        if craft.now_s > until_s:
            return False, f"the camera took the order, but has told of no picture within {PICTURE_S:.0f} s"
        yield
    picture = craft.pictures.popleft()
    return picture.ok, f"picture {picture.index} taken" if picture.ok else "the camera could not take the picture"


def _see(craft: Craft, middle_m: Vec2, name: str, away_m: float, height_m: float) -> Skilled:
    """Go there, face it, and take a picture."""
    craft.note = f"flying to where {name} is seen"
    goal_m = near_target(craft, middle_m, height_m, away_m)
    if goal_m is None:
        return failed("unreachable", f"{name}: there is nowhere to see it from at {height_m:.1f} m")
    trouble = yield from go_to(craft, goal_m)
    trouble = trouble or (yield from face(craft, middle_m))
    if trouble is not None:
        return Outcome(trouble.status, trouble.code, f"{name}: {trouble.reason}")
    taken, said = yield from _shoot(craft)
    seen = f"{name} seen from {dist(craft.position_m[:2], middle_m):.1f} m beside, {craft.position_m[2]:.1f} m high"
    return Outcome("done", "ok", f"{seen}; {said}" if taken else f"{seen}, but no picture: {said}", craft.position_m)
