"""Messages of where the vehicle believes it is and how it moves: one builder each, from one `Telemetry`."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.geo import Origin
from sim.autopilot.interface import Telemetry
from sim.flight.state import Vec3
from sim.mavlink.craft import Craft
from sim.mavlink.pack import boot_ms, boot_us, centidegrees, finite, i16, i32, single, u16
from sim.mavlink.peer import Message

UNKNOWN = math.nan
NO_QUATERNION = [0.0, 0.0, 0.0, 0.0]
SATELLITES = 12


def usable(now: Telemetry) -> bool:
    """Whether the estimate is all numbers: without, nothing here is sent."""
    guess = now.estimate
    return finite((*guess.position_ned_m, *guess.velocity_ned_mps, *guess.attitude, *guess.rates_frd_radps)) and finite(
        (guess.roll_rad, guess.pitch_rad, guess.heading_rad)
    )


def _floats(values: Vec3) -> Vec3:
    x, y, z = values
    return single(x), single(y), single(z)


def attitude(craft: Craft, now: Telemetry) -> Message:
    guess = now.estimate
    rates = _floats(guess.rates_frd_radps)
    return mav.MAVLink_attitude_message(boot_ms(now.now_s), guess.roll_rad, guess.pitch_rad, guess.heading_rad, *rates)


def attitude_quaternion(craft: Craft, now: Telemetry) -> Message:
    guess = now.estimate
    return mav.MAVLink_attitude_quaternion_message(
        boot_ms(now.now_s), *guess.attitude, *_floats(guess.rates_frd_radps), repr_offset_q=NO_QUATERNION
    )


def local_position(craft: Craft, now: Telemetry) -> Message | None:
    guess = now.estimate
    if not guess.position_ok:
        return None
    return mav.MAVLink_local_position_ned_message(
        boot_ms(now.now_s), *_floats(guess.position_ned_m), *_floats(guess.velocity_ned_mps)
    )


def above_home_m(now: Telemetry) -> float:
    """Height over home, or over the local origin before there is a home."""
    return (now.home_ned_m or (0.0, 0.0, 0.0))[2] - now.estimate.position_ned_m[2]


def place(origin: Vec3, position_ned_m: Vec3) -> tuple[int, int, int]:
    """Degrees by 1e7 and millimetres AMSL."""
    altitude_m = origin[2] - position_ned_m[2]
    latitude, longitude = Origin(*origin).globe(position_ned_m[0], position_ned_m[1])
    return i32(latitude * 1e7), i32(longitude * 1e7), i32(altitude_m * 1000)


def global_position(craft: Craft, now: Telemetry) -> Message | None:
    guess = now.estimate
    if now.origin is None or not guess.position_ok:
        return None
    north, east, down = guess.velocity_ned_mps
    return mav.MAVLink_global_position_int_message(
        boot_ms(now.now_s),
        *place(now.origin, guess.position_ned_m),
        i32(above_home_m(now) * 1000),
        i16(north * 100),
        i16(east * 100),
        i16(down * 100),
        centidegrees(guess.heading_rad),
    )


def gps_raw(craft: Craft, now: Telemetry) -> Message:
    fix, origin = now.sensors.fix_ned_m, now.origin
    if fix is None or origin is None or not now.global_fix or not finite((*fix, *now.sensors.fix_velocity_ned_mps)):
        return mav.MAVLink_gps_raw_int_message(boot_us(now.now_s), 0, 0, 0, 0, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0)
    north, east, _ = now.sensors.fix_velocity_ned_mps
    latitude, longitude, altitude_mm = place(origin, fix)
    return mav.MAVLink_gps_raw_int_message(
        boot_us(now.now_s),
        3,
        latitude,
        longitude,
        altitude_mm,
        50,
        50,
        u16(math.hypot(north, east) * 100),
        centidegrees(math.atan2(east, north)),
        SATELLITES,
        altitude_mm,
        20,
        20,
        50,
    )


def home(craft: Craft, now: Telemetry) -> Message | None:
    if now.home_ned_m is None or now.origin is None or not finite(now.home_ned_m):
        return None
    half = now.home_heading_rad / 2
    turn = [math.cos(half), 0.0, 0.0, math.sin(half)] if math.isfinite(half) else [1.0, 0.0, 0.0, 0.0]
    return mav.MAVLink_home_position_message(
        *place(now.origin, now.home_ned_m), *_floats(now.home_ned_m), turn, 0.0, 0.0, 0.0, boot_us(now.now_s)
    )


def origin(craft: Craft, now: Telemetry) -> Message | None:
    if now.origin is None:
        return None
    return mav.MAVLink_gps_global_origin_message(*place(now.origin, (0.0, 0.0, 0.0)), boot_us(now.now_s))


def vfr_hud(craft: Craft, now: Telemetry) -> Message:
    guess = now.estimate
    north, east, down = guess.velocity_ned_mps
    speed = single(math.hypot(north, east))
    throttle = u16(100 * sum(now.rotors) / 4)
    amsl = (now.origin[2] if now.origin else 0.0) - guess.position_ned_m[2]
    heading = centidegrees(guess.heading_rad) // 100
    return mav.MAVLink_vfr_hud_message(speed, speed, heading, throttle, single(amsl), single(-down))


def altitude(craft: Craft, now: Telemetry) -> Message:
    height = single(-now.estimate.position_ned_m[2])
    amsl = height + (now.origin[2] if now.origin else 0.0)
    above = single(above_home_m(now))
    return mav.MAVLink_altitude_message(boot_us(now.now_s), height, single(amsl), height, above, UNKNOWN, UNKNOWN)


def odometry(craft: Craft, now: Telemetry) -> Message | None:
    """Pose in local NED, velocity in the body's axes."""
    guess = now.estimate
    if not guess.position_ok:
        return None
    pose = [0.0] * 21
    pose[0] = pose[6] = pose[11] = single(guess.position_std_m**2)
    speed = [0.0] * 21
    speed[0] = speed[6] = speed[11] = single(guess.velocity_std_mps**2)
    w, x, y, z = guess.attitude
    vx, vy, vz = guess.velocity_ned_mps
    tx, ty, tz = 2 * (vy * z - vz * y), 2 * (vz * x - vx * z), 2 * (vx * y - vy * x)
    body = (vx + w * tx + ty * z - tz * y, vy + w * ty + tz * x - tx * z, vz + w * tz + tx * y - ty * x)
    return mav.MAVLink_odometry_message(
        boot_us(now.now_s),
        mav.MAV_FRAME_LOCAL_NED,
        mav.MAV_FRAME_BODY_FRD,
        *_floats(guess.position_ned_m),
        list(guess.attitude),
        *_floats(body),
        *_floats(guess.rates_frd_radps),
        pose,
        speed,
        0,
        mav.MAV_ESTIMATOR_TYPE_AUTOPILOT,
        100,
    )


def target(craft: Craft, now: Telemetry) -> Message | None:
    """POSITION_TARGET_LOCAL_NED of where it is flying to; nothing while it flies to no place."""
    if now.target_ned_m is None or not finite(now.target_ned_m):
        return None
    zeros = (0.0,) * 8
    where = _floats(now.target_ned_m)
    return mav.MAVLink_position_target_local_ned_message(boot_ms(now.now_s), 1, 0xDF8, *where, *zeros)


def navigation(craft: Craft, now: Telemetry) -> Message | None:
    guess = now.estimate
    if now.target_ned_m is None or not finite(now.target_ned_m):
        return None
    north, east, down = (to - at for to, at in zip(now.target_ned_m, guess.position_ned_m, strict=True))
    return mav.MAVLink_nav_controller_output_message(
        math.degrees(guess.roll_rad),
        math.degrees(guess.pitch_rad),
        i16(math.degrees(guess.heading_rad)),
        i16(math.degrees(math.atan2(east, north))),
        u16(math.hypot(north, east)),
        single(-down),
        0.0,
        0.0,
    )
