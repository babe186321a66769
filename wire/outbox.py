"""What a process says, until it leaves: by the wall clock at once, in lockstep with the tick or the answer to it.

The ways to the router are declared, so that it tells who listens: what nobody hears stays in this process.
"""

from collections.abc import Callable
from typing import Any

from wire.codec import encode
from wire.keys import Role, Topic
from wire.letter import write_stamp
from wire.messages.clock import MOST_WAKES
from wire.model import Message
from wire.paths import topic_for

BIG_BYTES = 20_000
CLOCK_TOPICS = frozenset(("turn", "tick", "tick_done"))
"""Their messages wake the loop in lockstep; all others lie ready until then."""
UNSURE_TICKS = 100
"""So long after a topic was first published on, all that follow the clock have had a turn, and the router its say."""

Declare = Callable[[Topic, str, bool], Any]
"""(topic, id, whether every message must arrive) -> Zenoh's publisher for that key"""


class Outbox:
    """In lockstep nothing is dropped: a picture that is lost in one run and not in the next made the two differ."""

    def __init__(self, sender: str, role: Role, lockstep: bool, declare: Declare) -> None:
        self._sender, self._lockstep, self._declare = sender, lockstep, declare
        self._role: Role = role
        self._seq = 0
        self._ways: dict[tuple[str, str], tuple[Topic, Any, int]] = {}
        """Topic, publisher, and the tick in which it was declared."""
        self._unsent: list[tuple[Any, bytes, bytes]] = []
        self._wakes: set[str] = set()

    def stamp(self, tick: int) -> bytes:
        """For the next thing said."""
        self._seq += 1
        return write_stamp(tick, self._seq, self._sender)

    def publish(self, topic: str, message: Message, id: str, tick: int) -> None:
        row, way, since = self._ways.get((topic, id)) or self._way(topic, id, tick)
        if not isinstance(message, row.message):
            raise TypeError(f"{topic} carries {row.message.__name__}, not {type(message).__name__}")
        if self._lockstep and tick > since + UNSURE_TICKS and not way.matching_status.matching:
            return  # not even the bytes are made
        payload, stamp = encode(message), self.stamp(tick)
        if not self._lockstep:
            way.put(payload, attachment=stamp)
            return
        self._unsent.append((way, payload, stamp))
        if topic in CLOCK_TOPICS or len(payload) > BIG_BYTES:
            self.flush()

    def wake(self, name: str) -> None:
        """This process, or those of this role, were asked something or answered."""
        self._wakes.add(name)

    def take_wakes(self) -> tuple[str, ...]:
        """The names since the last call; strangers may have asked under more than anybody here has."""
        wakes, self._wakes = sorted(self._wakes), set()
        return tuple(wakes[:MOST_WAKES])

    def flush(self) -> None:
        """Send what was published in lockstep."""
        unsent, self._unsent = self._unsent, []
        for way, payload, stamp in unsent:
            way.put(payload, attachment=stamp)

    def _way(self, topic: str, id: str, tick: int) -> tuple[Topic, Any, int]:
        row = topic_for(topic, self._role, publishing=True)
        way = self._declare(row, id, self._lockstep or row.delivery == "every")
        return self._ways.setdefault((topic, id), (row, way, tick))
