"""One vehicle on the wire: its autopilot, its ids, and to whom it speaks."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Autopilot, Severity
from sim.autopilot.personality import Personality
from sim.mavlink.peer import Message, Peer

AUTOPILOT = 1
"""MAV_COMP_ID_AUTOPILOT1."""
RESTING_US = (1500, 1500, 1000, 1500)
OVERRIDE_S = 3.0
"""So long sticks that were overridden count."""
TEXT_BYTES = 50
TEXT_EVERY_S = 1.0
"""The same text, said because of somebody's input, is not said again sooner."""
MAX_REMEMBERED = 64


@dataclass(frozen=True, slots=True)
class Sender:
    """Who sent a message, and by which peer an answer reaches them."""

    peer: Peer
    sysid: int
    compid: int


@dataclass(slots=True)
class Craft:
    """`peers` lists whoever listens now; `capture` takes a picture and says whether there is one."""

    autopilot: Autopilot
    personality: Personality
    peers: Callable[[], list[Peer]]
    unix_s: float = 0.0
    """Wall time at now_s = 0."""
    capture: Callable[[], bool] = lambda: True
    camera: bool = True
    """Whether a camera and a gimbal show themselves as components; dronekit takes any heartbeat for the autopilot's.
    Missions use them all the same."""
    home_asked: bool = False
    pulses_us: tuple[int, int, int, int] = RESTING_US
    """What roll, pitch, throttle and yaw were overridden with last."""
    pulses_s: float = -math.inf
    """When that was."""
    last_reached: int | None = None
    """The mission item reached last."""
    _said: dict[str, float] = field(default_factory=dict)
    _texts: count = field(default_factory=lambda: count(1))  # type: ignore[type-arg]

    @property
    def sysid(self) -> int:
        return self.autopilot.sysid

    def sticks_us(self, now_s: float) -> tuple[int, int, int, int]:
        """As a receiver has them."""
        return self.pulses_us if now_s - self.pulses_s < OVERRIDE_S else RESTING_US

    def reply(self, to: Sender, message: Message, compid: int = AUTOPILOT) -> None:
        to.peer.send(message, self.sysid, compid)

    def broadcast(self, message: Message, compid: int = AUTOPILOT) -> None:
        for peer in self.peers():
            peer.send(message, self.sysid, compid)

    def say(self, severity: Severity, text: str) -> None:
        """A status text to everybody, in chunks when it is long."""
        for message in self.texts(severity, text):
            self.broadcast(message)

    def texts(self, severity: Severity, text: str) -> list[Message]:
        raw = text.encode("ascii", "replace")[: TEXT_BYTES * 5]
        if len(raw) <= TEXT_BYTES:
            return [mav.MAVLink_statustext_message(int(severity), raw)]
        number = next(self._texts) % 65535 + 1
        chunks = [raw[start : start + TEXT_BYTES] for start in range(0, len(raw), TEXT_BYTES)]
        if len(chunks[-1]) == TEXT_BYTES:
            chunks.append(b"")
        return [mav.MAVLink_statustext_message(int(severity), part, number, i) for i, part in enumerate(chunks)]

    def complain(self, text: str, now_s: float) -> None:
        """Say what was wrong with an input, but not over and over."""
        if now_s - self._said.get(text, -TEXT_EVERY_S) >= TEXT_EVERY_S:
            if len(self._said) >= MAX_REMEMBERED:
                self._said.clear()
            self._said[text] = now_s
            self.say(Severity.WARNING, text)
