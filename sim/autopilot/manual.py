"""Flying by sticks: position and stabilize. Without fresh sticks the vehicle hovers."""

import math
from dataclasses import dataclass

from sim.autopilot.flying import Hover
from sim.autopilot.situation import Situation
from sim.flight.state import FREE, AttitudeTarget, Off, Quaternion, Setpoint, Trajectory, Vec3

FRESH_S = 1.0
_DEAD = 0.05
_LEAN_RAD = math.radians(25.0)
_TURN_RADPS = 1.0
_CLIMB_GAIN = 0.5


@dataclass(frozen=True, slots=True)
class Sticks:
    """-1 to 1 each: right, forward, turn right; throttle 0 to 1."""

    roll: float
    pitch: float
    throttle: float
    yaw: float
    heard_s: float


@dataclass(slots=True)
class Manual:
    """`leaning`: the sticks give attitude and thrust (stabilize); otherwise velocities (position)."""

    leaning: bool
    sticks: Sticks | None = None
    done: bool = True
    _rest: Hover | None = None
    _heading_rad: float | None = None

    @property
    def place_ned_m(self) -> Vec3 | None:
        return self._rest.place_ned_m if self._rest else None

    def idle(self, now_s: float) -> bool:
        """Nobody asks it to leave the ground."""
        sticks = self.sticks
        return sticks is None or now_s - sticks.heard_s > FRESH_S or sticks.throttle < 0.55

    def step(self, now: Situation, now_s: float) -> Setpoint:
        sticks = self.sticks
        if now.vehicle.on_ground and self.idle(now_s):
            return Off()
        if sticks is None or now_s - sticks.heard_s > FRESH_S:
            self._rest = self._rest or Hover()
            return self._rest.step(now, now_s)
        yaw = _dead(sticks.yaw)
        if not self.leaning and now.estimate.position_ok:
            return self._glide(now, now_s, sticks, yaw)
        self._rest = None
        thrust = now.vehicle.hover_thrust
        climb = _climb(sticks)
        if self.leaning:
            thrust += (climb * (1.0 - thrust)) if climb > 0 else climb * thrust
        else:
            thrust *= 1 + _CLIMB_GAIN * (climb * now.quantity("climb_mps") + now.estimate.velocity_ned_mps[2])
        heading = now.estimate.heading_rad
        return AttitudeTarget(
            _leaning(_LEAN_RAD * sticks.roll, -_LEAN_RAD * sticks.pitch, heading + 0.3 * yaw),
            (None, None, _TURN_RADPS * yaw),
            max(0.0, min(1.0, thrust)),
        )

    def _glide(self, now: Situation, now_s: float, sticks: Sticks, yaw: float) -> Setpoint:
        roll, pitch, climb = _dead(sticks.roll), _dead(sticks.pitch), _climb(sticks)
        if roll == pitch == climb == yaw == 0.0 and not now.vehicle.on_ground:
            self._rest = self._rest or Hover()
            return self._rest.step(now, now_s)
        self._rest = None
        fastest, heading = now.quantity("cruise_mps"), now.estimate.heading_rad
        c, s = math.cos(heading), math.sin(heading)
        forward, right = fastest * pitch, fastest * roll
        down = -climb * now.quantity("climb_mps" if climb > 0 else "descent_mps")
        if down < 0 and math.isfinite(now.ceiling_m):
            down = max(down, min(0.0, now.top_down_m - now.here[2]))
        return Trajectory(
            FREE, (c * forward - s * right, s * forward + c * right, down), FREE, None, _TURN_RADPS * yaw, fastest
        )


def _climb(sticks: Sticks) -> float:
    return _dead(2.0 * sticks.throttle - 1.0)


def _dead(stick: float) -> float:
    return 0.0 if abs(stick) < _DEAD else stick


def _leaning(roll_rad: float, pitch_rad: float, heading_rad: float) -> Quaternion:
    cr, sr = math.cos(roll_rad / 2), math.sin(roll_rad / 2)
    cp, sp = math.cos(pitch_rad / 2), math.sin(pitch_rad / 2)
    cy, sy = math.cos(heading_rad / 2), math.sin(heading_rad / 2)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
