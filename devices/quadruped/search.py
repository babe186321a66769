"""Skills that look: through a room, and at one thing."""

from collections.abc import Generator
from functools import partial
from math import pi
from typing import TypeVar

from devices.quadruped import places
from devices.quadruped.gaze import look_around, look_at, take_pictures
from devices.quadruped.grid import Cell
from devices.quadruped.handle import GATE_M
from devices.quadruped.look import CLEAR_VIEW, FAR_FOR_SMALL_M, FAR_M, Thing
from devices.quadruped.moves import Skilled
from devices.quadruped.robot import Robot
from devices.quadruped.walk import Walked, await_odometry, face, walk
from devices.worker import Outcome
from wire.catalogue import catalogue
from wire.frames import distance_m
from wire.messages.command import Command
from wire.model import Id, Message, Vec2, Vec3, Word
from wire.site import Room

ENOUGH_LEFT_M2 = 0.4
"""The room has been seen when no more of it than this is left: less than what a fridge stands on."""
WORTH_A_LOOK_M2, WORTH_A_WALK_M2 = 0.3, 0.5
MOST_PLACES, MOST_HEADINGS, HEADINGS = 7, 8, 12
SEARCH_TILT_RAD = 0.42
"""The picture then reaches from the floor 0.7 m ahead to things above the camera's own height."""
SURE_AT_ONCE, SURE_TOGETHER, WORTH_COUNTING, SAME_PLACE_M = 0.8, 1.2, 0.35, 0.6
"""One picture that is sure, or several of the same place whose confidences add up."""
HFOV_RAD = pi / 2.0
MOST_SUSPECTS, SUSPECT_LOOKS = 3, 2
"""Places to look at again from near by when nothing was found for sure, and from how many sides."""
SMALL_M, SMALL_VIEW_M, LARGE_VIEW_M = 0.35, (0.8, 1.6), (1.0, 2.2)

End = TypeVar("End")


class Search(Message):
    """A room, and optionally types of objects whose sight ends the search."""

    room: Id
    looking_for: tuple[Word, ...] = ()


class Finder:
    """Takes in every picture of a search: what of the room it shows, and whether it shows what is looked for."""

    def __init__(self, robot: Robot, room: Room, looking_for: tuple[str, ...]) -> None:
        self._body, self._looking_for = robot.body, looking_for
        self._inside = robot.body.floor.inside(room.polygon_m)
        from devices.quadruped.coverage import Coverage  # numpy, which a robot without a camera does without

        far_m = FAR_FOR_SMALL_M if any(_is_small(type) for type in looking_for) else FAR_M
        self.coverage = Coverage(robot.body.floor, room.polygon_m, far_m)
        self._candidates: list[Thing] = []
        self._suspects: list[tuple[Vec3, str, float]] = []
        self._from_s = robot.body.now_s
        self.found: Thing | None = None

    def watch(self, steps: Generator[None, None, End]) -> Generator[None, None, End | None]:
        """Do these steps, but end them as soon as something is found."""
        while self.found is None:
            try:
                next(steps)
            except StopIteration as end:
                self._take_in()
                result: End = end.value
                return result
            self._take_in()
            yield
        steps.close()
        return None

    def inside(self, point_m: Vec2) -> bool:
        """Whether a point lies in the room."""
        return bool(self._inside[self._body.floor.cell(point_m)])

    def _take_in(self) -> None:
        for look in self._body.looks:
            if look.stamp_s <= self._from_s:
                continue
            self._from_s = look.stamp_s
            self.coverage.take(look)
            for thing in look.things:
                self._consider(thing)

    def _consider(self, thing: Thing) -> None:
        if not self.inside(thing.position_enu_m[:2]):
            return
        weights = {thing.type: thing.confidence, **thing.maybe}
        self._suspects += [(thing.position_enu_m, t, weights[t]) for t in self._looking_for if t in weights]
        if thing.type not in self._looking_for:
            return
        if thing.confidence < WORTH_COUNTING:
            return
        self._candidates.append(thing)
        agreeing = sum(
            other.confidence
            for other in self._candidates
            if other.type == thing.type and distance_m(other.position_enu_m, thing.position_enu_m) < SAME_PLACE_M
        )
        if thing.confidence >= SURE_AT_ONCE or agreeing >= SURE_TOGETHER:
            self.found = self.found or thing

    def suspects(self) -> list[tuple[Vec3, str]]:
        """Places where something was seen that may be what is looked for, the most suspicious first."""
        ranked: list[tuple[float, Vec3, str]] = []
        for place, type, _ in self._suspects:
            weight = sum(w for p, t, w in self._suspects if t == type and distance_m(p, place) < SAME_PLACE_M)
            ranked.append((weight, place, type))
        chosen: list[tuple[Vec3, str]] = []
        for _, place, type in sorted(ranked, reverse=True):
            if all(distance_m(place, other) >= SAME_PLACE_M for other, _ in chosen):
                chosen.append((place, type))
        return chosen[:MOST_SUSPECTS]


def explore(robot: Robot, command: Command) -> Skilled:
    """Go through a room and look at all of it from a few places; ends early when one of `looking_for` is seen."""
    body, room = robot.body, robot.room(command.room or "")
    assert room is not None, "the parameters were checked when the command was accepted"
    if not body.sighted:
        return Outcome("failed", "precondition", "this robot runs without its camera")
    yield from await_odometry(body)
    finder = Finder(robot, room, command.looking_for)
    trouble = yield from _look_through(robot, finder, room)
    if trouble is not None and finder.found is None:
        return Outcome("failed", trouble.code, f"{room.name}: {trouble.reason}")
    if finder.found is None:
        yield from _look_again(robot, finder, room)
    if finder.found is not None:
        return Outcome("done", "ok", f"found {finder.found.type} in {room.name}", finder.found.position_enu_m)
    wanted = f"; no {', '.join(command.looking_for)} seen" if command.looking_for else ""
    return Outcome("done", "ok", f"looked at {1.0 - finder.coverage.left:.0%} of {room.name}{wanted}")


def _look_through(robot: Robot, finder: Finder, room: Room) -> Generator[None, None, Walked | None]:
    """Look around from place after place; tells why when the robot did not get into the room at all."""
    body, coverage = robot.body, finder.coverage
    tried_m: list[Vec2] = []
    been, walked = False, None
    while coverage.left * coverage.area_m2 > ENOUGH_LEFT_M2 and len(tried_m) < MOST_PLACES:
        body.note = f"looking through {room.name}, {coverage.left:.0%} left"
        body.fraction = 1.0 - coverage.left
        best = coverage.best_place(body.position_m, tried_m)
        if been and (best is None or best[1] * coverage.area_m2 < WORTH_A_WALK_M2):
            break
        body.tilt(SEARCH_TILT_RAD)
        if best is not None:
            steps = walk(body, partial(places.near_point, body.floor, best[0]), no_way_tries=0)
        else:
            steps = walk(body, partial(places.in_room, body.floor, room, robot.site.door))
        walked = yield from finder.watch(steps)
        been = been or finder.inside(body.position_m)
        if best is None and not been:
            break
        tried_m.append(best[0] if best is not None else body.position_m)
        yield from finder.watch(_look_round(robot, finder))
        if finder.found is not None:
            break
    return None if been else walked


def _look_again(robot: Robot, finder: Finder, room: Room) -> Generator[None, None, None]:
    """Go nearer to what may be looked for but was not sure."""
    body = robot.body
    for place, type in finder.suspects():
        between_m, tried = SMALL_VIEW_M if _is_small(type) else LARGE_VIEW_M, list[Vec2]()
        for _ in range(SUSPECT_LOOKS):
            goals = partial(places.in_view, body.floor, place[:2], between_m, room, tuple(tried))
            walked = yield from finder.watch(walk(body, goals))
            if finder.found is not None or walked is None or not walked.arrived:
                break
            tried.append(body.position_m)
            yield from finder.watch(look_at(body, type, place, GATE_M, count=3))
            if finder.found is not None:
                return


def _look_round(robot: Robot, finder: Finder) -> Generator[None, None, None]:
    """Turn to where most is still to be seen, as long as that is worth a look."""
    body = robot.body
    for _ in range(MOST_HEADINGS):
        yaws = [body.yaw_rad + 2.0 * pi * k / HEADINGS for k in range(HEADINGS)]
        gains = [finder.coverage.gain(body.position_m, yaw, CLEAR_VIEW * HFOV_RAD) for yaw in yaws]
        best = max(range(HEADINGS), key=lambda k: (gains[k] - 0.01 * min(k, HEADINGS - k), -k))
        if gains[best] * finder.coverage.area_m2 < WORTH_A_LOOK_M2:
            return
        yield from face(body, yaws[best])
        yield from take_pictures(body, 1)


def inspect(robot: Robot, command: Command) -> Skilled:
    """Look at an object from near by, to see whether it is there and in what state."""
    body, target = robot.body, command.target
    assert target is not None, "the parameters were checked when the command was accepted"
    if not body.sighted:
        return Outcome("failed", "precondition", "this robot runs without its camera")
    yield from await_odometry(body)
    between_m, home = SMALL_VIEW_M if _is_small(target.type) else LARGE_VIEW_M, robot.room(target.room or "")
    point, gate_m = target.position_enu_m, GATE_M + 2.0 * target.spread_m
    tried: list[Vec2] = []

    def goals() -> dict[Cell, float]:
        return dict(places.in_view(body.floor, point[:2], between_m, home, tuple(tried)))

    for _ in range(2):
        walked = yield from walk(body, goals)
        if not walked.arrived and not tried:
            return Outcome("failed", walked.code, f"{target.type}: {walked.reason}")
        thing = (yield from look_at(body, target.type, point, gate_m)) if walked.arrived else None
        if thing is None:
            thing = yield from look_around(body, target.type, point, gate_m)
        body.action_steps += 1
        if thing is not None:
            states = ", ".join(f"{name} {value:.0%}" for name, value in sorted(thing.props.items()))
            return Outcome("done", "ok", f"saw {target.type} {states}".rstrip(), thing.position_enu_m)
        tried.append(body.position_m)
    return Outcome("failed", "not_there", f"looked where {target.type} was believed to be and did not see it")


def _is_small(type: str) -> bool:
    row = catalogue().get(type)
    return row is not None and max(row.size_m) < SMALL_M
