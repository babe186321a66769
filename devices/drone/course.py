"""A curve flown in time: as fast as speed, climb and bends allow, from standstill to standstill."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import acos, ceil, dist, hypot, inf, sqrt

from devices.drone.spline import Spline
from wire.model import Vec3

CRUISE_MPS, CLIMB_MPS = 1.0, 0.6
ACCEL_MPS2, BEND_MPS2 = 0.8, 0.8
"""Along the way, and across it in bends."""
SAMPLE_M = 0.05
LEG_M = 0.3
"""Control points along straight legs: a bend cuts its corner by a third of this at most."""
LEAST_M, LEAST_MPS = 1e-4, 1e-4
"""Points that coincide divide nothing by nought."""


@dataclass(frozen=True, slots=True)
class Limits:
    speed_mps: float = CRUISE_MPS
    climb_mps: float = CLIMB_MPS


DEFAULT = Limits()


class Course:
    """Where to be at each time after its start, and how fast. `length_m` along the curve, `duration_s` all in all."""

    def __init__(self, curve: Spline, limits: Limits = DEFAULT) -> None:
        self._curve = curve
        rough_m = sum(dist(a, b) for a, b in pairwise(curve.control_m))
        count = max(8, ceil(rough_m / SAMPLE_M))
        self._points = [curve.at(i / count) for i in range(count + 1)]
        self._steps_m = [max(LEAST_M, dist(a, b)) for a, b in pairwise(self._points)]
        self._speeds = self._profile(limits)
        self._times = [0.0]
        for i, step_m in enumerate(self._steps_m):
            mean = (self._speeds[i] + self._speeds[i + 1]) / 2.0
            self._times.append(self._times[-1] + step_m / max(mean, LEAST_MPS))
        self.length_m, self.duration_s = sum(self._steps_m), self._times[-1]

    @property
    def end_m(self) -> Vec3:
        return self._points[-1]

    @property
    def points_m(self) -> Sequence[Vec3]:
        """The curve every few centimetres."""
        return self._points

    def at(self, time_s: float) -> tuple[Vec3, Vec3]:
        """(position_enu_m, velocity_enu_mps) at a time after the start; before it and after the end it stands."""
        if time_s <= 0.0:
            return self._points[0], (0.0, 0.0, 0.0)
        if time_s >= self.duration_s:
            return self._points[-1], (0.0, 0.0, 0.0)
        i = min(bisect_right(self._times, time_s) - 1, len(self._steps_m) - 1)
        passed_s, whole_s = time_s - self._times[i], self._times[i + 1] - self._times[i]
        v0, v1 = self._speeds[i], self._speeds[i + 1]
        speed = v0 + (v1 - v0) * passed_s / whole_s
        share = passed_s * (v0 + speed) / 2.0 / self._steps_m[i]
        u = (i + min(1.0, share)) / len(self._steps_m)
        along = self._curve.velocity(u)
        norm = sqrt(along[0] ** 2 + along[1] ** 2 + along[2] ** 2)
        scale = speed / norm if norm > 0.0 else 0.0
        return self._curve.at(u), (along[0] * scale, along[1] * scale, along[2] * scale)

    def left_m(self, time_s: float) -> Sequence[Vec3]:
        """What of the curve is still ahead."""
        return self._points[max(0, bisect_right(self._times, time_s) - 1) :]

    def _profile(self, limits: Limits) -> list[float]:
        """Speed at each sample: no faster than allowed there, and reached and left at the allowed acceleration."""
        count = len(self._points)
        speeds = [self._allowed(i, limits) for i in range(count)]
        for i in range(1, count):
            speeds[i] = min(speeds[i], sqrt(speeds[i - 1] ** 2 + 2.0 * ACCEL_MPS2 * self._steps_m[i - 1]))
        for i in range(count - 2, -1, -1):
            speeds[i] = min(speeds[i], sqrt(speeds[i + 1] ** 2 + 2.0 * ACCEL_MPS2 * self._steps_m[i]))
        return speeds

    def _allowed(self, i: int, limits: Limits) -> float:
        """It stands at both ends."""
        if not 0 < i < len(self._points) - 1:
            return 0.0
        before, here, after = self._points[i - 1 : i + 2]
        a = [h - b for h, b in zip(here, before, strict=True)]
        b = [n - h for n, h in zip(after, here, strict=True)]
        la, lb = max(LEAST_M, hypot(*a)), max(LEAST_M, hypot(*b))
        turn_rad = acos(max(-1.0, min(1.0, sum(x * y for x, y in zip(a, b, strict=True)) / (la * lb))))
        bend = turn_rad / ((la + lb) / 2.0)
        steep = abs(a[2] + b[2]) / (la + lb)
        by_bend = sqrt(BEND_MPS2 / bend) if bend > 1e-6 else inf
        by_climb = limits.climb_mps / steep if steep > 1e-6 else inf
        return min(limits.speed_mps, by_bend, by_climb)


def along_legs(points_m: Sequence[Vec3]) -> Spline:
    """A curve along straight legs that rounds their corners."""
    control = [points_m[0]]
    for a, b in pairwise(points_m):
        pieces = max(1, ceil(dist(a, b) / LEG_M))
        control += [
            (a[0] + k / pieces * (b[0] - a[0]), a[1] + k / pieces * (b[1] - a[1]), a[2] + k / pieces * (b[2] - a[2]))
            for k in range(1, pieces + 1)
        ]
    return Spline(control if len(control) > 1 else [points_m[0], points_m[0]])
