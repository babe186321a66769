"""A process's single session with the mesh over Zenoh. Callbacks only file letters; the loop opens them."""

import json
import os
import sys
import time
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import zenoh

from wire.bus import Event, Reply
from wire.codec import encode, max_bytes
from wire.inbox import Inbox
from wire.keys import PRESENCE_PATH, Role, Service, Topic
from wire.letter import NO_TICK, Kind, Letter, refuse_query, reply_letter, stamp_of
from wire.link import LEAN_RUNTIME, Link, MeshError, client_config, link_for
from wire.mailbox import Mailbox
from wire.model import Message
from wire.outbox import CLOCK_TOPICS, Outbox
from wire.paths import id_in, key, pattern, service_for, topic_for
from wire.shelf import Shelf
from wire.site import Site

LETTERS_AT_ONCE = 100
"""A step handles no more than this, so that a flood leaves time for what is due."""
SWITCH_S = 0.0005
"""A busy loop lets a callback in this often; at Python's own 5 ms the router would think that nobody reads."""
FETCHED_AT_ONCE = 65_536
"""So many messages of one subscription may lie ready until they are fetched; then the link is held back."""
_REMOTE = zenoh.Locality.REMOTE
RECOUNT_S = 2.0
"""How long the router may take to say who is there."""
_BLOCK, _DROP = zenoh.CongestionControl.BLOCK, zenoh.CongestionControl.DROP


def open_session(config: dict[str, Any], runtime: str = "") -> zenoh.Session:
    """The one place where sessions are opened; `runtime` is for the first of a process."""
    if runtime:
        os.environ.setdefault("ZENOH_RUNTIME", runtime)
    zenoh.try_init_log_from_env()  # silent unless RUST_LOG is set
    try:
        return zenoh.open(zenoh.Config.from_json5(json.dumps(config)))
    except zenoh.ZError as error:
        raise MeshError(str(error)) from error


class ZenohNode:
    """`wire.bus.Node` over Zenoh, as a context manager: constructed offline, connected by `with`.

    In lockstep the tick is stamped on everything sent, nothing is dropped, and unanswered questions run out by the
    mesh's clock, which whoever drives the node writes to `tick` and `now_s`. There one tick is one waking and one
    packet: what is published leaves together with the tick or the answer to it, and what comes is left with Zenoh until
    it is fetched. `keep_all` has even a slow reader see every message of every topic.
    """

    def __init__(
        self, link: Link, id: str, role: Role, lockstep: bool = False, owner: str = "", keep_all: bool = False
    ) -> None:
        self._presence_key = key(link.realm, PRESENCE_PATH, id)
        self._link, self._id = link, id
        self._role: Role = role
        self._lockstep = lockstep
        self._exprs: dict[str, zenoh.KeyExpr] = {}
        self._nudge_expr = ""
        self._declared: list[Any] = []
        self._presence_declared = False
        self._present: set[str] = set()
        self._kept: list[Event] = []
        self.watching = False
        """The core asked for presence."""
        self.boot_id = ""
        """Written, as the two that follow, by whoever drives this node."""
        self.tick, self.now_s = NO_TICK, 0.0
        self.outbox = Outbox(id, role, lockstep, self._declare)
        self.shelf = Shelf(self._nudge)
        self.inbox = Inbox(keep_newest_only=not lockstep and not keep_all)
        self.mailbox = Mailbox(id, owner)

    def __enter__(self) -> Self:
        sys.setswitchinterval(SWITCH_S)
        try:
            self._session = open_session(client_config(self._link), LEAN_RUNTIME if self._lockstep else "")
        except MeshError as error:
            who = f" as {self._link.user}" if self._link.user else ""
            raise MeshError(
                f"{self._id} cannot reach the router at {self._link.endpoint}{who} within {self._link.timeout_s:g} s: "
                "see that the mesh is up (`justw status`) and that the passwords are the ones of this run"
            ) from error
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.flush()
        self.shelf.close()
        self.inbox.close()
        self._session.close()

    @property
    def id(self) -> str:
        return self._id

    @property
    def role(self) -> Role:
        return self._role

    def subscribe(self, topic: str, id: str | None = None) -> None:
        row = topic_for(topic, self._role, publishing=False)
        limit = max_bytes(row.message)
        expr = pattern(self._link.realm, row.path, id)
        if self._lockstep:
            self._shelve(row, limit, expr)
            return

        def on_sample(sample: zenoh.Sample) -> None:
            letter = self._letter(row, limit, sample)
            if letter is not None:
                self.inbox.put(letter)

        callback = zenoh.handlers.Callback(on_sample, indirect=False)
        self._declared.append(self._session.declare_subscriber(expr, callback, allowed_origin=_REMOTE))

    def _shelve(self, row: Topic, limit: int, expr: str) -> None:
        def open(sample: zenoh.Sample) -> Letter | None:
            return self._letter(row, limit, sample)

        box: Any = zenoh.handlers.FifoChannel(FETCHED_AT_ONCE)
        if row.name in CLOCK_TOPICS:
            self._nudge_expr = expr
            self.shelf.add_clock(self._session.declare_subscriber(expr, box), open)
            return
        self.shelf.add(self._session.declare_subscriber(expr, box, allowed_origin=_REMOTE), open)

    def _nudge(self) -> None:
        self._session.put(self._nudge_expr, b"", allowed_destination=zenoh.Locality.SESSION_LOCAL)

    def serve(self, service: str, id: str = "") -> None:
        row = service_for(service, self._role, serving=True)

        def on_query(query: zenoh.Query) -> None:
            self._file_request(row, id, query)

        expr = key(self._link.realm, row.path, id)
        callback = zenoh.handlers.Callback(on_query, indirect=False)
        self._declared.append(self._session.declare_queryable(expr, callback, complete=True, allowed_origin=_REMOTE))

    def watch_presence(self) -> None:
        self.watching = True
        self.track_presence()

    def track_presence(self) -> None:
        """Have presence letters filed, whether or not the core wants them."""
        if self._presence_declared:
            return
        self._presence_declared = True

        callback = zenoh.handlers.Callback(self._file_presence, indirect=False)
        expr = pattern(self._link.realm, PRESENCE_PATH, None)
        self._declared.append(self._session.liveliness().declare_subscriber(expr, callback, history=True))

    def recount(self) -> None:
        """Ask the router who is there: word of somebody who came can be lost with a link that breaks and is mended."""

        def on_reply(reply: zenoh.Reply) -> None:
            if reply.ok is not None:
                self._note_presence(str(reply.ok.key_expr), alive=True)

        expr = pattern(self._link.realm, PRESENCE_PATH, None)
        callback = zenoh.handlers.Callback(on_reply, indirect=False)
        self._session.liveliness().get(expr, callback, timeout=RECOUNT_S)

    def announce(self) -> None:
        """Tell the mesh that this process is there. Call when everything is subscribed and served."""
        self.flush()
        self._declared.append(self._session.liveliness().declare_token(self._presence_key))

    def publish(self, topic: str, message: Message, id: str = "") -> None:
        self.outbox.publish(topic, message, id, self.tick)

    def flush(self) -> None:
        """Send what was published in lockstep."""
        self.outbox.flush()

    def ask(self, service: str, request: Message, id: str = "", timeout_s: float | None = None) -> int:
        row = service_for(service, self._role, serving=False)
        if not isinstance(request, row.request):
            raise TypeError(f"{service} is asked with {row.request.__name__}, not {type(request).__name__}")
        expr = self._expr(row.path, id)
        timeout_s = row.timeout_s if timeout_s is None else timeout_s
        number = self.mailbox.ask(service, id, self._now_s(), timeout_s)
        self.outbox.wake(id or row.servers[0])
        self.flush()

        def on_reply(reply: zenoh.Reply) -> None:
            self.inbox.put(reply_letter(service, id, number, reply))

        def on_end() -> None:
            if not self._lockstep:
                self.inbox.put(Letter(Kind.REPLY, service, id, ask=number, error=f"nobody answers {expr}"))

        self._session.get(
            expr,
            zenoh.handlers.Callback(on_reply, on_end, indirect=False),
            consolidation=zenoh.ConsolidationMode.NONE,
            congestion_control=_BLOCK,
            timeout=3600.0 if self._lockstep else timeout_s + 1.0,
            payload=encode(request),
            attachment=self.outbox.stamp(self.tick),
            allowed_destination=_REMOTE,
        )
        return number

    def collect(self, timeout_s: float) -> list[Event]:
        """Events as they came, waiting at most this long for the first: for a process that follows no ticks."""
        kept, self._kept = self._kept, []
        if kept:
            return kept
        return self.mailbox.open(self.inbox.take(timeout_s, LETTERS_AT_ONCE), self._now_s())

    def call(self, service: str, request: Message, id: str = "", timeout_s: float | None = None) -> Message:
        """Ask and wait, for tools without a loop of their own; `collect` has what came meanwhile. Raises MeshError."""
        number = self.ask(service, request, id, timeout_s)
        kept: list[Event] = []
        reply = None
        while reply is None:
            events = self.collect(0.05)
            reply = next((event for event in events if isinstance(event, Reply) and event.ask == number), None)
            kept += [event for event in events if event is not reply]
        self._kept = kept
        if reply.message is None:
            raise MeshError(reply.error)
        return reply.message

    def _now_s(self) -> float:
        return self.now_s if self._lockstep else time.monotonic()

    def _declare(self, row: Topic, id: str, every: bool) -> zenoh.Publisher:
        return self._session.declare_publisher(
            self._expr(row.path, id), congestion_control=_BLOCK if every else _DROP, allowed_destination=_REMOTE
        )

    def _expr(self, path: str, id: str) -> zenoh.KeyExpr:
        text = key(self._link.realm, path, id)
        if text not in self._exprs:
            self._exprs[text] = zenoh.KeyExpr(text)
        return self._exprs[text]

    def _letter(self, row: Topic, limit: int, sample: zenoh.Sample) -> Letter | None:
        if sample.kind != zenoh.SampleKind.PUT or (self._lockstep and sample.attachment is None):
            return None  # nothing was said, or it is a nudge
        full_key = str(sample.key_expr)
        id = id_in(self._link.realm, row.path, full_key)
        stamp = stamp_of(sample.attachment)
        size = len(sample.payload)
        if id is None or stamp is None or size > limit:
            fault = "no single key" if id is None else "no stamp" if stamp is None else f"{size} bytes are too many"
            self.mailbox.warn(f"{full_key[:80]}: {fault}")
            return None
        tick, seq, sender = stamp
        return Letter(Kind.MESSAGE, row.name, id, sender, tick, seq, sample.payload.to_bytes())

    def _file_presence(self, sample: zenoh.Sample) -> None:
        self._note_presence(str(sample.key_expr), alive=sample.kind == zenoh.SampleKind.PUT)

    def _note_presence(self, full_key: str, alive: bool) -> None:
        """File what is news."""
        process = id_in(self._link.realm, PRESENCE_PATH, full_key)
        if process is None or alive == (process in self._present):
            return
        (self._present.add if alive else self._present.discard)(process)
        self.inbox.put(Letter(Kind.PRESENCE, "", process, alive=alive))

    def _file_request(self, row: Service, id: str, query: zenoh.Query) -> None:
        stamp = stamp_of(query.attachment)
        payload = b"" if query.payload is None else query.payload.to_bytes()
        if stamp is None or len(payload) > max_bytes(row.request):
            self.mailbox.warn(f"{row.name}: a request without stamp or too big")
            refuse_query(query, f"{row.name}: not a request of this mesh")
            return
        expr = self._expr(row.path, id)

        def answer(reply: bytes) -> None:
            self.outbox.wake(sender)
            self.flush()
            query.reply(expr, reply, attachment=self.outbox.stamp(self.tick))
            query.drop()

        tick, seq, sender = stamp
        refuse = partial(refuse_query, query)
        self.inbox.put(Letter(Kind.REQUEST, row.name, id, sender, tick, seq, payload, answer=answer, refuse=refuse))


def node_for(site: Site, id: str, role: Role, timeout_s: float = 10.0, credentials: Path | None = None) -> ZenohNode:
    """A node that follows no ticks: for tools, views and evaluators."""
    return ZenohNode(link_for(site, id, timeout_s, credentials), id, role)
