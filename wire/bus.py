"""What a process sees of the mesh: events in, messages out. Implemented over Zenoh (`wire.node`) and in memory
(`wire.loopback`); everything else is written against these protocols.

In lockstep every message carries the tick in which it was sent. At tick n a process is handed, sorted, what the
clock's owner sent up to tick n and what everybody else sent before tick n: the same events in every run.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from wire.model import Message


@dataclass(frozen=True)
class Received:
    """A message on a subscribed topic."""

    topic: str
    id: str
    """The `{id}` of its key; empty where the topic has none."""
    message: Message


@dataclass(frozen=True)
class Request:
    """Somebody asks a service that this process serves. Answer exactly once."""

    service: str
    id: str
    message: Message
    reply: Callable[[Message], None]


@dataclass(frozen=True)
class Reply:
    """The answer to an earlier `ask`. No answer in time means unknown, never 'not done'."""

    ask: int
    service: str
    id: str
    message: Message | None
    error: str = ""


@dataclass(frozen=True)
class Presence:
    """A process came (its liveliness token was seen) or went."""

    process: str
    alive: bool


class CannotRun(Exception):
    """A core, or its building, cannot go on; the text is one sentence with the remedy. Its process exits with 1,
    and is restarted: it may be better by then."""


Event = Received | Request | Reply | Presence


class Node(Protocol):
    """One process's single session. Names are those of the tables in `wire.keys`."""

    @property
    def id(self) -> str: ...

    @property
    def boot_id(self) -> str:
        """Another one after every restart of the process (`wire.clock.boot_id`); known from the first step on."""

    def subscribe(self, topic: str, id: str | None = None) -> None:
        """Receive a topic; of one device, or of all when `id` is None."""

    def serve(self, service: str, id: str = "") -> None:
        """Requests for this service arrive as `Request` events."""

    def watch_presence(self) -> None:
        """Receive a `Presence` event for every process that is there, comes or goes."""

    def publish(self, topic: str, message: Message, id: str = "") -> None:
        """Send. Raises nothing when nobody listens."""

    def ask(self, service: str, request: Message, id: str = "", timeout_s: float | None = None) -> int:
        """Send a request and return its number at once; the `Reply` comes as an event."""


class Core(Protocol):
    """A process without its shell: handed the time and what happened, it publishes through its node.

    It never waits, reads no clock, opens no session; files only through objects it was given.
    """

    def start(self, node: Node) -> None:
        """Subscribe and serve. Called once, before the first step."""

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        """Handle the events and do what is due at `now_s`."""

    def stop(self) -> None:
        """Release what `start` took."""


@runtime_checkable
class Resting(Protocol):
    """What a core may say besides, so that lockstep goes on without it while it has nothing to do."""

    def rests_until_s(self) -> float:
        """Seconds on the mesh's clock, as of the last step: what comes until then can wait until then. A time that is
        past asks for every tick, and no rest is longer than `wire.clock.LONGEST_REST_S`."""
