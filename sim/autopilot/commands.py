"""Every command that the firmware itself answers, by its MAV_CMD; the wire answers the rest."""

import math
from collections.abc import Callable

from sim.autopilot import orders
from sim.autopilot.arming import FORCE, reasons
from sim.autopilot.conduct import Conduct
from sim.autopilot.interface import Ack, Answer, Command, Severity

_ACCEPTED = orders.ACCEPTED
_UNITS = {0: "gyro", 1: "accel", 2: "mag", 3: "baro", 4: "fix", 100: "battery"}
"""FAILURE_UNIT."""
_CALIBRATIONS = {
    (0, 1.0): "gyro",
    (1, 1.0): "mag",
    (2, 1.0): "baro",
    (3, 1.0): "accel",
    (3, 2.0): "level",
    (3, 4.0): "accel",
}
"""Which of params 1, 2, 3 and 5 of PREFLIGHT_CALIBRATION has which value, and what PX4 calls it."""


def _arm(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """COMPONENT_ARM_DISARM."""
    now, (wish, magic, _, _) = conduct.now, command.params
    if wish not in (0.0, 1.0):
        return Answer(Ack.DENIED, "Arming refused: param 1 must be 0 or 1")
    if wish == 1.0:
        return conduct.arm(now_s, magic == FORCE)
    if now.flying and magic != FORCE:
        return Answer(now.row.refused, "Disarming refused: it is not on the ground")
    if now.armed:
        conduct.disarm("Killed" if now.flying else "Disarmed", now_s)
    return _ACCEPTED


def _check(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """RUN_PREARM_CHECKS: every reason against arming is said."""
    if conduct.now.armed:
        return Answer(Ack.TEMPORARILY_REJECTED, "Checks refused: it is armed")
    for reason in reasons(conduct.now, conduct.failsafes.watch):
        conduct.now.say(Severity.WARNING, f"PreArm: {reason}")
    return _ACCEPTED


def _mode(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_SET_MODE: params 1 base mode, 2 and 3 the firmware's own mode and sub mode."""
    base, main, sub, _ = (0.0 if math.isnan(param) else param for param in command.params)
    if not all(0 <= part <= 255 and part == int(part) for part in (base, main, sub)):
        return Answer(Ack.DENIED, "Mode change refused: its numbers make no sense")
    px4 = conduct.now.row.name == "px4"
    return conduct.set_mode(int(base), int(main) << 16 | int(sub) << 24 if px4 else int(main), now_s)


def _speed(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_CHANGE_SPEED: params 1 which (0 air, 1 ground), 2 m/s, negative for the parameter's."""
    kind, speed, _, _ = command.params
    if kind not in (0.0, 1.0):
        return Answer(Ack.DENIED, "Speed refused: only the ground speed can be changed")
    if not (0.0 < speed <= 20.0 or speed in (-1.0, -2.0)):
        return Answer(Ack.DENIED, f"Speed refused: {speed:g} m/s")
    conduct.now.speed_mps = speed if speed > 0.0 else None
    return _ACCEPTED


def _home(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_SET_HOME: param 1 is 1 for here."""
    now = conduct.now
    if command.params[0] == 1.0:
        if not now.located:
            return Answer(now.row.refused, "Home refused: it needs a position estimate")
        conduct.home_here()
        now.home_kept = True
        return _ACCEPTED
    found = orders.named_place(now, command, "Home")
    if isinstance(found, Answer):
        return found
    now.home_ned_m, now.home_kept = found, True
    return _ACCEPTED


def _region(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_SET_ROI_LOCATION and DO_SET_ROI. Where it is itself, which NaN means elsewhere, it cannot look."""
    now = conduct.now
    if math.isnan(command.x) or math.isnan(command.y):
        return Answer(Ack.DENIED, "Region of interest refused: it needs a place")
    found = orders.named_place(now, command, "Region of interest")
    if isinstance(found, Answer):
        return found
    now.region_ned_m = found
    return _ACCEPTED


def _region_by_mode(conduct: Conduct, command: Command, now_s: float) -> Answer:
    if command.params[0] == 0.0 and command.x == command.y == command.z == 0.0:
        return _no_region(conduct, command, now_s)
    return _region(conduct, command, now_s)


def _no_region(conduct: Conduct, command: Command, now_s: float) -> Answer:
    conduct.now.region_ned_m = None
    return _ACCEPTED


def _terminate(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_FLIGHTTERMINATION."""
    if not command.params[0] > 0.5:
        return Answer(Ack.DENIED)
    if conduct.now.armed:
        conduct.disarm("Flight terminated", now_s)
    return _ACCEPTED


def _calibrate(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """PREFLIGHT_CALIBRATION: there is nothing to be found out, so it is done at once. All zeros call one off."""
    now = conduct.now
    if now.armed:
        return Answer(now.row.refused, "Calibration refused: disarm first")
    asked = (*command.params[:3], command.x)
    something = any(value and not math.isnan(value) for value in (*command.params, command.x))
    if now.row.name == "ardupilot":
        now.say(Severity.INFO, "Calibration successful")
    elif something:
        name = next((name for which, name in _CALIBRATIONS.items() if asked[which[0]] == which[1]), None)
        if name is None:
            return Answer(Ack.UNSUPPORTED)
        # Ground stations wait for these very words.
        for words in (f"calibration started: 2 {name}", "progress <0>", "progress <100>", f"calibration done: {name}"):
            now.say(Severity.INFO, f"[cal] {words}")
    return _ACCEPTED


def _reboot(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """PREFLIGHT_REBOOT_SHUTDOWN: parameters and plans stay, all else begins anew."""
    if conduct.now.armed:
        return Answer(conduct.now.row.refused, "Reboot refused: disarm first")
    if command.params[0] not in (0.0, 1.0):
        return Answer(Ack.DENIED, "Only a reboot is possible (param 1 is 1): the simulator is ended from outside")
    if command.params[0] == 1.0:
        conduct.reboot(now_s)
        for name in _UNITS.values():
            conduct.vehicle.fail(name, True)
    return _ACCEPTED


def _fail(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """INJECT_FAILURE: params 1 unit, 2 kind (0 mended, 1 off)."""
    if not conduct.now.params.get("SYS_FAILURE_EN", 1.0):
        return Answer(Ack.DENIED, "Failure injection refused: SYS_FAILURE_EN is 0")
    unit, kind, _, _ = command.params
    name = _UNITS.get(int(unit)) if math.isfinite(unit) and unit == int(unit) else None
    if name is None or kind not in (0.0, 1.0):
        return Answer(Ack.UNSUPPORTED)
    conduct.vehicle.fail(name, kind == 0.0)
    return _ACCEPTED


def _fence(conduct: Conduct, command: Command, now_s: float) -> Answer:
    """DO_FENCE_ENABLE, where a parameter does the same."""
    params = conduct.now.params
    if not params.has("FENCE_ENABLE"):
        return Answer(Ack.UNSUPPORTED)
    if command.params[0] not in (0.0, 1.0):
        return Answer(Ack.DENIED)
    params.put("FENCE_ENABLE", command.params[0])
    return _ACCEPTED


COMMANDS: dict[int, Callable[[Conduct, Command, float], Answer]] = {
    20: orders.come_home,
    21: orders.land,
    22: orders.take_off,
    34: orders.orbit,
    93: orders.wait,
    115: orders.turn,
    176: _mode,
    178: _speed,
    179: _home,
    185: _terminate,
    192: orders.go,
    193: orders.pause,
    195: _region,
    197: _no_region,
    201: _region_by_mode,
    207: _fence,
    241: _calibrate,
    246: _reboot,
    252: orders.override,
    300: orders.start_mission,
    400: _arm,
    401: _check,
    420: _fail,
}
