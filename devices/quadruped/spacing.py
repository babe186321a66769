"""Room around the robot: how much there is, and edging sideways out of a tight place, where turning would scrape."""

from collections.abc import Generator
from math import cos, hypot, pi, sin

from devices.quadruped.body import Body
from wire.frames import wrap_rad
from wire.model import Vec2

BODY_M = 0.37
"""The corners of a robot's body, when it turns, are this far from its middle."""
ROOMY_M = 0.41
DIRECTIONS, TRIAL_M = 16, 0.2
EDGE_MPS, EDGE_S, GAIN_M = 0.25, 1.6, 0.02
OTHER_GAP_M, AHEAD_M, NEARER_M = 0.80, 0.4, 0.05


def room_at(body: Body, point_m: Vec2) -> float:
    """From a point to the nearest wall, obstacle or body of another robot."""
    others = [hypot(x - point_m[0], y - point_m[1]) - BODY_M for x, y in body.others_m]
    return min([body.floor.walls_m[body.floor.cell(point_m)], body.floor.room_m(point_m, point_m), *others])


def edge_away(body: Body) -> Generator[None, None, None]:
    """Step away from what is too near to turn beside, without turning."""
    until_s = body.clock_s + EDGE_S
    while body.clock_s < until_s and (room := room_at(body, body.position_m)) < ROOMY_M:
        x, y = body.position_m
        best, best_rad = room + GAIN_M, None
        for k in range(DIRECTIONS):
            yaw = 2.0 * pi * k / DIRECTIONS
            there = room_at(body, (x + TRIAL_M * cos(yaw), y + TRIAL_M * sin(yaw)))
            if there > best + 1e-6:
                best, best_rad = there, yaw
        if best_rad is None:
            break
        off = wrap_rad(best_rad - body.yaw_rad)
        body.move(EDGE_MPS * cos(off), 0.0, EDGE_MPS * sin(off))
        yield
    body.stand()


def runs_into_other(body: Body, left_m: float) -> bool:
    """Whether going straight on, as far as there is way left, leads too near to another robot."""
    x, y = body.position_m
    ahead_m = min(AHEAD_M, left_m)
    ahead = (x + ahead_m * cos(body.yaw_rad), y + ahead_m * sin(body.yaw_rad))
    for other in body.others_m:
        then_m = hypot(other[0] - ahead[0], other[1] - ahead[1])
        if then_m < OTHER_GAP_M and then_m < hypot(other[0] - x, other[1] - y) - NEARER_M:
            return True
    return False
