"""Walking to one of several places: plan, follow, and plan again when the way turns out blocked.

Like every skill a generator that does one step at each `next` and returns when it is through.
"""

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass
from math import hypot

from devices.quadruped import path
from devices.quadruped.body import Body
from devices.quadruped.follow import CRUISE_MPS, FACING_RAD, NEAR_MPS, Follower, turn_rate
from devices.quadruped.grid import Cell
from devices.quadruped.spacing import edge_away, runs_into_other
from wire.frames import bearing_rad, wrap_rad
from wire.messages.command import ReasonCode
from wire.model import Vec2

Steps = Generator[None, None, None]
Goals = Callable[[], Mapping[Cell, float]]
"""Where to go and what each place costs extra, as the floor map is now."""

MAX_PLANS = 10
OFF_WAY, OTHER_IN_WAY = "off the way", "another robot is in the way"
NOBODYS_FAULT = (OFF_WAY, OTHER_IN_WAY)
"""What traffic brings with it; the goal's own timeout bounds how often."""
CHECK_AHEAD_M, TIGHT_M = 2.5, 0.37
OFF_WAY_M = 0.4
LEAVING_M = 0.2
STALL_S, STALL_M, STALL_RAD = 2.5, 0.05, 0.15
OTHER_PATIENCE_S = 4.0
STALE_S = 5.0
NO_WAY_TRIES = 3
NO_WAY_WAIT_S, NEXT_SWEEP_S = 3.0, 0.25
TOUCHING_S = 0.3


@dataclass(frozen=True)
class Walked:
    """How a walk ended; an empty reason is arrival."""

    code: ReasonCode = "ok"
    reason: str = ""

    @property
    def arrived(self) -> bool:
        return self.code == "ok"


def wait(body: Body, seconds: float) -> Steps:
    """Stand for a while."""
    until_s = body.clock_s + seconds
    body.stand()
    while body.clock_s < until_s:
        yield


def await_odometry(body: Body) -> Steps:
    """Nothing moves before the robot knows where it is."""
    while body.odometry is None:
        body.note = "waiting for the first odometry"
        yield


def face(body: Body, yaw_rad: float, within_rad: float = FACING_RAD) -> Steps:
    """Turn on the spot."""
    if abs(wrap_rad(yaw_rad - body.yaw_rad)) > within_rad:
        body.action_steps += 1
    begun_s = body.clock_s
    while abs(wrap_rad(yaw_rad - body.yaw_rad)) > within_rad:
        body.move(0.0, turn_rate(wrap_rad(yaw_rad - body.yaw_rad)))
        yield
        if not body.may_move:
            begun_s = body.clock_s
        if body.clock_s - begun_s > 2.0 * STALL_S:
            break
    body.stand()


def face_point(body: Body, point_m: Vec2, within_rad: float = FACING_RAD) -> Steps:
    yield from face(body, bearing_rad(body.position_m, point_m), within_rad)


def walk(
    body: Body, goals: Goals, around: bool = False, no_way_tries: int = NO_WAY_TRIES
) -> Generator[None, None, Walked]:
    """Go to the cheapest of the goals; `around` other robots from the start, or only when they stay in the way.

    `no_way_tries`: so often, where no way is known, old obstacles are forgotten and it is tried anew.
    """
    yield from await_odometry(body)
    no_way = 0
    tries = 0
    while tries < MAX_PLANS:
        yield from edge_away(body)
        # Robots that move are the traffic's business; around one that stays in the way there may be another.
        legs = (_plan(body, goals, body.others_m) if around else None) or _plan(body, goals, ())
        if legs is None:
            no_way += 1
            if no_way > no_way_tries:
                return Walked("unreachable", "there is no way to it that the robot fits through")
            body.floor.forget(body.now_s - STALE_S)
            yield from wait(body, 0.5 * NO_WAY_WAIT_S)
            continue
        trouble = yield from follow(body, legs)
        around = trouble == OTHER_IN_WAY and not around
        body.path_m, body.behind_other = (), False
        body.stand()
        if not trouble:
            return Walked()
        body.note = f"{trouble}, looking for another way"
        tries += trouble not in NOBODYS_FAULT
        yield from wait(body, NEXT_SWEEP_S)
    return Walked("blocked", f"gave up after {MAX_PLANS} tries: {body.note}")


def _plan(body: Body, goals: Goals, others_m: tuple[Vec2, ...]) -> list[Vec2] | None:
    price = path.prices(body.floor, body.position_m, others_m)
    way = path.search(body.floor, price, body.position_m, goals())
    return None if way is None else path.pull(body.floor, price, way)


def follow(body: Body, legs_m: list[Vec2]) -> Generator[None, None, str]:
    """Walk along the legs; returns what is wrong when it stops early."""
    follower = Follower(body.position_m, legs_m)
    watch = _Watch(body)
    scan_seq = counted = 0
    while True:
        body.action_steps += follower.begun - counted
        counted = follower.begun
        body.path_m = follower.left_m
        forward, yaw_rate = follower.steer(body.position_m, body.yaw_rad, _limit(body))
        if follower.arrived:
            return ""
        if body.scan is not None and body.scan.seq != scan_seq:
            scan_seq = body.scan.seq
            if not _is_free(body, follower.left_m):
                return "the way is blocked"
        if follower.off_way_m(body.position_m) > OFF_WAY_M:
            return OFF_WAY
        if forward > 0.0 and body.room_ahead_m() < 0.05:
            forward = 0.0
        left_m = path.length_m([body.position_m, *follower.left_m])
        body.behind_other = watch.waits_for_other(body, forward > 0.0 and runs_into_other(body, left_m))
        if body.behind_other:
            forward = 0.0
            if watch.patience_over(body):
                return OTHER_IN_WAY
        body.move(forward, yaw_rate)
        yield
        trouble = watch.trouble(body)
        if trouble:
            return trouble


def _limit(body: Body) -> float:
    here = body.position_m
    clearance = min(body.floor.walls_m[body.floor.cell(here)], body.floor.room_m(here, here))
    share = max(0.0, min(1.0, (clearance - path.NEEDED_M) / (path.WANTED_M - path.NEEDED_M)))
    return NEAR_MPS + share * (CRUISE_MPS - NEAR_MPS)


def _is_free(body: Body, corners_m: tuple[Vec2, ...]) -> bool:
    """Whether the next piece of the way still has room for the robot."""
    here, ahead_m = body.position_m, CHECK_AHEAD_M
    skip_m = path.ESCAPE_M if body.floor.room_m(here, here) < TIGHT_M else LEAVING_M
    for corner in corners_m:
        length = hypot(corner[0] - here[0], corner[1] - here[1])
        share = min(1.0, ahead_m / max(length, 1e-6))
        there = (here[0] + share * (corner[0] - here[0]), here[1] + share * (corner[1] - here[1]))
        # What is beside the robot already does not block it: it may stand near to things, and leave.
        skip = min(1.0, skip_m / max(length, 1e-6))
        begin = (here[0] + skip * (there[0] - here[0]), here[1] + skip * (there[1] - here[1]))
        if skip < 1.0 and body.floor.room_m(begin, there) < TIGHT_M:
            return False
        skip_m = max(0.0, skip_m - length)
        ahead_m -= length
        here = corner
        if ahead_m <= 0.0:
            break
    return True


class _Watch:
    """Notices that the robot does not get on."""

    def __init__(self, body: Body) -> None:
        self._anchor_m, self._anchor_rad, self._anchor_s = body.position_m, body.yaw_rad, body.clock_s
        self._other_s: float | None = None
        self._touch_s: float | None = None

    def trouble(self, body: Body) -> str:
        """Empty while all is well."""
        x, y = body.position_m
        moved = hypot(x - self._anchor_m[0], y - self._anchor_m[1]) > STALL_M
        turned = abs(wrap_rad(body.yaw_rad - self._anchor_rad)) > STALL_RAD
        if moved or turned or not body.may_move or self._other_s is not None:
            self._anchor_m, self._anchor_rad, self._anchor_s = body.position_m, body.yaw_rad, body.clock_s
        if body.odometry is not None and body.odometry.in_contact:
            self._touch_s = body.clock_s if self._touch_s is None else self._touch_s
            if body.clock_s - self._touch_s > TOUCHING_S:
                body.touched()
                return "touched something"
        else:
            self._touch_s = None
        if body.clock_s - self._anchor_s > STALL_S:
            body.touched()
            return "does not get on"
        return ""

    def waits_for_other(self, body: Body, in_way: bool) -> bool:
        """Keep note of since when another robot is in the way."""
        if not in_way:
            self._other_s = None
        elif self._other_s is None:
            self._other_s = body.clock_s
        return in_way

    def patience_over(self, body: Body) -> bool:
        return self._other_s is not None and body.clock_s - self._other_s > OTHER_PATIENCE_S
