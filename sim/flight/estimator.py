"""Attitude, velocity and position from sensors: never from the truth.

Attitude is integrated from the gyroscope and pulled towards gravity, compass and what the velocity fixes say of the
tilt; velocity and position are integrated from the accelerometer and pulled towards fixes, poses from outside, or for
the height alone the barometer. Gains are fixed and were set by hand for the noises of `sim.flight.sensing`; what they
are worth is measured by `sim.flight.bench`. NED and FRD, metres, seconds, radians.
"""

from math import cos, dist, sin, sqrt

from sim.bullet import GRAVITY_MPS2
from sim.flight.attitude import euler, heading, multiply, normalised, wrapped
from sim.flight.sensing import magnetic_heading
from sim.flight.state import Estimate, Quaternion, Vec3

FRESH_S = 1.0
"""A position without fix or pose for longer is not to be relied on."""
_LEVEL_PER_S, _GYRO_BIAS_PER_S = 0.25, 0.02
_COMPASS, _OUTSIDE_HEADING = 0.02, 0.1
_TILT_PER_MPS = 0.01
_FIX_POSITION, _FIX_VELOCITY, _FIX_CROSS = 0.18, 0.22, 0.5
_POSE_PER_S, _MOST_POSE, _POSE_CROSS = 6.0, 0.6, 2.4
_FIXES_APART_S, _MOST_WEIGHT = 0.05, 2.0
"""The gains of tilt and bias are for corrections this far apart; rarer ones weigh more, up to so many times."""
_BIAS_PER_MPS, _MOST_BIAS = 0.06, 0.8
_BARO_HEIGHT, _BARO_CLIMB = 0.02, 0.01
_GATE_M, _DRIFT_MPS, _GATE_RAD = 2.0, 1.0, 0.8
"""A pose is not believed farther from the estimate than this and what it can have drifted, nor its heading."""
_AGREED_S = 5.0
"""Without fixes, poses that have agreed with each other for so long begin the estimate anew."""
_CARRIED_S = 5.0
"""For this long without fix or pose, the velocity from the accelerometer alone is worth more than none."""


class Estimator:
    """`predict` at every physics step, the others as measurements come."""

    __slots__ = (
        "_baro_s", "_bias_a", "_bias_n", "_doubted", "_fixed_s", "_headed_s", "_pose_s", "_started", "estimate", "pd", "pe", "pn", "q",
        "vd", "ve", "vn", "wx", "wy", "wz",
    )  # fmt: skip

    def __init__(self, position_ned_m: Vec3, heading_rad: float) -> None:
        self.q: Quaternion = (cos(heading_rad / 2.0), 0.0, 0.0, sin(heading_rad / 2.0))
        self.pn, self.pe, self.pd = position_ned_m
        self.vn = self.ve = self.vd = 0.0
        self.wx = self.wy = self.wz = 0.0
        self._bias_a = [0.0, 0.0, 0.0]
        """Of the acceleration, in NED."""
        self._bias_n = [0.0, 0.0, 0.0]
        """Of the gyroscope, in FRD."""
        self._fixed_s = self._pose_s = self._headed_s = self._baro_s = -1e9
        self._started = False
        self._doubted: tuple[float, float, Vec3] | None = None
        """Poses that are not believed and agree with each other: since when, when the last came, and where it was."""
        self.estimate = Estimate()

    def predict(self, gyro: Vec3, accel: Vec3, step_s: float) -> None:
        """One step of the inertial measurements."""
        w, x, y, z = self.q
        bias = self._bias_n
        p, q, r = gyro[0] - bias[0], gyro[1] - bias[1], gyro[2] - bias[2]
        ax, ay, az = accel
        # where the accelerometer feels up, against where the attitude says it is
        gx, gy, gz = 2.0 * (x * z - w * y), 2.0 * (w * x + y * z), w * w - x * x - y * y + z * z
        size = sqrt(ax * ax + ay * ay + az * az)
        cx = cy = cz = 0.0
        if 9.3 < size < 10.3:
            k = 1.0 / size
            cx, cy, cz = k * (gy * az - gz * ay), k * (gz * ax - gx * az), k * (gx * ay - gy * ax)
            turn = _GYRO_BIAS_PER_S * step_s
            bias[0] -= turn * cx
            bias[1] -= turn * cy
            bias[2] -= turn * cz
        self.wx, self.wy, self.wz = p, q, r
        h = 0.5 * step_s
        a, b, c = h * (p + _LEVEL_PER_S * cx), h * (q + _LEVEL_PER_S * cy), h * (r + _LEVEL_PER_S * cz)
        w, x, y, z = (
            w - x * a - y * b - z * c,
            x + w * a + y * c - z * b,
            y + w * b + z * a - x * c,
            z + w * c + x * b - y * a,
        )
        n = 1.5 - 0.5 * (w * w + x * x + y * y + z * z)
        w, x, y, z = w * n, x * n, y * n, z * n
        self.q = (w, x, y, z)
        tx, ty, tz = 2.0 * (y * az - z * ay), 2.0 * (z * ax - x * az), 2.0 * (x * ay - y * ax)
        drift = self._bias_a
        an = ax + w * tx + y * tz - z * ty + drift[0]
        ae = ay + w * ty + z * tx - x * tz + drift[1]
        ad = az + w * tz + x * ty - y * tx + drift[2] + GRAVITY_MPS2
        self.pn += step_s * (self.vn + 0.5 * step_s * an)
        self.pe += step_s * (self.ve + 0.5 * step_s * ae)
        self.pd += step_s * (self.vd + 0.5 * step_s * ad)
        self.vn += step_s * an
        self.ve += step_s * ae
        self.vd += step_s * ad

    def fix(self, now_s: float, position_ned_m: Vec3, velocity_ned_mps: Vec3, span_s: float) -> None:
        """A fix of the indoor position system, `span_s` after the one before."""
        if now_s - max(self._fixed_s, self._pose_s) > FRESH_S:
            self.restart(position_ned_m, velocity_ned_mps)
        self._fixed_s = now_s
        dn, de, dd = (z - p for z, p in zip(position_ned_m, (self.pn, self.pe, self.pd), strict=True))
        un, ue, ud = (z - v for z, v in zip(velocity_ned_mps, (self.vn, self.ve, self.vd), strict=True))
        self._correct(dn, de, dd, un, ue, ud, _FIX_POSITION, _FIX_VELOCITY, _FIX_CROSS * span_s)

    def pose(self, now_s: float, position_ned_m: Vec3, heading_rad: float | None) -> bool:
        """A pose from outside: vision, motion capture; whether it is believed. One no newer than the last is passed over."""
        if now_s <= self._pose_s:
            return True
        if not self._believed(now_s, position_ned_m):
            return False
        span_s, age_s = min(0.2, now_s - self._pose_s), now_s - max(self._fixed_s, self._pose_s)
        if age_s > FRESH_S:
            known = age_s < _CARRIED_S
            self.restart(position_ned_m, (self.vn, self.ve, self.vd) if known else (0.0, 0.0, 0.0))
        self._pose_s = now_s
        if heading_rad is not None:
            self._head(now_s, wrapped(heading_rad - heading(self.q)))
        if now_s - self._fixed_s > FRESH_S:
            dn, de, dd = (z - p for z, p in zip(position_ned_m, (self.pn, self.pe, self.pd), strict=True))
            un, ue, ud = (_POSE_CROSS * d for d in (dn, de, dd))
            place = min(_MOST_POSE, _POSE_PER_S * span_s)  # poses come at any rate, from 5 to 200 a second
            self._correct(dn, de, dd, un, ue, ud, place, span_s, 0.0, min(_MOST_WEIGHT, span_s / _FIXES_APART_S))
        return True

    def _head(self, now_s: float, error_rad: float) -> None:
        near = abs(error_rad) < _GATE_RAD
        if near or now_s - max(self._headed_s, self._fixed_s) > _AGREED_S:
            self._headed_s = now_s
            self._turn(0.0, 0.0, error_rad * (_OUTSIDE_HEADING if near else 1.0))

    def _believed(self, now_s: float, position_ned_m: Vec3) -> bool:
        """Whether the vehicle can be there; poses that insist are believed in the end, where there are no fixes."""
        age_s = now_s - max(self._fixed_s, self._pose_s)
        if dist(position_ned_m, (self.pn, self.pe, self.pd)) <= _GATE_M + _DRIFT_MPS * max(0.0, age_s - FRESH_S):
            self._doubted = None
            return True
        since_s, last_s, place = self._doubted or (now_s, now_s, position_ned_m)
        if now_s - last_s > FRESH_S or dist(position_ned_m, place) > _GATE_M:
            since_s = now_s
        self._doubted = (since_s, now_s, position_ned_m)
        return now_s - since_s >= _AGREED_S and now_s - self._fixed_s > FRESH_S

    def restart(self, position_ned_m: Vec3, velocity_ned_mps: Vec3 = (0.0, 0.0, 0.0)) -> None:
        """Take a place and a velocity as they are."""
        self.pn, self.pe, self.pd = position_ned_m
        self.vn, self.ve, self.vd = velocity_ned_mps

    def stand(self, now_s: float) -> None:
        """It stands with its rotors off: where nothing else says so, its velocity is none, and biases show."""
        if now_s - max(self._fixed_s, self._pose_s) > FRESH_S:
            self._correct(0.0, 0.0, 0.0, -self.vn, -self.ve, -self.vd, 0.0, _FIX_VELOCITY, 0.0)

    def compass(self, now_s: float, mag_frd_gauss: Vec3) -> None:
        roll, pitch, yaw = euler(self.q)
        error = wrapped(magnetic_heading(mag_frd_gauss, roll, pitch) - yaw)
        if not self._started:
            self._started = True
            self._turn(0.0, 0.0, error)
        elif now_s - self._headed_s > FRESH_S:
            self._turn(0.0, 0.0, _COMPASS * error)

    def barometer(self, now_s: float, height_m: float) -> None:
        """Height above the site's floor, used while there is nothing better."""
        self._baro_s = now_s
        if now_s - max(self._fixed_s, self._pose_s) > FRESH_S:
            error = -height_m - self.pd
            self.pd += _BARO_HEIGHT * error
            self.vd += _BARO_CLIMB * error

    def tell(self, now_s: float, gyro_works: bool = True) -> None:
        """Bring `estimate` up to date."""
        told = self.estimate
        age_s = now_s - max(self._fixed_s, self._pose_s)
        told.stamp_s = now_s
        told.position_ned_m = (self.pn, self.pe, self.pd)
        told.velocity_ned_mps = (self.vn, self.ve, self.vd)
        told.attitude = self.q
        told.roll_rad, told.pitch_rad, told.heading_rad = euler(self.q)
        told.rates_frd_radps = (self.wx, self.wy, self.wz)
        told.position_ok = self._started and age_s < FRESH_S
        told.attitude_ok = self._started and gyro_works
        told.height_ok = self._started and (age_s < FRESH_S or now_s - self._baro_s < FRESH_S)
        told.position_std_m = 0.02 + 0.3 * min(100.0, max(0.0, age_s - 0.3))
        told.velocity_std_mps = 0.03 + 0.1 * min(100.0, max(0.0, age_s - 0.3))

    def _correct(
        self,
        dn: float,
        de: float,
        dd: float,
        un: float,
        ue: float,
        ud: float,
        place: float,
        speed: float,
        cross: float,
        weight: float = 1.0,
    ) -> None:
        self.pn += place * dn
        self.pe += place * de
        self.pd += place * dd
        self.vn += speed * un + cross * dn
        self.ve += speed * ue + cross * de
        self.vd += speed * ud + cross * dd
        drift, learn, tilt = self._bias_a, weight * _BIAS_PER_MPS, weight * _TILT_PER_MPS
        for k, u in ((0, un), (1, ue), (2, ud)):
            drift[k] = max(-_MOST_BIAS, min(_MOST_BIAS, drift[k] + learn * u))
        # an unforeseen push to the north is a lean that was not seen: the attitude turns about east, and so on
        self._turn(tilt * ue, -tilt * un, 0.0)

    def _turn(self, north: float, east: float, down: float) -> None:
        """Turn the attitude by a small angle about NED axes, or a large one about down alone."""
        if abs(down) > 0.2:
            self.q = normalised(multiply((cos(down / 2.0), 0.0, 0.0, sin(down / 2.0)), self.q))
            return
        self.q = normalised(multiply((1.0, north / 2.0, east / 2.0, down / 2.0), self.q))
