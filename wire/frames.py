"""The only place where axes change: site ENU, body FLU, camera RDF, MAVLink NED.

Site ENU: x east, y north, z up. Body FLU: x forward, y left, z up. Camera RDF: x right, y down, z forward.
Yaw is in radians from east, counter-clockwise seen from above; a compass heading is clockwise from north.
Pixels: u right, v down, the centre of the picture at (width / 2, height / 2).
"""

from math import atan2, cos, degrees, hypot, pi, sin

from wire.model import Vec2, Vec3

Matrix3 = tuple[Vec3, Vec3, Vec3]


def wrap_rad(angle_rad: float) -> float:
    """The same angle in [-pi, pi)."""
    return (angle_rad + pi) % (2.0 * pi) - pi


def yaw_deg(yaw_rad: float) -> float:
    """Yaw as equation 2 of the first paper has it: degrees in [0, 360)."""
    angle_deg = degrees(yaw_rad) % 360.0
    return 0.0 if angle_deg >= 360.0 else angle_deg


def enu_to_ned(enu: Vec3) -> Vec3:
    east, north, up = enu
    return (north, east, -up)


def ned_to_enu(ned: Vec3) -> Vec3:
    north, east, down = ned
    return (east, north, -down)


def yaw_to_heading_rad(yaw_rad: float) -> float:
    """ENU yaw to compass heading (NED yaw), both in [-pi, pi)."""
    return wrap_rad(pi / 2.0 - yaw_rad)


def heading_to_yaw_rad(heading_rad: float) -> float:
    return wrap_rad(pi / 2.0 - heading_rad)


def body_to_enu(point_flu_m: Vec3, origin_enu_m: Vec3, yaw_rad: float) -> Vec3:
    """A point of a level body in the site frame."""
    forward, left, up = point_flu_m
    c, s = cos(yaw_rad), sin(yaw_rad)
    return (
        origin_enu_m[0] + c * forward - s * left,
        origin_enu_m[1] + s * forward + c * left,
        origin_enu_m[2] + up,
    )


def enu_to_body(point_enu_m: Vec3, origin_enu_m: Vec3, yaw_rad: float) -> Vec3:
    dx, dy = point_enu_m[0] - origin_enu_m[0], point_enu_m[1] - origin_enu_m[1]
    c, s = cos(yaw_rad), sin(yaw_rad)
    return (c * dx + s * dy, -s * dx + c * dy, point_enu_m[2] - origin_enu_m[2])


def camera_axes(yaw_rad: float, tilt_down_rad: float) -> Matrix3:
    """Unit vectors of the camera's right, down and forward axes in ENU: the columns of R(ENU <- RDF)."""
    cy, sy, ct, st = cos(yaw_rad), sin(yaw_rad), cos(tilt_down_rad), sin(tilt_down_rad)
    right = (sy, -cy, 0.0)
    down = (-cy * st, -sy * st, -ct)
    forward = (cy * ct, sy * ct, -st)
    return (right, down, forward)


def pixel_ray(
    u_px: float, v_px: float, width_px: int, height_px: int, focal_px: float, yaw_rad: float, tilt_down_rad: float
) -> Vec3:
    """Direction in ENU of the ray through a pixel, scaled to depth 1 along the optical axis."""
    x, y = (u_px - width_px / 2.0) / focal_px, (v_px - height_px / 2.0) / focal_px
    right, down, forward = camera_axes(yaw_rad, tilt_down_rad)
    return (
        forward[0] + x * right[0] + y * down[0],
        forward[1] + x * right[1] + y * down[1],
        forward[2] + x * right[2] + y * down[2],
    )


def project(
    point_enu_m: Vec3,
    camera_enu_m: Vec3,
    yaw_rad: float,
    tilt_down_rad: float,
    width_px: int,
    height_px: int,
    focal_px: float,
) -> tuple[float, float, float] | None:
    """(u_px, v_px, depth_m) of a point, or None when it lies behind the camera."""
    delta = tuple(p - c for p, c in zip(point_enu_m, camera_enu_m, strict=True))
    x, y, z = (sum(a * d for a, d in zip(axis, delta, strict=True)) for axis in camera_axes(yaw_rad, tilt_down_rad))
    if z <= 1e-6:
        return None
    return (width_px / 2.0 + focal_px * x / z, height_px / 2.0 + focal_px * y / z, z)


def bearing_rad(origin_m: Vec2, target_m: Vec2) -> float:
    """Yaw that looks from one floor point to another."""
    return atan2(target_m[1] - origin_m[1], target_m[0] - origin_m[0])


def distance_m(a_m: Vec2 | Vec3, b_m: Vec2 | Vec3) -> float:
    """Distance in the floor plane."""
    return hypot(a_m[0] - b_m[0], a_m[1] - b_m[1])
