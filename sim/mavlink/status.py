"""Messages of how the vehicle is: heartbeat, health, battery, sensors, mission. One builder each, from one `Telemetry`."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Telemetry
from sim.mavlink.craft import Craft
from sim.mavlink.pack import boot_ms, boot_us, finite, i16, i32, single, u8, u16
from sim.mavlink.peer import Message

CELLS = 4
NO_CELL = 0xFFFF
UNTOLD = 0
HEIGHTS = ("ceiling", "maximum altitude")
"""The breaches of a fence that are no matter of where it is across."""
STANDARD_GRAVITY = 9.80665
VENDOR = 0x5232
"""R2, as two letters."""


def heartbeat(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_heartbeat_message(
        mav.MAV_TYPE_QUADROTOR,
        craft.personality.autopilot,
        now.base_mode & 0xFF,
        now.custom_mode & 0xFFFF_FFFF,
        now.system_status & 0xFF,
        3,
    )


def _percent(now: Telemetry) -> int:
    return min(max(round(now.battery.remaining * 100), 0), 100) if math.isfinite(now.battery.remaining) else -1


def system(craft: Craft, now: Telemetry) -> Message:
    masks = (now.present & 0xFFFF_FFFF, now.enabled & 0xFFFF_FFFF, now.health & 0xFFFF_FFFF)
    battery = now.battery
    return mav.MAVLink_sys_status_message(
        *masks, 250, u16(battery.voltage_v * 1000), i16(battery.current_a * 100), _percent(now), 0, 0, 0, 0, 0, 0
    )


def extended(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_extended_sys_state_message(0, now.landed_state & 0xFF)


def clock(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_system_time_message(boot_us(craft.unix_s + now.now_s), boot_ms(now.now_s))


def battery(craft: Craft, now: Telemetry) -> Message:
    each = min(u16(now.battery.voltage_v * 1000 / CELLS), NO_CELL - 1)
    return mav.MAVLink_battery_status_message(
        0,
        mav.MAV_BATTERY_FUNCTION_ALL,
        mav.MAV_BATTERY_TYPE_LIPO,
        i16(now.sensors.temperature_degc * 100),
        [each] * CELLS + [NO_CELL] * (10 - CELLS),
        i16(now.battery.current_a * 100),
        i32(now.battery.consumed_mah),
        i32(now.battery.consumed_mah * now.battery.voltage_v * 0.036),
        _percent(now),
        max(1, i32(now.battery.left_s)) if now.battery.left_s is not None else UNTOLD,
    )


def ekf(craft: Craft, now: Telemetry) -> Message:
    guess = now.estimate
    position = min(single(guess.position_std_m), 10.0) if math.isfinite(guess.position_std_m) else 10.0
    velocity = min(single(guess.velocity_std_mps), 10.0) if math.isfinite(guess.velocity_std_mps) else 10.0
    return mav.MAVLink_ekf_status_report_message(now.ekf_flags & 0xFFFF, velocity, position, position, 0.02, 0.0)


ESTIMATOR_BITS = (
    (0x1, 1),
    (0x2, 2),
    (0x4, 4),
    (0x8, 8),
    (0x10, 16),
    (0x20, 32),
    (0x40, 64),
    (0x100, 256),
    (0x200, 512),
)
"""EKF_STATUS_FLAGS that ESTIMATOR_STATUS_FLAGS has as well, and their numbers there."""


def estimator(craft: Craft, now: Telemetry) -> Message:
    flags = sum(theirs for ours, theirs in ESTIMATOR_BITS if now.ekf_flags & ours)
    guess = now.estimate
    accuracy = min(single(guess.position_std_m), 100.0) if math.isfinite(guess.position_std_m) else 100.0
    return mav.MAVLink_estimator_status_message(
        boot_us(now.now_s), flags, 0.1, 0.1, 0.1, 0.1, 0.0, 0.0, accuracy, accuracy
    )


def rc_raw(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_rc_channels_raw_message(
        boot_ms(now.now_s), 0, *craft.sticks_us(now.now_s), 1800, 1000, 1000, 1800, 255
    )


def rc(craft: Craft, now: Telemetry) -> Message:
    unused = (NO_CELL,) * 10
    sticks = (*craft.sticks_us(now.now_s), 1800, 1000, 1000, 1800)
    return mav.MAVLink_rc_channels_message(boot_ms(now.now_s), 8, *sticks, *unused, 255)


def servos(craft: Craft, now: Telemetry) -> Message:
    pulses = [u16(1000 + 1000 * rotor) if now.armed else 1000 for rotor in now.rotors]
    return mav.MAVLink_servo_output_raw_message(boot_us(now.now_s) & 0xFFFF_FFFF, 0, *pulses, 0, 0, 0, 0)


def mission(craft: Craft, now: Telemetry) -> Message:
    flown = now.mission_count - int(craft.personality.home_is_item_0)  # the protocol leaves home out of the total
    if not flown:
        state = mav.MISSION_STATE_NO_MISSION
    elif craft.last_reached is not None and min(craft.last_reached, now.mission_current) >= now.mission_count - 1:
        state = mav.MISSION_STATE_COMPLETE
    elif craft.personality.mode(now.custom_mode) == "mission":
        state = mav.MISSION_STATE_ACTIVE
    else:
        state = mav.MISSION_STATE_NOT_STARTED
    return mav.MAVLink_mission_current_message(u16(now.mission_current), u16(flown), state, 0)


def _readable(now: Telemetry) -> bool:
    sensed = now.sensors
    vectors = (*sensed.accel_frd_mps2, *sensed.gyro_frd_radps, *sensed.mag_frd_gauss)
    return finite((*vectors, sensed.pressure_hpa, sensed.temperature_degc))


def _scaled(now: Telemetry) -> list[int]:
    """Milli-g, milliradians a second and milligauss."""
    sensed = now.sensors
    accel = [i16(value * 1000 / STANDARD_GRAVITY) for value in sensed.accel_frd_mps2]
    return accel + [i16(value * 1000) for value in (*sensed.gyro_frd_radps, *sensed.mag_frd_gauss)]


def imu(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_scaled_imu_message(boot_ms(now.now_s), *_scaled(now), i16(now.sensors.temperature_degc * 100))


def raw_imu(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_raw_imu_message(boot_us(now.now_s), *_scaled(now), 0, i16(now.sensors.temperature_degc * 100))


def highres_imu(craft: Craft, now: Telemetry) -> Message | None:
    if not _readable(now):
        return None
    sensed = now.sensors
    vectors = (single(v) for v in (*sensed.accel_frd_mps2, *sensed.gyro_frd_radps, *sensed.mag_frd_gauss))
    height_m = 44330.0 * (1 - (max(sensed.pressure_hpa, 1.0) / 1013.25) ** 0.190295)
    return mav.MAVLink_highres_imu_message(
        boot_us(now.now_s), *vectors, single(sensed.pressure_hpa), 0.0, height_m, sensed.temperature_degc, 0x1BFF
    )


def pressure(craft: Craft, now: Telemetry) -> Message | None:
    if not _readable(now):
        return None
    sensed = now.sensors
    return mav.MAVLink_scaled_pressure_message(
        boot_ms(now.now_s), single(sensed.pressure_hpa), 0.0, i16(sensed.temperature_degc * 100)
    )


def vibration(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_vibration_message(boot_us(now.now_s), 0.0, 0.0, 0.0, 0, 0, 0)


def fence(craft: Craft, now: Telemetry) -> Message:
    kind = mav.FENCE_BREACH_NONE
    if now.fence_breach:
        kind = mav.FENCE_BREACH_MAXALT if now.fence_breach in HEIGHTS else mav.FENCE_BREACH_BOUNDARY
    since_ms = boot_ms(now.fence_breached_s) if now.fence_breaches else 0
    return mav.MAVLink_fence_status_message(int(kind != 0), u16(now.fence_breaches), kind, since_ms)


def version(craft: Craft, now: Telemetry) -> Message:
    row = craft.personality
    nothing = [0] * 8
    ids = (VENDOR, u8(craft.sysid), craft.sysid, [craft.sysid & 0xFF] + [0] * 17)
    return mav.MAVLink_autopilot_version_message(
        row.capabilities, row.firmware_version, 0, 0, 0, nothing, nothing, nothing, *ids
    )


def flight(craft: Craft, now: Telemetry) -> Message:
    return mav.MAVLink_flight_information_message(boot_ms(now.now_s), 0, 0, 0)
