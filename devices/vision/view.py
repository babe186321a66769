"""The piece of floor that a camera watches, as far as the site's walls and the size of pixels let it."""

from collections.abc import Sequence
from math import atan, cos, sin

import numpy as np

from devices.vision.lens import Floats, Lens
from devices.vision.walls import wall_ranges_m
from wire.messages.observation import View
from wire.model import Vec2
from wire.site import Door, Wall

SMALL_THING_M = 0.10
SMALL_THING_PX = 7.0
"""A thing of this size is noticed when it covers so many pixels."""
MAX_BEARINGS = 30


def floor_view(lens: Lens, walls: Sequence[Wall], doors: Sequence[Door] = ()) -> View:
    """The visible floor, as a polygon; it has no corners where the camera sees no floor at all."""
    range_m = lens.focal_px * SMALL_THING_M / SMALL_THING_PX
    reach_m = max(0.2, float(np.sqrt(max(0.0, range_m**2 - lens.position_enu_m[2] ** 2))))
    corners = floor_corners(lens, reach_m)
    hfov_rad = 2.0 * atan(lens.width_px / 2.0 / lens.focal_px)
    polygon: tuple[Vec2, ...] = ()
    if corners is not None:
        polygon = _polygon(lens, corners, reach_m, walls, doors)
    return View(
        origin_enu_m=lens.position_enu_m,
        polygon_m=polygon,
        yaw_rad=lens.yaw_rad,
        hfov_rad=hfov_rad,
        range_m=reach_m,
    )


def floor_corners(lens: Lens, reach_m: float) -> Floats | None:
    """Where the picture's border meets the floor, (4, 2): near left, near right, far right, far left."""
    u = np.array([0.0, lens.width_px, lens.width_px, 0.0])
    # Rows above the horizon meet no floor: the far edge is the row whose floor lies at the reach.
    far_row = _row_at(lens, 1.5 * reach_m)
    if far_row >= lens.height_px:
        return None
    v = np.array([lens.height_px, lens.height_px, max(0.0, far_row), max(0.0, far_row)])
    rays = lens.rays(u, v)
    along = lens.position_enu_m[2] / -rays[:, 2]
    corners: Floats = np.array(lens.position_enu_m)[:2] + rays[:, :2] * along[:, None]
    return corners


def _row_at(lens: Lens, forward_m: float) -> float:
    """The row whose middle pixel meets the floor so far ahead."""
    ahead = [forward_m * cos(lens.yaw_rad), forward_m * sin(lens.yaw_rad), 0.0]
    point = np.array([lens.position_enu_m[0], lens.position_enu_m[1], 0.0]) + np.array(ahead)
    return float(lens.pixels(point)[0, 1])


def _polygon(
    lens: Lens, corners: Floats, reach_m: float, walls: Sequence[Wall], doors: Sequence[Door]
) -> tuple[Vec2, ...]:
    """Far ends of the bearings, left to right, and back along the near ends."""
    origin = np.array(lens.position_enu_m)[:2]
    bearings = np.linspace(*_bearing_span(lens, corners), MAX_BEARINGS)
    near, far = _through(corners, origin, bearings)
    far = np.minimum(far, reach_m)
    far = np.minimum(far, wall_ranges_m(origin, bearings, walls, doors))
    directions = np.stack([np.cos(bearings), np.sin(bearings)], axis=1)
    some = far > near + 0.02
    if some.sum() < 2:
        return ()
    outer = origin + directions[some] * far[some, None]
    inner = (origin + directions[some] * near[some, None])[::-1]
    return tuple((float(x), float(y)) for x, y in np.concatenate([outer, inner]))


def _bearing_span(lens: Lens, corners: Floats) -> tuple[float, float]:
    """The widest bearings, left then right, at which the trapezoid of floor is seen from the camera's foot."""
    away = corners - np.array(lens.position_enu_m)[:2]
    c, s = cos(lens.yaw_rad), sin(lens.yaw_rad)
    off_axis = np.arctan2(-s * away[:, 0] + c * away[:, 1], c * away[:, 0] + s * away[:, 1])
    shrink = 0.999
    return (lens.yaw_rad + shrink * float(off_axis.max()), lens.yaw_rad + shrink * float(off_axis.min()))


def _through(corners: Floats, origin: Floats, bearings: Floats) -> tuple[Floats, Floats]:
    """Ranges at which bearings enter and leave a convex polygon; an empty interval where they miss it."""
    enter, leave = np.zeros(len(bearings)), np.full(len(bearings), np.inf)
    directions = np.stack([np.cos(bearings), np.sin(bearings)], axis=1)
    middle = corners.mean(axis=0)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        normal = np.array([b[1] - a[1], a[0] - b[0]])
        if normal @ (middle - a) < 0.0:
            normal = -normal
        speed = directions @ normal
        crossing = (normal @ (a - origin)) / np.where(np.abs(speed) < 1e-12, 1e-12, speed)
        enter = np.where(speed > 0.0, np.maximum(enter, crossing), enter)
        leave = np.where(speed < 0.0, np.minimum(leave, crossing), leave)
    return enter, leave
