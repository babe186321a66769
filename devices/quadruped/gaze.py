"""Looking on purpose: at a point, around it, and at what is there."""

from collections.abc import Generator
from math import atan2, hypot

from devices.quadruped.body import Body
from devices.quadruped.look import Look, Thing
from devices.quadruped.walk import face, face_point
from wire.frames import bearing_rad
from wire.model import Vec3

MAST_HEIGHT_M, MAST_FORWARD_M = 1.30, 0.20
MOST_TILT_RAD = 1.0
SETTLE_S = 0.3
"""The camera's tilt takes a moment, and a picture blurred by it is worth nothing."""
PICTURE_PATIENCE_S = 3.0
AROUND: tuple[tuple[float, float], ...] = ((0.5, 0.0), (-0.5, 0.0), (0.0, 0.35), (0.0, -0.3))
"""(yaw, tilt) beside the straight look, where a thing may be that is not where it was believed."""
SURE = 0.35


def tilt_to(body: Body, point_enu_m: Vec3) -> float:
    """The camera's tilt that has a point in the middle of the picture."""
    x, y = body.position_m
    ahead = max(0.25, hypot(point_enu_m[0] - x, point_enu_m[1] - y) - MAST_FORWARD_M)
    return max(0.0, min(MOST_TILT_RAD, atan2(MAST_HEIGHT_M - point_enu_m[2], ahead)))


def take_pictures(body: Body, count: int) -> Generator[None, None, list[Look]]:
    """Stand and wait for so many pictures; fewer when the camera is silent."""
    if not body.sighted:
        return []
    body.stand()
    begun_s, from_s = body.clock_s, body.now_s + SETTLE_S
    while len(looks := body.looks_since(from_s)) < count and body.clock_s - begun_s < PICTURE_PATIENCE_S:
        yield
    return looks


def look_at(
    body: Body, type: str, point_enu_m: Vec3, within_m: float, count: int = 2
) -> Generator[None, None, Thing | None]:
    """Face a point and name the thing of this type nearest to it: of the last picture that shows one."""
    yield from face_point(body, point_enu_m[:2])
    body.tilt(tilt_to(body, point_enu_m))
    looks = yield from take_pictures(body, count)
    return best_of(looks, type, point_enu_m, within_m)


def look_around(body: Body, type: str, point_enu_m: Vec3, within_m: float) -> Generator[None, None, Thing | None]:
    """The same beside the point, until it is seen."""
    yaw_rad, tilt_rad = bearing_rad(body.position_m, point_enu_m[:2]), tilt_to(body, point_enu_m)
    for aside_rad, down_rad in AROUND:
        yield from face(body, yaw_rad + aside_rad)
        body.tilt(max(0.0, min(MOST_TILT_RAD, tilt_rad + down_rad)))
        looks = yield from take_pictures(body, 1)
        thing = best_of(looks, type, point_enu_m, within_m)
        if thing is not None:
            return thing
    return None


def best_of(looks: list[Look], type: str, point_enu_m: Vec3, within_m: float) -> Thing | None:
    """Of several pictures from one place the last that shows the thing."""
    for look in reversed(looks):
        thing = look.nearest(type, point_enu_m, within_m)
        if thing is not None and thing.confidence >= SURE:
            return thing
    return None
