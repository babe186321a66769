"""What must hold before the rotors may turn, each with the reason that a person is told."""

from collections.abc import Iterator

from sim.autopilot.alarms import Watch
from sim.autopilot.situation import Situation

FORCE = 21196
"""The magic number in param 2 of COMPONENT_ARM_DISARM that skips the checks."""
_UNITS = {"gyro": "Gyros", "accel": "Accelerometers", "mag": "Compass", "baro": "Barometer", "battery": "Battery"}


def reasons(now: Situation, watch: Watch) -> Iterator[str]:
    """Why it is not armable, apart from the mode; none when it is."""
    estimate, vehicle = now.estimate, now.vehicle
    if now.row.name == "ardupilot" and not now.params.get("ARMING_CHECK"):
        return
    for unit, name in _UNITS.items():
        if not vehicle.sensors.healthy.get(unit, True):
            yield f"{name} not healthy"
    if not estimate.attitude_ok:
        yield "AHRS not ready"
    if not (estimate.position_ok and estimate.height_ok):
        yield "Need Position Estimate"
    if vehicle.tipped:
        yield "Leaning too far"
    if not vehicle.on_ground:
        yield "Not on the ground"
    if watch.critical or watch.emergency or _too_low(now):
        yield "Battery too low"
    if watch.breach:
        yield f"Fence breached: {watch.breach}"


def mode_reason(now: Situation) -> str:
    """Why it can not be armed in this mode; empty when it can."""
    return "" if now.mode in now.row.armable_modes else f"Mode {now.mode} does not arm"


def _too_low(now: Situation) -> bool:
    battery = now.vehicle.battery
    if now.row.name == "ardupilot":
        return battery.voltage_v < now.params.get("BATT_ARM_VOLT") or battery.remaining <= 0.0
    return battery.remaining < max(now.params.get("COM_ARM_BAT_MIN"), 1e-6)
