"""Flying what a companion asks for: the latest setpoint, how long it holds, and what follows when it is too old."""

import math
from dataclasses import dataclass, replace

from sim.autopilot.flying import Circle, Climb, Hover, blind
from sim.autopilot.interface import Severity
from sim.autopilot.situation import Situation
from sim.flight.state import FREE, AttitudeTarget, Off, OptionalVec3, Setpoint, Trajectory, Vec3

_CLIMB_GAIN = 0.5
"""Part of the hover thrust for each m/s of climb that is missing."""


@dataclass(slots=True)
class Guided:
    """Offboard, in ArduCopter's words guided. Hovers until there is a setpoint."""

    target: Trajectory | AttitudeTarget | None = None
    heard_s: float = -math.inf
    rest: Hover | Climb | Circle | None = None
    """What is flown without a setpoint: taking off, a place to go to, or hovering where it came to rest."""
    done: bool = True
    _pace: Vec3 | None = None
    _last_s: float = 0.0

    def take(self, target: Trajectory | AttitudeTarget, now_s: float) -> None:
        self.target, self.heard_s, self.rest = target, now_s, None
        if not _accelerates(target):
            self._pace = None

    @property
    def place_ned_m(self) -> Vec3 | None:
        if isinstance(self.target, Trajectory):
            n, e, d = self.target.position_ned_m
            return None if n is None or e is None or d is None else (n, e, d)
        return self.rest.place_ned_m if self.rest else None

    def step(self, now: Situation, now_s: float) -> Setpoint:
        span_s, self._last_s = min(0.1, now_s - self._last_s), now_s
        timeout_s = math.inf if now.row.setpoint_stream else now.params.get("GUID_TIMEOUT")
        if self.target is not None and now_s - self.heard_s > timeout_s and not _stays(self.target):
            self.target, self._pace = None, None
            now.say(Severity.WARNING, "Setpoints stopped: hovering")
        if self.target is None:
            self.rest = self.rest or Hover()
            return self.rest.step(now, now_s)
        if now.vehicle.on_ground and not now.row.setpoint_stream:
            return Off()
        if isinstance(self.target, AttitudeTarget):
            return self._lean(now, self.target)
        if not now.estimate.position_ok:
            return blind(now, 0.0)
        if _accelerates(self.target):
            return self._push(now, self.target, span_s)
        return replace(self.target, velocity_ned_mps=_under_ceiling(now, self.target.velocity_ned_mps))

    def _push(self, now: Situation, target: Trajectory, span_s: float) -> Trajectory:
        """Acceleration alone: the velocity that it has made by now, up to what this vehicle flies at."""
        an, ae, ad = (axis or 0.0 for axis in target.acceleration_ned_mps2)
        vn, ve, vd = self._pace or now.estimate.velocity_ned_mps
        vn, ve = vn + an * span_s, ve + ae * span_s
        speed, most = math.hypot(vn, ve), now.quantity("fastest_mps")
        if speed > most:
            vn, ve = vn * most / speed, ve * most / speed
        vd = max(-now.quantity("climb_mps"), min(now.quantity("descent_mps"), vd + ad * span_s))
        self._pace = (vn, ve, vd)
        return replace(target, velocity_ned_mps=_under_ceiling(now, self._pace), acceleration_ned_mps2=FREE)

    @staticmethod
    def _lean(now: Situation, target: AttitudeTarget) -> AttitudeTarget:
        """ArduCopter reads the thrust as a climb rate around a half."""
        if now.row.setpoint_stream:
            return target
        wanted_mps = (target.thrust - 0.5) * 2 * now.quantity("climb_mps")
        missing_mps = wanted_mps + now.estimate.velocity_ned_mps[2]
        lean = math.cos(now.estimate.roll_rad) * math.cos(now.estimate.pitch_rad)
        thrust = now.vehicle.hover_thrust * (1 + _CLIMB_GAIN * missing_mps) / max(0.5, lean)
        return replace(target, thrust=max(0.0, min(1.0, thrust)))


def _stays(target: Trajectory | AttitudeTarget) -> bool:
    """A place alone is not forgotten."""
    return (
        isinstance(target, Trajectory)
        and target.position_ned_m != FREE
        and target.velocity_ned_mps == target.acceleration_ned_mps2 == FREE
    )


def _accelerates(target: Trajectory | AttitudeTarget) -> bool:
    """Whether acceleration is all that it gives."""
    return (
        isinstance(target, Trajectory)
        and target.position_ned_m == target.velocity_ned_mps == FREE
        and target.acceleration_ned_mps2 != FREE
    )


def _under_ceiling(now: Situation, velocity: OptionalVec3) -> OptionalVec3:
    """Slower the nearer it is to what may be reached below the ceiling."""
    down = velocity[2]
    if down is None or down >= 0.0 or math.isinf(now.top_down_m):
        return velocity
    return velocity[0], velocity[1], max(down, min(0.0, now.top_down_m - now.here[2]))
