"""The cascade: position, velocity, attitude, rate. Each stage turns an error into the wish of the next."""

from math import hypot, pi, sqrt, tan

from sim.bullet import GRAVITY_MPS2
from sim.flight.airframe import (
    ARM_M,
    DRAG_NPMPS,
    DRAG_NPMPS2,
    HOVER_THRUST,
    INERTIA_KGM2,
    MASS_KG,
    MAX_THRUST_N,
    TORQUE_PER_THRUST_M,
    mix,
)
from sim.flight.attitude import leaning, wrapped
from sim.flight.estimator import Estimator
from sim.flight.state import AttitudeTarget, Quaternion, Trajectory, Vec3

MAX_TILT_RAD = 35.0 * pi / 180.0
MAX_SPEED_MPS, MAX_CLIMB_MPS, MAX_DESCENT_MPS = 5.0, 2.5, 1.5
_ACCELERATION_MPS2, _VERTICAL_MPS2 = 3.0, 3.0
_BRAKING_MPS2 = 1.6
"""What is planned for when a place is approached; the rest is for what was not foreseen."""
_PLACE_PER_S, _HEIGHT_PER_S = 1.5, 1.6
_SPEED_PER_S, _SPEED_PER_S2 = 3.2, 0.6
_CLIMB_PER_S, _CLIMB_PER_S2 = 4.0, 1.5
_MOST_PUSH_MPS2 = 3.0
"""Bounds what the integrals have learnt."""
_TILT_PER_S, _HEADING_PER_S = 8.0, 2.5
_MAX_RATE, _MAX_YAW_RATE = 4.0, 1.6
_RATE_PER_S, _RATE_PER_S2 = 20.0, 12.0
_YAW_RATE_PER_S, _YAW_RATE_PER_S2 = 8.0, 3.0
_MOST_LEARNT_RADPS2 = 15.0
_LEAST_THRUST = 0.06
_TAN = tan(MAX_TILT_RAD)

Thrusts = tuple[float, float, float, float]


class Control:
    """`guide` at the slower rate turns a trajectory into attitude and thrust; `steer` at every step follows them."""

    __slots__ = (
        "_attitude", "_heading", "_learnt", "_pushed", "_rates", "_sent", "_thrust", "_yaw_rate", "wanted_down_mps",
    )  # fmt: skip

    def __init__(self) -> None:
        self.begin(0.0)

    def begin(self, heading_rad: float) -> None:
        """Forget what was learnt: on the ground, before take-off."""
        self._attitude: Quaternion | None = (1.0, 0.0, 0.0, 0.0)
        self._rates: Vec3 = (0.0, 0.0, 0.0)
        self._thrust = _LEAST_THRUST
        self._heading = heading_rad
        self._yaw_rate = 0.0
        self._sent = [0.0, 0.0, 0.0]
        """The velocity wished at the last guidance, from which the next may not be far."""
        self._pushed = [0.0, 0.0, 0.0]
        self._learnt = [0.0, 0.0, 0.0]
        self.wanted_down_mps = 0.0

    @property
    def thrust(self) -> float:
        """Wished, as a part of the full one."""
        return self._thrust

    def obey(self, target: AttitudeTarget, now: Estimator) -> None:
        """Attitude or rates from outside."""
        self._thrust = max(_LEAST_THRUST, min(1.0, target.thrust))
        self._attitude = target.attitude
        p, q, r = (0.0 if rate is None else rate for rate in target.rates_frd_radps)
        self._rates = (p, q, r)
        self._yaw_rate = r
        self._sent = [now.vn, now.ve, now.vd]
        self.wanted_down_mps = MAX_DESCENT_MPS if target.thrust < 0.75 * HOVER_THRUST else 0.0

    def guide(self, wish: Trajectory, now: Estimator, heading_rad: float, span_s: float) -> None:
        """Position and velocity, `span_s` after the last time."""
        vn, ve, vd = self._velocity(wish, now)
        sent, pushed = self._sent, self._pushed
        before = (sent[0], sent[1], sent[2])
        change = hypot(vn - sent[0], ve - sent[1])
        share = min(1.0, _ACCELERATION_MPS2 * span_s / change) if change > 1e-9 else 1.0
        sent[0] += share * (vn - sent[0])
        sent[1] += share * (ve - sent[1])
        most = _VERTICAL_MPS2 * span_s
        sent[2] += max(-most, min(most, vd - sent[2]))
        self.wanted_down_mps = sent[2]
        free = wish.acceleration_ned_mps2
        fed = [
            (sent[k] - before[k]) / span_s * 0.6 + (a if (a := free[k]) is not None else 0.0) for k in (0, 1, 2)
        ]  # what the wish itself accelerates is fed forward, less the lag of the attitude
        en, ee, ed = sent[0] - now.vn, sent[1] - now.ve, sent[2] - now.vd
        air = (DRAG_NPMPS + DRAG_NPMPS2 * hypot(sent[0], sent[1])) / MASS_KG
        an = _SPEED_PER_S * en + pushed[0] + fed[0] + air * sent[0]
        ae = _SPEED_PER_S * ee + pushed[1] + fed[1] + air * sent[1]
        ad = _CLIMB_PER_S * ed + pushed[2] + fed[2]
        up = GRAVITY_MPS2 - ad
        least, most_up = 0.35 * GRAVITY_MPS2, 1.75 * GRAVITY_MPS2
        saturated = up < least or up > most_up
        up = max(least, min(most_up, up))
        side = hypot(an, ae)
        leaning_too_far = side > _TAN * up
        if leaning_too_far:
            an, ae = an * _TAN * up / side, ae * _TAN * up / side
        if not leaning_too_far:
            _learn(pushed, 0, _SPEED_PER_S2 * en * span_s, _MOST_PUSH_MPS2)
            _learn(pushed, 1, _SPEED_PER_S2 * ee * span_s, _MOST_PUSH_MPS2)
        if not saturated:
            _learn(pushed, 2, _CLIMB_PER_S2 * ed * span_s, 2.0 * _MOST_PUSH_MPS2)
        size = sqrt(an * an + ae * ae + up * up)
        self._point(wish, heading_rad, span_s)
        self._attitude = leaning((-an / size, -ae / size, up / size), self._heading)
        w, x, y, z = now.q
        dx, dy, dz = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z
        lift = max(0.5, (-an * dx - ae * dy + up * dz) / size)  # the part of the thrust that points where it should
        self._thrust = max(_LEAST_THRUST, min(1.0, MASS_KG * size * lift / (4.0 * MAX_THRUST_N)))
        self._rates = (0.0, 0.0, 0.0)

    def press_down(self, heading_rad: float) -> None:
        """Stand on the floor with idling rotors."""
        self.begin(heading_rad)
        self._attitude = leaning((0.0, 0.0, 1.0), heading_rad)

    def steer(self, now: Estimator, step_s: float) -> Thrusts:
        """Attitude and rates: thrusts for the rotors."""
        rp, rq, rr = self._rates
        target = self._attitude
        if target is not None:
            w, x, y, z = now.q
            tw, tx, ty, tz = target
            ew, ex = w * tw + x * tx + y * ty + z * tz, w * tx - x * tw - y * tz + z * ty
            ey, ez = w * ty + x * tz - y * tw - z * tx, w * tz - x * ty + y * tx - z * tw
            k = 2.0 if ew >= 0.0 else -2.0
            rp += _bounded(_TILT_PER_S * k * ex, _MAX_RATE)
            rq += _bounded(_TILT_PER_S * k * ey, _MAX_RATE)
            rr = self._yaw_rate + _bounded(_HEADING_PER_S * k * ez, _MAX_YAW_RATE)
        ep, eq, er = rp - now.wx, rq - now.wy, rr - now.wz
        learnt = self._learnt
        _learn(learnt, 0, _RATE_PER_S2 * ep * step_s, _MOST_LEARNT_RADPS2)
        _learn(learnt, 1, _RATE_PER_S2 * eq * step_s, _MOST_LEARNT_RADPS2)
        _learn(learnt, 2, _YAW_RATE_PER_S2 * er * step_s, _MOST_LEARNT_RADPS2)
        return mix(
            self._thrust,
            _ROLL * (_RATE_PER_S * ep + learnt[0]),
            _PITCH * (_RATE_PER_S * eq + learnt[1]),
            _YAW * (_YAW_RATE_PER_S * er + learnt[2]),
        )

    def _velocity(self, wish: Trajectory, now: Estimator) -> Vec3:
        (pn, pe, pd), (vn, ve, vd) = wish.position_ned_m, wish.velocity_ned_mps
        n, e, d = vn or 0.0, ve or 0.0, vd or 0.0
        fastest = min(MAX_SPEED_MPS, wish.max_speed_mps or MAX_SPEED_MPS)
        if pn is not None or pe is not None:
            dn, de = (pn - now.pn if pn is not None else 0.0), (pe - now.pe if pe is not None else 0.0)
            gap = hypot(dn, de)
            if gap > 1e-6:
                pull = min(_approach(gap, _PLACE_PER_S, _BRAKING_MPS2), fastest) / gap
                n, e = n + pull * dn, e + pull * de
        speed = hypot(n, e)
        if speed > fastest:
            n, e = n * fastest / speed, e * fastest / speed
        if pd is not None:
            dd = pd - now.pd
            pull = _approach(abs(dd), _HEIGHT_PER_S, _BRAKING_MPS2)
            d += pull if dd > 0.0 else -pull
        up, down = wish.max_climb_mps or MAX_CLIMB_MPS, wish.max_descent_mps or MAX_DESCENT_MPS
        return (n, e, max(-min(MAX_CLIMB_MPS, up), min(min(MAX_DESCENT_MPS, down), d)))

    def _point(self, wish: Trajectory, heading_rad: float, span_s: float) -> None:
        if wish.heading_rad is not None:
            error = wrapped(wish.heading_rad - self._heading)
            most = _MAX_YAW_RATE * span_s
            self._heading = wrapped(self._heading + max(-most, min(most, error)))
            self._yaw_rate = 0.0
        elif wish.heading_rate_radps is not None:
            self._yaw_rate = _bounded(wish.heading_rate_radps, _MAX_YAW_RATE)
            self._heading = wrapped(self._heading + self._yaw_rate * span_s)
        else:
            self._yaw_rate = 0.0
        lag = wrapped(self._heading - heading_rad)
        if abs(lag) > 0.6:
            self._heading = wrapped(heading_rad + _bounded(lag, 0.6))


_ROLL = INERTIA_KGM2[0] / (4.0 * ARM_M * MAX_THRUST_N)
_PITCH = INERTIA_KGM2[1] / (4.0 * ARM_M * MAX_THRUST_N)
_YAW = INERTIA_KGM2[2] / (4.0 * TORQUE_PER_THRUST_M * MAX_THRUST_N)


def _approach(gap_m: float, per_s: float, braking_mps2: float) -> float:
    """How fast to go towards a place: in proportion when near, no faster than it can be braked when far."""
    near = braking_mps2 / (per_s * per_s)
    return per_s * gap_m if gap_m < near else sqrt(braking_mps2 * (2.0 * gap_m - near))


def _bounded(value: float, most: float) -> float:
    return max(-most, min(most, value))


def _learn(values: list[float], at: int, change: float, most: float) -> None:
    value = values[at] + change
    values[at] = value if -most < value < most else (most if value > 0.0 else -most)
