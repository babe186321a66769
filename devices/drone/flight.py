"""What every skill is made of: getting up, flying a course, turning. Generators: one step at each `next`.

They return None when all went well, and how the skill ends when not.
"""

from collections.abc import Callable, Generator
from math import dist, hypot, inf

from devices.drone.airspace import Airspace
from devices.drone.course import DEFAULT, Course, Limits, along_legs
from devices.drone.craft import Craft
from devices.drone.follow import LONGEST_STEP_S, Follower, turned
from devices.drone.pilot import Arm, Disarm, Order, Setpoint, Steer, TakeOff
from devices.drone.route import Seeking, find_way
from devices.worker import Outcome
from wire.frames import bearing_rad, wrap_rad
from wire.messages.command import ReasonCode
from wire.model import Vec2, Vec3

Trouble = Generator[None, None, Outcome | None]
Facing = Callable[[Vec3, Vec3], float | None]
"""From position and velocity to the yaw wanted there; None keeps it."""

LEAST_BATTERY = 0.2
"""Less than this and nothing new is begun."""
READY_S = 4.0
"""What an autopilot says of its health comes with its heartbeats: just found, it may not have said yet."""
TAKE_OFF_SHARE = 0.2
"""Of the way to a place that is begun on the ground, as progress is told."""
TAKE_OFF_S, NEAR_HEIGHT_M = 15.0, 0.2
LATE_S = 5.0
WAY_S, WAY_AGAIN_S = 12.0, 1.0
"""How long to wait for things to be gone that stand in the way, or are wrongly believed to; how often to look."""
OFF_COURSE_M = 0.5
FACED_RAD = 0.08
TURN_S = 10.0
SIGHT_MPS = 0.2
"""Slower than this it is not turned into its way."""
RIGHT_OVER_M = 0.2
"""Nearer than this beside a point, its bearing turns with every drift."""
STILL = (0.0, 0.0, 0.0)


def failed(code: ReasonCode, reason: str) -> Outcome:
    return Outcome("failed", code, reason)


def obey(craft: Craft, order: Order) -> Generator[None, None, str]:
    """Give an order and wait for the autopilot's answer: why it refused, or empty."""
    ask = craft.ask(order)
    while ask.reason is None:
        yield
    return f"{ask.reason}{craft.why()}" if ask.reason else ""


def unready(craft: Craft) -> Outcome | None:
    """Why the drone cannot begin to fly, or fly on to something new."""
    telemetry = craft.telemetry
    if telemetry is None or craft.found is None:
        return failed("precondition", f"no autopilot has been heard at {craft.row.link} yet{craft.why()}")
    if craft.found.fault:
        return failed("precondition", craft.found.fault)
    if not telemetry.located or telemetry.position_enu_m is None:
        return failed("precondition", f"the autopilot has no position estimate{craft.why()}")
    if craft.space.top_m(craft.position_m) == -inf:
        x, y, _ = craft.position_m
        hint = "origin_enu_m and north_deg of the site file say how the autopilot's frame lies in the building"
        return failed("precondition", f"it is at ({x:.1f}, {y:.1f}), outside the rooms of the site; {hint}")
    if telemetry.battery is not None and telemetry.battery < LEAST_BATTERY:
        least = f"{LEAST_BATTERY:.0%} is needed to begin"
        return failed("precondition", f"the battery is at {telemetry.battery:.0%}, {least}")
    if not craft.airborne and not telemetry.armable and not telemetry.armed:
        return failed("precondition", f"the autopilot does not let itself be armed{craft.why()}")
    return None


def get_up(craft: Craft, height_m: float) -> Trouble:
    """Into the air, if it is not yet, straight up."""
    trouble, begun_s = unready(craft), craft.now_s
    while trouble is not None and craft.now_s - begun_s < READY_S:
        craft.note = trouble.reason
        yield
        trouble = unready(craft)
    if trouble is not None or (craft.airborne and not craft.landing):
        return trouble
    if craft.airborne:
        craft.hover()
        return None
    top_m = craft.space.top_m(craft.position_m)
    if height_m > top_m:
        return failed("precondition", f"{height_m:.1f} m is too high here: at most {top_m:.1f} m under the ceiling")
    while craft.column_taken:
        craft.note = "waiting to take off: somebody is over it"
        yield
    craft.note = f"taking off to {height_m:.1f} m"
    if craft.telemetry is not None and not craft.telemetry.armed:
        if reason := (yield from obey(craft, Arm())):
            return failed("precondition", f"not armed: {reason}")
        craft.action_steps += 1
    begun_m = craft.position_m[2]
    if reason := (yield from obey(craft, TakeOff(height_m))):
        yield from obey(craft, Disarm())
        return failed("driver", f"the take-off was refused: {reason}")
    craft.action_steps += 1
    deadline_s = craft.now_s + TAKE_OFF_S
    while craft.position_m[2] < begun_m + height_m - NEAR_HEIGHT_M or not craft.airborne:
        craft.get_on((craft.position_m[2] - begun_m) / height_m)
        if craft.now_s > deadline_s:
            return failed("driver", f"only {craft.position_m[2]:.1f} m high after {TAKE_OFF_S:.0f} s{craft.why()}")
        yield
        if craft.airborne and not craft.moving:  # halted or led aside: the autopilot does not climb on by itself
            return (yield from _climb_on(craft, begun_m + height_m))
    return None


def _climb_on(craft: Craft, height_m: float) -> Trouble:
    while craft.column_taken:
        craft.note = "waiting to climb on: somebody is over it"
        yield
    x, y, z = craft.standing_m
    top_m = max(z, min(height_m, craft.space.top_m((x, y))))
    return (yield from fly(craft, Course(along_legs([(x, y, z), (x, y, top_m)]), DEFAULT), keep))


def go_to(craft: Craft, goal_m: Vec3, facing: Facing | None = None, limits: Limits = DEFAULT) -> Trouble:
    """To a place; up first where it stands on the ground."""
    if fault := craft.space.fault(goal_m):
        return failed("unreachable", fault)
    first = 0.0 if craft.airborne else TAKE_OFF_SHARE
    with craft.part(0.0, first):
        trouble = yield from get_up(craft, min(craft.cruise_m, craft.space.top_m(craft.position_m)))
    with craft.part(first, 1.0):
        return trouble or (yield from fly_to(craft, goal_m, facing, limits))


def fly_to(craft: Craft, goal_m: Vec3, facing: Facing | None = None, limits: Limits = DEFAULT) -> Trouble:
    """To a place by a way that is clear of walls and goes through doors.

    For what is in the air: to go on, home or out of the way it needs no more battery than it has.
    """
    way, begun_s = (yield from _way(craft, craft.space, goal_m)), craft.now_s
    if way is None:
        where = f"({goal_m[0]:.1f}, {goal_m[1]:.1f}) at {goal_m[2]:.1f} m"
        bare = yield from _way(craft, craft.space.without_things(), goal_m)
        if bare is None:
            return failed("unreachable", f"there is no way to {where} that the drone fits through")
        while way is None:
            things = ", ".join(craft.space.in_the_way(bare)) or "something"
            craft.note = f"waiting for the way to {where}: {things}"
            if craft.now_s - begun_s > WAY_S:
                return failed("blocked", f"{things} is in the way")
            asked_s = craft.now_s
            while craft.now_s - asked_s < WAY_AGAIN_S:
                yield
                if craft.by_hand:
                    return taken_over(craft)
            way = yield from _way(craft, craft.space, goal_m)
    return (yield from fly(craft, Course(along_legs(way), limits), facing or ahead))


def _way(craft: Craft, space: Airspace, goal_m: Vec3) -> Seeking[Vec3]:
    return (yield from find_way(space, craft.standing_m, goal_m, craft.row.flight_height_m, craft.level_m))


def ahead(position_m: Vec3, velocity_mps: Vec3) -> float | None:
    """Facing where it flies."""
    fast = hypot(velocity_mps[0], velocity_mps[1]) > SIGHT_MPS
    return bearing_rad((0.0, 0.0), (velocity_mps[0], velocity_mps[1])) if fast else None


def keep(position_m: Vec3, velocity_mps: Vec3) -> float | None:
    """Not turning."""
    return None


def towards(point_m: Vec2) -> Facing:
    """Facing a point."""
    return lambda position_m, velocity_mps: (
        bearing_rad(position_m[:2], point_m) if dist(position_m[:2], point_m) > RIGHT_OVER_M else None
    )


def fly(craft: Craft, course: Course, facing: Facing) -> Trouble:
    """Along a course to its end. What interrupts it, it comes back from to where it had stopped."""
    follower = Follower(course, craft.now_s)
    yaw_rad, stepped_s, begun = craft.yaw_rad, craft.now_s, False
    craft.action_steps += 1
    while not (craft.steered and follower.arrived(craft.position_m)):
        if not craft.steered:
            follower.stand(craft.now_s)
            trouble = (yield from _come_back(craft, follower.stop_m)) if begun else None
            trouble = trouble or (yield from _take_up(craft, follower.stop_m, yaw_rad))
            if trouble is not None:
                return trouble
            follower.stand(craft.now_s)
            yaw_rad, stepped_s, begun = craft.yaw_rad, craft.now_s, True
        position_m, velocity_mps = follower.step(craft.now_s, craft.position_m, craft.may_move)
        wanted_rad = facing(position_m, velocity_mps)
        if wanted_rad is not None:
            yaw_rad = turned(yaw_rad, wanted_rad, min(craft.now_s - stepped_s, LONGEST_STEP_S))
        stepped_s = craft.now_s
        craft.fly(Setpoint(position_m, velocity_mps, yaw_rad))
        craft.stop_m = follower.stop_m
        _tell_path(craft, course, follower.clock_s)
        craft.get_on(follower.fraction)
        yield
        if craft.taken_over:
            return taken_over(craft)
        if follower.late_s > LATE_S:
            off_m = dist(craft.position_m, course.at(follower.clock_s)[0])
            return failed("blocked", f"does not get on: {off_m:.1f} m from where it should be{craft.why()}")
    craft.path_m, craft.path_heights_m = (), ()
    return None


def taken_over(craft: Craft) -> Outcome:
    return failed("interrupted", f"the autopilot has gone over to {craft.mode}{craft.why()}")


def _come_back(craft: Craft, where_m: Vec3) -> Trouble:
    """What was led away meanwhile flies back by a way that is clear."""
    return (yield from fly_to(craft, where_m)) if dist(craft.position_m, where_m) > OFF_COURSE_M else None


def _take_up(craft: Craft, where_m: Vec3, yaw_rad: float) -> Trouble:
    """Begin to steer there, unless a person has taken it over meanwhile."""
    if craft.by_hand:
        return taken_over(craft)
    if reason := (yield from obey(craft, Steer(Setpoint(where_m, STILL, yaw_rad)))):
        return failed("driver", f"the autopilot takes no setpoints: {reason}")
    return None


def face(craft: Craft, point_m: Vec2) -> Trouble:
    """Turn to a point, unless it is right above or below."""
    wanted_rad = towards(point_m)(craft.position_m, STILL)
    return (yield from turn(craft, wanted_rad)) if wanted_rad is not None else None


def turn(craft: Craft, wanted_rad: float) -> Trouble:
    """Turn on the spot."""
    where_m = craft.stop_m or craft.position_m
    yaw_rad, stepped_s, begun_s = craft.yaw_rad, craft.now_s, craft.now_s
    while abs(wrap_rad(wanted_rad - craft.yaw_rad)) > FACED_RAD:
        if not craft.steered:
            trouble = yield from _come_back(craft, where_m)
            trouble = trouble or (yield from _take_up(craft, where_m, craft.yaw_rad))
            if trouble is not None:
                return trouble
            yaw_rad, stepped_s, begun_s = craft.yaw_rad, craft.now_s, craft.now_s
        yaw_rad = turned(yaw_rad, wanted_rad, min(craft.now_s - stepped_s, LONGEST_STEP_S))
        stepped_s = craft.now_s
        craft.fly(Setpoint(where_m, STILL, yaw_rad))
        craft.stop_m = where_m
        yield
        if craft.taken_over:
            return taken_over(craft)
        if craft.now_s - begun_s > TURN_S:
            return failed("driver", f"does not turn{craft.why()}")
    return None


def _tell_path(craft: Craft, course: Course, clock_s: float) -> None:
    """What is left of it, a corner every half metre."""
    left = course.left_m(clock_s)
    points = [*left[:-1:10], left[-1]][1:]
    craft.path_m = tuple((p[0], p[1]) for p in points)
    craft.path_heights_m = tuple(round(p[2], 2) for p in points)
