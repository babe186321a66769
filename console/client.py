"""A terminal's own session with the mesh: ask, listen, see who is there."""

import secrets
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Literal, Self, TypeVar

from wire.bus import Event, Presence, Received, Reply
from wire.link import MeshError
from wire.model import Message
from wire.node import ZenohNode, node_for
from wire.site import Site

M = TypeVar("M", bound=Message)
ClientError = MeshError
_PATIENCE_S = 20.0
"""A simulated mesh on a busy machine moves on slowly; a terminal can wait for it."""
_BETWEEN_TRIES_S = 1.0
_QUIET_S = 2.0
"""Without news for this long, a waiting command asks again: a publication may have been missed."""


class Client:
    """One session under the user `console` or `evaluator`, as a context manager."""

    def __init__(
        self,
        site: Site,
        credentials: Path,
        role: Literal["console", "evaluator"] = "console",
        timeout_s: float = 5.0,
    ) -> None:
        self._node: ZenohNode = node_for(site, f"{role}-{secrets.token_hex(3)}", role, timeout_s, credentials)
        self._handlers: dict[str, Callable[[Message], None]] = {}
        self._heard: list[Message] = []

    def __enter__(self) -> Self:
        self._node.__enter__()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._node.__exit__(kind, error, at)

    def listen(self, topic: str, id: str | None = None) -> None:
        """Keep what comes on a topic for `messages`."""
        self._node.subscribe(topic, id)

    def on(self, topic: str, message: type[M], handler: Callable[[M], None]) -> None:
        """Have every message of a topic handled while this client waits for something."""

        def handle(received: Message) -> None:
            if isinstance(received, message):
                handler(received)

        self._handlers[topic] = handle
        self._node.subscribe(topic)

    def ask(self, service: str, request: Message, reply: type[M], id: str = "", tries: int = 3) -> M:
        """Ask and wait. Requests are idempotent, so that a lost answer is asked for again. Raises ClientError."""
        error = ""
        for attempt in range(tries):
            if attempt:
                self._linger(_BETWEEN_TRIES_S)
            answer = self._answer(self._node.ask(service, request, id, _PATIENCE_S))
            if isinstance(answer.message, reply):
                return answer.message
            error = answer.error
        raise ClientError(f"{service}: {error or 'no answer'}; `justw status` tells which processes run")

    def _answer(self, number: int) -> Reply:
        while True:
            for event in self._collect():
                if isinstance(event, Reply) and event.ask == number:
                    return event

    def _linger(self, seconds: float) -> None:
        """Go on listening for a while: a process that was just restarted is not there at once."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            self._collect()

    def messages(self, kind: type[M], limit_s: float, first: M, poll: Callable[[], M]) -> Iterator[M]:
        """`first`, then every message of this kind as it comes, polled for when it is quiet, until `limit_s`."""
        yield first
        deadline = time.monotonic() + limit_s
        heard_at = time.monotonic()
        while time.monotonic() < deadline:
            self._collect()
            news = [m for m in self._heard if isinstance(m, kind)]
            self._heard.clear()
            if news:
                heard_at = time.monotonic()
                yield from news
            elif time.monotonic() - heard_at > _QUIET_S:
                heard_at = time.monotonic()
                yield poll()

    def present(self, listen_s: float = 0.3) -> set[str]:
        """Processes whose liveliness tokens are there now."""
        self._node.watch_presence()
        here: set[str] = set()
        deadline = time.monotonic() + listen_s
        while time.monotonic() < deadline:
            here = self.update_presence(here)
        return here

    def update_presence(self, here: set[str]) -> set[str]:
        """`here` with the comings and goings that were heard since."""
        for event in self._collect():
            if isinstance(event, Presence):
                here = here | {event.process} if event.alive else here - {event.process}
        return here

    def _collect(self) -> list[Event]:
        events = self._node.collect(0.05)
        for event in events:
            if isinstance(event, Received):
                handler = self._handlers.get(event.topic)
                if handler is not None:
                    handler(event.message)
                else:
                    self._heard.append(event.message)
        return events


def presence(site: Site, credentials: Path) -> set[str]:
    """Who is on the mesh. Raises ClientError when the router cannot be reached."""
    with Client(site, credentials, timeout_s=1.0) as client:
        return client.present()
