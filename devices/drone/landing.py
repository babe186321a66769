"""Coming down where nobody is."""

from math import dist

from devices.drone.craft import Craft
from devices.drone.flight import Trouble, failed, fly_to, obey, taken_over
from devices.drone.pilot import Disarm
from devices.drone.route import nearest_open

LANDED_S, LANDING_REFUSED_S = 4.0, 10.0
SPOT_SLACK_M = 0.3
"""As near as this to a place to land at is there."""


def come_down(craft: Craft) -> Trouble:
    """Land where it is, or near by where somebody stands below, and rotors off."""
    trouble = yield from _find_ground(craft)
    if trouble is not None:
        return trouble
    begun_s = craft.now_s
    while craft.airborne:
        if craft.by_hand:
            return taken_over(craft)
        craft.note = "landing"
        craft.land()
        if craft.landing_refused and craft.now_s - begun_s > LANDING_REFUSED_S:
            return failed("driver", f"the autopilot does not land: {craft.landing_refused}{craft.why()}")
        yield
    down_s = craft.now_s
    while craft.telemetry is not None and craft.telemetry.armed:
        if craft.now_s - down_s > LANDED_S:
            yield from obey(craft, Disarm())
            down_s = craft.now_s
        yield
    return None


def _find_ground(craft: Craft) -> Trouble:
    """Wait until nobody is below, or fly to where nobody is. What was begun is landed where it is."""
    while craft.airborne and not craft.landing and craft.column_taken:
        craft.note = "waiting to land: it is not free below"
        spot_m = craft.order.land_at_m if craft.order is not None else None
        goal_m = nearest_open(craft.space, (*spot_m, craft.position_m[2]), SPOT_SLACK_M) if spot_m is not None else None
        if goal_m is not None and dist(goal_m, craft.position_m) > SPOT_SLACK_M:
            craft.note = "flying to where it is free to land"
            trouble = yield from fly_to(craft, goal_m)
            if trouble is not None:
                return trouble
        else:
            yield
    return None
