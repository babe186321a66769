"""Quaternions (w, x, y, z) from body FRD to NED, as plain floats."""

from math import asin, atan2, cos, pi, sin, sqrt

from sim.flight.state import Quaternion, Vec3

_HALF = sqrt(0.5)


def from_bullet(x: float, y: float, z: float, w: float) -> Quaternion:
    """PyBullet's (x, y, z, w) from body FLU to ENU."""
    return (_HALF * (w + z), _HALF * (x + y), _HALF * (x - y), _HALF * (w - z))


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def rotate(q: Quaternion, v: Vec3) -> Vec3:
    """A body vector in NED."""
    w, x, y, z = q
    a, b, c = v
    tx, ty, tz = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return (a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx)


def rotate_back(q: Quaternion, v: Vec3) -> Vec3:
    """A NED vector in the body."""
    return rotate((q[0], -q[1], -q[2], -q[3]), v)


def normalised(q: Quaternion) -> Quaternion:
    w, x, y, z = q
    n = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return (w * n, x * n, y * n, z * n)


def euler(q: Quaternion) -> Vec3:
    """Roll, pitch and heading in radians."""
    w, x, y, z = q
    return (
        atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x)))),
        atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )


def heading(q: Quaternion) -> float:
    w, x, y, z = q
    return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def from_heading(heading_rad: float) -> Quaternion:
    return (cos(heading_rad / 2.0), 0.0, 0.0, sin(heading_rad / 2.0))


def leaning(down: Vec3, heading_rad: float) -> Quaternion:
    """The attitude whose body z axis points along `down` (a unit vector in NED), turned to a heading."""
    x, y, z = down
    w = sqrt(max(1e-9, (1.0 + z) / 2.0))  # the shortest turn from (0, 0, 1)
    return multiply((w, -y / (2.0 * w), x / (2.0 * w), 0.0), from_heading(heading_rad))


def wrapped(angle_rad: float) -> float:
    """In [-pi, pi)."""
    return (angle_rad + pi) % (2.0 * pi) - pi
