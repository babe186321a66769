"""The parameter protocol: list at a bounded pace, read by name or index, set, and refuse in words."""

import math
from collections import deque

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Param
from sim.mavlink.craft import Craft, Sender
from sim.mavlink.pack import bits_int, int_bits, single
from sim.mavlink.peer import Message, Peer

PER_SECOND = 400
"""Values sent to each peer that has asked for the list."""
NO_INDEX = 0xFFFF
INT_TYPES = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i"}
"""MAV_PARAM_TYPE of whole numbers of up to 32 bits, and struct's letters of them."""


class Params:
    """One vehicle's parameters on the wire."""

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self._lists: dict[Peer, deque[int]] = {}
        self._last_s = 0.0

    def _value(self, param: Param, index: int, count: int) -> Message:
        if not param.integer:
            kind, value = mav.MAV_PARAM_TYPE_REAL32, single(param.value)
        else:
            kind = mav.MAV_PARAM_TYPE_INT32
            bytewise = self._craft.personality.param_encoding == "bytewise"
            value = int_bits(round(param.value)) if bytewise else float(param.value)
        return mav.MAVLink_param_value_message(param.name.encode("ascii")[:16], value, kind, count, index)

    def list(self, message: Message, sender: Sender, now_s: float) -> None:
        """PARAM_REQUEST_LIST: a second one starts over."""
        self._lists[sender.peer] = deque(range(len(self._craft.autopilot.params())))

    def step(self, now_s: float) -> None:
        """Send what the pace allows, and what the autopilot itself changed."""
        elapsed_s = min(max(now_s - self._last_s, 0.0), 0.1)
        allowed = max(round(elapsed_s * PER_SECOND), 1)
        changed = self._craft.autopilot.changed_params()
        if not self._lists and not changed:
            self._last_s = now_s
            return
        if elapsed_s * PER_SECOND < 1 and not changed:
            return
        self._last_s = now_s
        params = self._craft.autopilot.params()
        listening = set(self._craft.peers())
        for peer in [each for each in self._lists if each not in listening]:
            del self._lists[peer]
        for peer, waiting in list(self._lists.items()):
            for _ in range(min(allowed, len(waiting))):
                index = waiting.popleft()
                peer.send(self._value(params[index], index, len(params)), self._craft.sysid, 1)
            if not waiting:
                del self._lists[peer]
        names = {param.name: index for index, param in enumerate(params)}
        for param in changed:
            self._craft.broadcast(self._value(param, names[param.name], len(params)))

    def _find(self, name: str, index: int) -> int | None:
        params = self._craft.autopilot.params()
        if index >= 0:
            return index if index < len(params) else None
        return next((i for i, param in enumerate(params) if param.name == name), None)

    def _error(self, name: str, index: int, error: int, sender: Sender) -> None:
        raw = name.encode("ascii", "replace")[:16]
        self._craft.reply(sender, mav.MAVLink_param_error_message(sender.sysid, sender.compid, raw, index, error))

    def read(self, message: Message, sender: Sender, now_s: float) -> None:
        """PARAM_REQUEST_READ by index, or by name when the index is -1."""
        index = self._find(message.param_id, message.param_index)
        if index is None:
            self._error(message.param_id, message.param_index, mav.MAV_PARAM_ERROR_DOES_NOT_EXIST, sender)
            return
        params = self._craft.autopilot.params()
        self._craft.reply(sender, self._value(params[index], index, len(params)))

    def set(self, message: Message, sender: Sender, now_s: float) -> None:
        """PARAM_SET: the value as it now is goes to everybody, also when it is still the old one."""
        index = self._find(message.param_id, -1)
        if index is None:
            self._error(message.param_id, -1, mav.MAV_PARAM_ERROR_DOES_NOT_EXIST, sender)
            return
        param = self._craft.autopilot.params()[index]
        value = self._decoded(message, param)
        if value is None:
            answer: Param | str = (
                f"{param.name} is set with type {6 if param.integer else 9}, not {message.param_type}."
            )
        elif not math.isfinite(value):
            answer = f"{param.name}: the value is not a finite number."
        else:
            answer = self._craft.autopilot.set_param(param.name, value)
        params = self._craft.autopilot.params()
        if isinstance(answer, str):
            self._craft.complain(answer, now_s)
            error = mav.MAV_PARAM_ERROR_READ_ONLY if param.read_only else mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE
            self._error(param.name, index, error, sender)
            answer = params[index]
        self._craft.broadcast(self._value(answer, index, len(params)))

    def _decoded(self, message: Message, param: Param) -> float | None:
        value = float(message.param_value)
        if self._craft.personality.param_encoding == "cast":
            return value
        kind = INT_TYPES.get(message.param_type)
        if (kind is not None) != param.integer:  # PX4 writes nothing then
            return None
        if kind is not None:
            return float(bits_int(value, kind))
        return value if message.param_type == mav.MAV_PARAM_TYPE_REAL32 else None
