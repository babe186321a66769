"""What the autopilot says of itself: sensor masks, estimator flags, states."""

from sim.autopilot.fence import Zone, guards
from sim.autopilot.situation import Situation

GYRO, ACCEL, MAG, BARO, GPS, VISION = 0x1, 0x2, 0x4, 0x8, 0x20, 0x80
CONTROL = 0x400 | 0x800 | 0x1000 | 0x2000 | 0x4000 | 0x8000
"""Angular rates, attitude, yaw, height, place and motors."""
GEOFENCE, AHRS, BATTERY, PREARM = 0x100000, 0x200000, 0x2000000, 0x10000000
"""MAV_SYS_STATUS_SENSOR."""

ATTITUDE, SPEED, CLIMB, NEAR, FAR, HEIGHT, CONSTANT, WILL_NEAR, WILL_FAR = 1, 2, 4, 8, 0x10, 0x20, 0x80, 0x100, 0x200
"""EKF_STATUS_FLAGS: attitude, velocities, relative and absolute place, height, constant position, predicted places."""


def masks(now: Situation, fence: list[Zone], breached: bool, armable: bool) -> tuple[int, int, int]:
    """(present, enabled, healthy) as SYS_STATUS has them."""
    source = GPS if now.gps == "fused" else VISION
    present = GYRO | ACCEL | MAG | BARO | source | CONTROL | GEOFENCE | AHRS | BATTERY | PREARM
    enabled = present if guards(now, fence) else present & ~GEOFENCE
    works, estimate = now.vehicle.sensors.healthy, now.estimate
    healthy = CONTROL
    for unit, bit in (("gyro", GYRO), ("accel", ACCEL), ("mag", MAG), ("baro", BARO), ("battery", BATTERY)):
        healthy |= bit if works.get(unit, True) else 0
    located = estimate.position_ok and (now.gps == "none" or works.get("fix", True))
    healthy |= source if located else 0
    healthy |= 0 if breached else GEOFENCE
    healthy |= AHRS if estimate.attitude_ok else 0
    healthy |= PREARM if armable else 0
    return present, enabled, healthy


def estimator_flags(now: Situation) -> int:
    """EKF_STATUS_FLAGS: 0x33f is all good, 0x12f the same without a place on the globe."""
    estimate = now.estimate
    flags = ATTITUDE if estimate.attitude_ok else 0
    if estimate.height_ok:
        flags |= CLIMB | HEIGHT
    if not estimate.position_ok:
        return flags | CONSTANT
    flags |= SPEED | NEAR | WILL_NEAR
    return flags | FAR | WILL_FAR if now.origin is not None else flags
