"""What goes out by itself and how often: every message that can be asked for, and each peer's rates of them."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

from sim.autopilot.interface import Telemetry
from sim.mavlink import modes, motion, newer, status
from sim.mavlink.craft import Craft
from sim.mavlink.peer import Message

Builder = Callable[[Craft, Telemetry], Message | None]
FASTEST_S = 1 / 200
MAX_INTERVAL_US = 2**31 - 1


class Row(NamedTuple):
    """One message: its builder, its usual rate, and which legacy stream (MAV_DATA_STREAM) it belongs to."""

    build: Builder
    rate_hz: float
    group: int = 0
    estimate: bool = False
    """Made of the estimate: left out while that is not all numbers."""


RAW, STATUS, CHANNELS, CONTROLLER, POSITION, EXTRA1, EXTRA2, EXTRA3 = 1, 2, 3, 4, 6, 10, 11, 12
ALL_GROUPS = 0

MESSAGES: dict[int, Row] = {
    0: Row(status.heartbeat, 1),
    1: Row(status.system, 2, STATUS),
    2: Row(status.clock, 1, EXTRA3),
    24: Row(motion.gps_raw, 5, STATUS),
    26: Row(status.imu, 4, RAW),
    27: Row(status.raw_imu, 4, RAW),
    29: Row(status.pressure, 4, RAW),
    30: Row(motion.attitude, 20, EXTRA1, estimate=True),
    31: Row(motion.attitude_quaternion, 20, EXTRA1, estimate=True),
    32: Row(motion.local_position, 20, POSITION, estimate=True),
    33: Row(motion.global_position, 10, POSITION, estimate=True),
    35: Row(status.rc_raw, 2, CHANNELS),
    36: Row(status.servos, 2, CHANNELS),
    42: Row(status.mission, 1, STATUS),
    49: Row(motion.origin, 0),
    62: Row(motion.navigation, 2, STATUS, estimate=True),
    65: Row(status.rc, 2, CHANNELS),
    74: Row(motion.vfr_hud, 5, EXTRA2, estimate=True),
    85: Row(motion.target, 2, POSITION),
    105: Row(status.highres_imu, 10, RAW),
    141: Row(motion.altitude, 5, EXTRA2, estimate=True),
    147: Row(status.battery, 1, EXTRA3),
    148: Row(status.version, 0),
    162: Row(status.fence, 1, STATUS),
    193: Row(status.ekf, 2, EXTRA3),
    230: Row(status.estimator, 1, EXTRA3),
    241: Row(status.vibration, 1, EXTRA3),
    242: Row(motion.home, 0.5),
    245: Row(status.extended, 2, STATUS),
    264: Row(status.flight, 0),
    newer.PROTOCOL_VERSION: Row(modes.version, 0),
    331: Row(motion.odometry, 10, POSITION, estimate=True),
    newer.CURRENT_MODE: Row(modes.current, 0.5),
    newer.MODES_MONITOR: Row(modes.monitor, 0.3),
}
OF_LISTED_MODES = (newer.CURRENT_MODE, newer.MODES_MONITOR)
ESTIMATORS = {"EKF_STATUS_REPORT": 193, "ESTIMATOR_STATUS": 230}
HOME, VERSION, CURRENT_MISSION = 242, 148, 42


def has(craft: Craft, message_id: int) -> bool:
    """Whether this firmware has such a message."""
    return message_id in MESSAGES and (bool(craft.personality.listed) or message_id not in OF_LISTED_MODES)


def usual_rate_hz(craft: Craft, message_id: int) -> float:
    """How often this firmware sends it when nobody asks otherwise."""
    if not has(craft, message_id):
        return 0.0
    if message_id in ESTIMATORS.values() and ESTIMATORS[craft.personality.estimator_message] != message_id:
        return 0.0
    if message_id == HOME and craft.personality.home_streams == "asked" and not craft.home_asked:
        return 0.0
    return MESSAGES[message_id].rate_hz


def build(craft: Craft, message_id: int, now: Telemetry) -> Message | None:
    """The message as of now; None while there is nothing true to say."""
    row = MESSAGES[message_id]
    if row.estimate and not motion.usable(now):
        return None
    return row.build(craft, now)


@dataclass(slots=True)
class Rates:
    """One peer's intervals of one vehicle's messages; what it has not asked for comes at the usual rate."""

    craft: Craft
    asked_s: dict[int, float] = field(default_factory=dict)
    """Seconds between two; inf for never."""
    _due_s: dict[int, float] = field(default_factory=dict)
    _next_s: float = -math.inf

    def interval_s(self, message_id: int) -> float:
        asked = self.asked_s.get(message_id)
        if asked is not None:
            return asked
        rate = usual_rate_hz(self.craft, message_id)
        return 1 / rate if rate > 0 else math.inf

    def ask(self, message_id: int, interval_us: float) -> bool:
        """SET_MESSAGE_INTERVAL: microseconds, 0 for the usual rate, -1 for none. False for what cannot be sent."""
        if not has(self.craft, message_id) or not -1 <= interval_us <= MAX_INTERVAL_US:
            return False
        if interval_us == 0:
            self.asked_s.pop(message_id, None)
        else:
            self.asked_s[message_id] = math.inf if interval_us < 0 else max(interval_us / 1e6, FASTEST_S)
        self._due_s.pop(message_id, None)
        self._next_s = -math.inf
        return True

    def ask_group(self, group: int, rate_hz: int, start: bool) -> None:
        """REQUEST_DATA_STREAM: group 0 is all of them; stopping all leaves the heartbeat."""
        for message_id, row in MESSAGES.items():
            if row.group and group in (ALL_GROUPS, row.group) and usual_rate_hz(self.craft, message_id):
                self.ask(message_id, 1e6 / rate_hz if start and rate_hz > 0 else -1)

    def due(self, now_s: float) -> list[int]:
        """The messages whose time has come; a message late by more than its interval is not sent twice."""
        if now_s < self._next_s:
            return []
        out = []
        self._next_s = now_s + 1.0
        for message_id in MESSAGES:
            at_s = self._due_s.get(message_id, now_s)
            if now_s >= at_s:
                interval_s = self.interval_s(message_id)
                if math.isinf(interval_s):
                    continue
                out.append(message_id)
                at_s = at_s + interval_s if at_s + interval_s > now_s else now_s + interval_s
                self._due_s[message_id] = at_s
            self._next_s = min(self._next_s, at_s)
        return out
