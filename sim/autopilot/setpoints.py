"""Setpoints of a companion: frames and type masks of position targets, attitude targets, what is refused and why."""

import math

from sim.autopilot.geo import GLOBAL_FRAMES, LOCAL_FRAMES, place
from sim.autopilot.interface import AttitudeSetpoint, PositionTarget
from sim.autopilot.situation import Situation
from sim.flight.state import FREE, AttitudeTarget, OptionalVec3, Trajectory, Vec3

POSITION, VELOCITY, ACCELERATION = 0x007, 0x038, 0x1C0
"""POSITION_TARGET_TYPEMASK: a triple with any of its bits set is ignored."""
FORCE, NO_YAW, NO_YAW_RATE = 0x200, 0x400, 0x800
NO_ROLL_RATE, NO_PITCH_RATE, NO_TURN_RATE, NO_THRUST, NO_ATTITUDE = 1, 2, 4, 64, 128
"""ATTITUDE_TARGET_TYPEMASK."""
BODY_FRAMES = frozenset({8, 9, 12})
OFFSET_FRAMES = frozenset({7, 8, 9, 12})
FASTEST_MPS, FASTEST_MPS2, FASTEST_RADPS = 50.0, 100.0, 20.0
"""Beyond these nobody meant it."""


def trajectory(target: PositionTarget, now: Situation) -> Trajectory | str:
    """What a position target asks for, in local NED; or a sentence why it is refused."""
    if target.frame not in LOCAL_FRAMES | GLOBAL_FRAMES:
        return f"Setpoints in frame {target.frame} are not supported."
    mask, heading = target.type_mask, now.estimate.heading_rad
    has_acceleration = not mask & ACCELERATION
    if has_acceleration and mask & FORCE:
        return "Setpoints of a force are not supported."
    position = velocity = acceleration = FREE
    if not mask & POSITION:
        found = _position(target, now)
        if isinstance(found, str):
            return found
        position = found
    if not mask & VELOCITY:
        velocity = target.velocity_mps
    if has_acceleration:
        acceleration = target.acceleration_mps2
    if wrong := _too_much(velocity, "velocity", FASTEST_MPS) or _too_much(acceleration, "acceleration", FASTEST_MPS2):
        return wrong
    if target.frame in BODY_FRAMES:
        velocity, acceleration = _turned(velocity, heading), _turned(acceleration, heading)
    if position == velocity == acceleration == FREE:
        return "The setpoint ignores position, velocity and acceleration."
    nose, rate = _yaw(target, heading)
    if isinstance(nose, str):
        return nose
    fastest = now.cruise_mps if velocity == FREE else now.quantity("fastest_mps")
    return Trajectory(
        position, velocity, acceleration, nose, rate, fastest, now.quantity("climb_mps"), now.quantity("descent_mps")
    )


def attitude(target: AttitudeSetpoint, now: Situation) -> AttitudeTarget | str:
    """What an attitude target asks for; or a sentence why it is refused."""
    mask = target.type_mask
    if mask & NO_THRUST:
        return "An attitude setpoint must give a thrust."
    if not 0.0 <= target.thrust <= 1.0:
        return f"Thrust must lie from 0 to 1, not {target.thrust:g}."
    rates: list[float | None] = []
    for bit, rate in zip((NO_ROLL_RATE, NO_PITCH_RATE, NO_TURN_RATE), target.rates_frd_radps, strict=True):
        if mask & bit:
            rates.append(None)
            continue
        if not abs(rate) <= FASTEST_RADPS:
            return f"A turn rate of {rate:g} rad/s is refused."
        rates.append(rate)
    turning = (rates[0], rates[1], rates[2])
    if mask & NO_ATTITUDE:
        if turning == FREE:
            return "The setpoint ignores attitude and rates."
        return AttitudeTarget(None, turning, target.thrust)
    size = math.hypot(*target.attitude)
    if not 0.9 < size < 1.1:
        return "The attitude is not a unit quaternion."
    w, x, y, z = (part / size for part in target.attitude)
    return AttitudeTarget((w, x, y, z), turning, target.thrust)


def _position(target: PositionTarget, now: Situation) -> Vec3 | str:
    x, y, z = target.position
    if not all(map(math.isfinite, target.position)):
        return "The position of the setpoint is not finite."
    if target.frame in OFFSET_FRAMES:
        if target.frame in BODY_FRAMES:
            c, s = math.cos(now.estimate.heading_rad), math.sin(now.estimate.heading_rad)
            x, y = c * x - s * y, s * x + c * y
        north, east, down = now.here
        found = place(1, north + x, east + y, down + z, None, None, now.here)
    else:
        found = place(target.frame, x, y, z, now.origin, now.home_ned_m, now.here)
    if found is None:
        return f"Positions in frame {target.frame} are not supported."
    return found if isinstance(found, str) else now.below_ceiling(found)


def _yaw(target: PositionTarget, heading_rad: float) -> tuple[float | str | None, float | None]:
    """(heading or a sentence, rate); a heading goes before a rate, NaN means none."""
    nose: float | None = None
    rate: float | None = None
    if not target.type_mask & NO_YAW and not math.isnan(target.yaw_rad):
        if not abs(target.yaw_rad) < 1000.0:
            return "The yaw of the setpoint makes no sense.", None
        nose = math.remainder(target.yaw_rad + (heading_rad if target.frame in BODY_FRAMES else 0.0), math.tau)
    elif not target.type_mask & NO_YAW_RATE and not math.isnan(target.yaw_rate_radps):
        if not abs(target.yaw_rate_radps) <= FASTEST_RADPS:
            return "The yaw rate of the setpoint makes no sense.", None
        rate = target.yaw_rate_radps
    return nose, rate


def _too_much(triple: OptionalVec3, name: str, most: float) -> str:
    if all(axis is None or abs(axis) <= most for axis in triple):
        return ""
    return f"The {name} of the setpoint is not finite or beyond {most:g}."


def _turned(triple: OptionalVec3, heading_rad: float) -> OptionalVec3:
    forward, right, down = triple
    if forward is None or right is None:
        return triple
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    return c * forward - s * right, s * forward + c * right, down
