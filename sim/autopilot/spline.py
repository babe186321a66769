"""Spline waypoints: from one place to the next on a smooth curve, without stopping where the mission goes on."""

import math
from dataclasses import dataclass

from sim.autopilot.flying import blind
from sim.autopilot.situation import Situation
from sim.flight.state import FREE, Off, Setpoint, Trajectory, Vec3

_SIDEWAYS_MPS2 = 1.5
_BRAKE_MPS2 = 1.0
_FARTHEST_AHEAD_M = 1.0
"""The point on the curve waits for a vehicle that is this far from it."""
_FLATTEST = 0.2
"""At an end where it stops the curve has no slope; a point moves along it as if it had this part of its length."""

STOP = (0.0, 0.0, 0.0)


@dataclass(slots=True)
class Curve:
    """A cubic curve that begins where it is, the way it flies then, and ends at a place, towards what follows."""

    place_ned_m: Vec3
    radius_m: float
    leave_m: Vec3
    """The slope at the end, which it passes as soon as the point on the curve has; or STOP, to come to rest there."""
    heading_rad: float | None = None
    done: bool = False
    _start: Vec3 | None = None
    _enter_m: Vec3 = (0.0, 0.0, 0.0)
    _length_m: float = 0.0
    _part: float = 0.0
    _last_s: float = 0.0

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if now.vehicle.on_ground:
            return Off()
        if not now.estimate.position_ok:
            return blind(now, 0.0)
        if self._start is None:
            self._begin(now, now_s)
        span_s, self._last_s = min(0.1, now_s - self._last_s), now_s
        point, slope, bend = self._at(self._part)
        lag = math.dist(now.here, now.below_ceiling(point)) / _FARTHEST_AHEAD_M
        speed = self._speed_mps(now, slope, bend, point) * max(0.0, 1.0 - lag)
        pace = speed / max(math.hypot(*slope), _FLATTEST * self._length_m, 1e-3) if self._part < 1.0 else 0.0
        self._part = min(1.0, self._part + pace * span_s)
        there = math.dist(now.here, self.place_ned_m) < self.radius_m or self.leave_m != STOP
        self.done = self.done or (self._part >= 1.0 and there)
        return Trajectory(
            now.below_ceiling(point), (slope[0] * pace, slope[1] * pace, slope[2] * pace), FREE,
            self._nose_rad(now, slope), None, now.cruise_mps, now.quantity("climb_mps"), now.quantity("descent_mps"),
        )  # fmt: skip

    def _begin(self, now: Situation, now_s: float) -> None:
        self._start, self._last_s = now.here, now_s
        self._length_m = math.dist(now.here, self.place_ned_m)
        north, east, down = now.estimate.velocity_ned_mps
        # At rest it would leave along whatever the estimator takes its noise for.
        factor = self._length_m / max(now.cruise_mps, 0.1) if math.hypot(north, east, down) > 0.2 else 0.0
        self._enter_m = (north * factor, east * factor, down * factor)

    def _at(self, u: float) -> tuple[Vec3, Vec3, Vec3]:
        """Point, slope and bend at a part of the curve: the cubic with these ends and slopes."""
        assert self._start is not None
        weights = (
            (2 * u**3 - 3 * u**2 + 1, u**3 - 2 * u**2 + u, 3 * u**2 - 2 * u**3, u**3 - u**2),
            (6 * u**2 - 6 * u, 3 * u**2 - 4 * u + 1, 6 * u - 6 * u**2, 3 * u**2 - 2 * u),
            (12 * u - 6, 6 * u - 4, 6 - 12 * u, 6 * u - 2),
        )
        ends = list(zip(self._start, self._enter_m, self.place_ned_m, self.leave_m, strict=True))
        point, slope, bend = (
            [sum(w * end for w, end in zip(row, axis, strict=True)) for axis in ends] for row in weights
        )
        return (point[0], point[1], point[2]), (slope[0], slope[1], slope[2]), (bend[0], bend[1], bend[2])

    def _speed_mps(self, now: Situation, slope: Vec3, bend: Vec3, point: Vec3) -> float:
        """Not faster than the speeds that are set, the bend and the end allow."""
        speed, steep = now.cruise_mps, math.hypot(*slope)
        upright = now.quantity("climb_mps" if slope[2] < 0 else "descent_mps")
        if abs(slope[2]) > 1e-6:
            speed = min(speed, upright * steep / abs(slope[2]))
        turn = abs(slope[0] * bend[1] - slope[1] * bend[0])
        if turn > 1e-6:
            speed = min(speed, math.sqrt(_SIDEWAYS_MPS2 * steep**3 / turn) + 0.2)
        if self.leave_m == STOP:
            speed = min(speed, math.sqrt(2 * _BRAKE_MPS2 * math.dist(point, self.place_ned_m)) + 0.2)
        return speed

    def _nose_rad(self, now: Situation, slope: Vec3) -> float | None:
        region = now.towards_region()
        if region is not None or self.heading_rad is not None:
            return self.heading_rad if region is None else region
        return math.atan2(slope[1], slope[0]) if math.hypot(slope[0], slope[1]) > 0.1 else None


def leaving(start: Vec3, place: Vec3, following: Vec3 | None, curved: bool) -> Vec3:
    """The slope at a place on the way from `start`: towards what follows, past the place when that is a curve too."""
    if following is None:
        return STOP
    before = start if curved else place
    away = (following[0] - before[0], following[1] - before[1], following[2] - before[2])
    span = math.hypot(*away)
    length = min(math.dist(start, place), math.dist(place, following))
    return (away[0] * length / span, away[1] * length / span, away[2] * length / span) if span else STOP
