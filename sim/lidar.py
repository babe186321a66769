"""A sweep of ranges around a robot: 120 beams at 0.25 m above the floor.

Beams are level and boxes upright, so each box is a rectangle in the plane of the sweep, and only the beams between its
outer bearings can meet it; all of these pairs are worked out at once. The ranges are those of as many rays through the
physics engine, in a fraction of the time.
"""

from math import hypot, pi

import numpy as np
from numpy.typing import NDArray

from sim.boxes import Box
from sim.physics import Physics
from sim.rover import Motion

BEAMS = 120
HEIGHT_M = 0.25
RANGE_M = 6.0
ANGLE_MIN_RAD = -pi
ANGLE_STEP_RAD = 2.0 * pi / BEAMS

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class Lidar:
    """One robot's scanner. What stands still is looked up once."""

    def __init__(self, physics: Physics, robot: str) -> None:
        self._physics = physics
        self._robot = robot
        self._standing = _rows(physics.standing)
        self._swept: tuple[Motion, list[Box]] | None = None
        self._ranges_m: tuple[float, ...] = ()
        self._angles: Array = np.asarray(ANGLE_MIN_RAD + ANGLE_STEP_RAD * np.arange(BEAMS), np.float64)

    def sweep(self) -> tuple[float, ...]:
        """Ranges in metres, beam k at ANGLE_MIN + k * ANGLE_STEP from straight ahead; 0 where nothing was hit."""
        motion = self._physics.robots[self._robot].motion()
        near = [box for box in self._physics.moving(self._robot) if _in_range(box, *motion.position_m)]
        if (motion, near) != self._swept:  # from the same place, among the same things, it would be the same sweep
            self._swept = (motion, near)
            rows = np.concatenate((self._standing, _rows(near)))
            ranges = _first_hits(rows, *motion.position_m, motion.yaw_rad, np.asarray(self._angles + motion.yaw_rad))
            self._ranges_m = tuple(np.where(ranges <= RANGE_M, np.round(ranges, 3), 0.0).tolist())
        return self._ranges_m


def _in_range(box: Box, x: float, y: float) -> bool:
    return hypot(box.centre_m[0] - x, box.centre_m[1] - y) - hypot(*box.half_m[:2]) < RANGE_M


def _rows(boxes: list[Box]) -> Array:
    """x, y, half x, half y, cos, sin of the boxes that the plane of the sweep cuts."""
    cut = [box for box in boxes if abs(box.centre_m[2] - HEIGHT_M) < box.half_m[2]]
    return np.array(
        [(*b.centre_m[:2], *b.half_m[:2], np.cos(b.yaw_rad), np.sin(b.yaw_rad)) for b in cut], dtype=np.float64
    ).reshape(-1, 6)


def _first_hits(rows: Array, x: float, y: float, yaw_rad: float, angles_rad: Array) -> Array:
    """Distance along each beam (slab test in every rectangle's own frame); infinite where nothing is hit."""
    dx, dy = x - rows[:, 0], y - rows[:, 1]
    box, beam = _pairs(np.hypot(dx, dy), np.arctan2(-dy, -dx) - yaw_rad, np.hypot(rows[:, 2], rows[:, 3]))
    half_x, half_y, c, s = rows[box, 2:].T
    dx, dy = dx[box], dy[box]
    ahead, aside = np.cos(angles_rad)[beam], np.sin(angles_rad)[beam]
    from_x, from_y = c * dx + s * dy, c * dy - s * dx
    over_x = 1.0 / _never_zero(ahead * c + aside * s)
    over_y = 1.0 / _never_zero(aside * c - ahead * s)
    mid_x, mid_y = -from_x * over_x, -from_y * over_y
    deep_x, deep_y = half_x * np.abs(over_x), half_y * np.abs(over_y)
    enter, leave = np.maximum(mid_x - deep_x, mid_y - deep_y), np.minimum(mid_x + deep_x, mid_y + deep_y)
    hit = (enter <= leave) & (enter > 0.0)
    ranges = np.full(BEAMS, np.inf)
    np.minimum.at(ranges, beam[hit], enter[hit])
    return ranges


def _pairs(away_m: Array, bearing_rad: Array, radius_m: Array) -> tuple[Index, Index]:
    """(box, beam) for every beam that can meet a box within range, by the circle around the box."""
    near = np.flatnonzero(away_m - radius_m < RANGE_M)
    around = radius_m[near] / np.maximum(away_m[near], 1e-9)
    spread_rad = np.where(around < 1.0, np.arcsin(np.minimum(around, 1.0)) + 1e-6, pi)
    first = np.ceil((bearing_rad[near] - spread_rad - ANGLE_MIN_RAD) / ANGLE_STEP_RAD).astype(np.int64)
    last = np.floor((bearing_rad[near] + spread_rad - ANGLE_MIN_RAD) / ANGLE_STEP_RAD).astype(np.int64)
    count = np.minimum(last - first + 1, BEAMS)
    within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return np.repeat(near, count), (np.repeat(first, count) + within) % BEAMS


def _never_zero(direction: Array) -> Array:
    """A beam along a side never meets that side; a tiny slope says so without dividing by zero."""
    return np.asarray(np.where(np.abs(direction) < 1e-12, 1e-12, direction))
