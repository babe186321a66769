"""What can go wrong in flight and what each firmware's parameters say to do about it."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

from sim.autopilot.situation import Situation


class Action(IntEnum):
    """What a failsafe does; the more severe one wins."""

    NONE = 0
    WARN = 1
    HOLD = 2
    RETURN = 3
    LAND = 4
    TERMINATE = 5


@dataclass(frozen=True, slots=True)
class Alarm:
    name: str
    action: Action
    text: str
    patient: bool = False
    """PX4 hovers for a while before it acts."""


@dataclass(slots=True)
class Watch:
    """What the alarms are told by from one look to the next."""

    station_s: float | None = None
    """When a ground station was last heard; None: never in this flight."""
    setpoint_s: float = -math.inf
    low_since_s: float | None = None
    critical_since_s: float | None = None
    lost_since_s: float | None = None
    low: bool = False
    """Battery levels stay once they are reached in a flight."""
    critical: bool = False
    emergency: bool = False
    breach: str = ""
    breaches: int = 0
    breached_s: float = 0.0

    def fence(self, breach: str, now_s: float) -> None:
        """What of the fence is crossed at this moment, or nothing."""
        if breach and not self.breach:
            self.breaches, self.breached_s = self.breaches + 1, now_s
        self.breach = breach


_N, _W, _H, _R, _L, _T = Action
ARDUPILOT_BATTERY = (_W, _L, _R, _R, _R, _T, _R, _H)
ARDUPILOT_FENCE = (_W, _R, _L, _R, _H, _R)
ARDUPILOT_STATION = (_N, _R, _R, _R, _R, _L, _R, _H)
PX4_FENCE = (_N, _W, _H, _R, _T, _L)
PX4_SETPOINT = (_H, _H, _H, _R, _L, _H, _T, _T)
PX4_STATION = (_N, _H, _R, _L, _N, _T, _T)
"""By the value of the parameter."""
_ESTIMATOR_S = 1.0


def alarms(now: Situation, watch: Watch, now_s: float) -> Iterator[Alarm]:
    """All that is wrong at this moment."""
    _look_at_battery(now, watch, now_s)
    yield from (_ardupilot if now.row.name == "ardupilot" else _px4)(now, watch, now_s)


def station_timeout_s(now: Situation) -> float:
    return now.params.get("FS_GCS_TIMEOUT" if now.row.name == "ardupilot" else "COM_DL_LOSS_T")


def _ardupilot(now: Situation, watch: Watch, now_s: float) -> Iterator[Alarm]:
    get = now.params.get
    if watch.station_s is not None and now_s - watch.station_s > get("FS_GCS_TIMEOUT"):
        choice = int(get("FS_GCS_ENABLE"))
        action = Action.NONE if choice == 2 and now.mode == "mission" else ARDUPILOT_STATION[choice]
        yield Alarm("station", action, "GCS Failsafe: no heartbeat of a ground station")
    if watch.low:
        yield Alarm("battery low", ARDUPILOT_BATTERY[int(get("BATT_FS_LOW_ACT"))], "Battery 1 is low")
    if watch.critical:
        yield Alarm("battery critical", ARDUPILOT_BATTERY[int(get("BATT_FS_CRT_ACT"))], "Battery 1 is critical")
    if watch.breach:
        yield Alarm("fence", ARDUPILOT_FENCE[int(get("FENCE_ACTION"))], f"Fence breached: {watch.breach}")
    if _lost(now, watch, now_s, _ESTIMATOR_S):
        choice = int(get("FS_EKF_ACTION"))
        piloted = now.mode == "stabilize" and choice != 3
        action = Action.WARN if piloted else (Action.WARN, Action.LAND, Action.HOLD, Action.LAND)[choice]
        yield Alarm("estimator", action, "EKF Failsafe: position estimate lost")


def _px4(now: Situation, watch: Watch, now_s: float) -> Iterator[Alarm]:
    get = now.params.get
    if watch.station_s is not None and now_s - watch.station_s > get("COM_DL_LOSS_T"):
        action = PX4_STATION[int(get("NAV_DLL_ACT"))]
        yield Alarm("station", action, "Connection to ground station lost", patient=True)
    if now.mode == "offboard" and now.armed and now_s - watch.setpoint_s > get("COM_OF_LOSS_T"):
        yield Alarm("setpoint", PX4_SETPOINT[int(get("COM_OBL_RC_ACT"))], "No offboard signal")
    choice = int(get("COM_LOW_BAT_ACT"))
    if watch.low:
        yield Alarm("battery low", Action.WARN, "Low battery level")
    if watch.critical:
        action = {2: Action.LAND, 3: Action.RETURN}.get(choice, Action.WARN)
        yield Alarm("battery critical", action, "Critical battery level", patient=True)
    if watch.emergency:
        yield Alarm("battery emergency", Action.LAND if choice >= 2 else Action.WARN, "Emergency battery level")
    if watch.breach:
        yield Alarm("fence", PX4_FENCE[int(get("GF_ACTION"))], f"Geofence violation: {watch.breach}")
    if _lost(now, watch, now_s, get("COM_POS_FS_DELAY")):
        action = Action.WARN if now.mode == "stabilize" else Action.LAND
        yield Alarm("estimator", action, "Position estimate lost")


def _look_at_battery(now: Situation, watch: Watch, now_s: float) -> None:
    get, battery = now.params.get, now.vehicle.battery
    if now.row.name == "ardupilot":
        span_s = get("BATT_LOW_TIMER")
        watch.low_since_s = _since(battery.voltage_v < get("BATT_LOW_VOLT"), watch.low_since_s, now_s)
        watch.critical_since_s = _since(battery.voltage_v < get("BATT_CRT_VOLT"), watch.critical_since_s, now_s)
        low = watch.low_since_s is not None and now_s - watch.low_since_s >= span_s
        critical = watch.critical_since_s is not None and now_s - watch.critical_since_s >= span_s
        emergency = False
    else:
        low = battery.remaining < get("BAT_LOW_THR")
        critical = battery.remaining < get("BAT_CRIT_THR")
        emergency = battery.remaining < get("BAT_EMERGEN_THR")
    stays = now.armed
    watch.low = low or (stays and watch.low)
    watch.critical = critical or (stays and watch.critical)
    watch.emergency = emergency or (stays and watch.emergency)


def _lost(now: Situation, watch: Watch, now_s: float, span_s: float) -> bool:
    watch.lost_since_s = _since(now.armed and not now.located, watch.lost_since_s, now_s)
    return watch.lost_since_s is not None and now_s - watch.lost_since_s >= span_s


def _since(holds: bool, since_s: float | None, now_s: float) -> float | None:
    if not holds:
        return None
    return now_s if since_s is None else since_s
