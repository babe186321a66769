"""The mesh in one process, in memory and deterministic: the same delivery as lockstep over Zenoh, the same bytes.

mesh = LoopbackMesh(step_s=0.05)
mesh.add(simulator, "sim", "sim", owner=True)
mesh.add(coordinator, "hub", "hub")
state = mesh.call("task", TaskRequest(task="t-1", instruction="put the apple in the fridge"))
"""

from collections.abc import Callable
from dataclasses import dataclass

from wire.bus import Core, Reply
from wire.clock import boot_id, next_turn
from wire.codec import encode
from wire.keys import PRESENCE_PATH, Role
from wire.letter import NO_TICK, Kind, Letter
from wire.mailbox import Mailbox
from wire.model import Message
from wire.paths import key, pattern, service_for, topic_for
from wire.pulse import Pulse

Recorder = Callable[[float, str, str, int, bytes], None]
"""Handed (now_s, key without realm, sender, tick, payload) of everything that is published."""
OPERATOR = "console-0"


class LoopbackNode:
    """One core's side of a LoopbackMesh."""

    def __init__(self, mesh: "LoopbackMesh", id: str, role: Role) -> None:
        key("", PRESENCE_PATH, id)
        self._mesh = mesh
        self._id = id
        self.role: Role = role
        self.topics: set[tuple[str, str | None]] = set()
        self.services: set[tuple[str, str]] = set()
        self.watching = False
        self.boot_id = ""
        self.mailbox = Mailbox(id)
        self.seq = 0

    @property
    def id(self) -> str:
        return self._id

    def subscribe(self, topic: str, id: str | None = None) -> None:
        pattern("", topic_for(topic, self.role, publishing=False).path, id)
        self.topics.add((topic, id))

    def serve(self, service: str, id: str = "") -> None:
        key("", service_for(service, self.role, serving=True).path, id)
        self.services.add((service, id))

    def watch_presence(self) -> None:
        self.watching = True

    def publish(self, topic: str, message: Message, id: str = "") -> None:
        row = topic_for(topic, self.role, publishing=True)
        if not isinstance(message, row.message):
            raise TypeError(f"{topic} carries {row.message.__name__}, not {type(message).__name__}")
        self._mesh.deliver(self, topic, id, key("", row.path, id)[1:], encode(message))

    def ask(self, service: str, request: Message, id: str = "", timeout_s: float | None = None) -> int:
        row = service_for(service, self.role, serving=False)
        if not isinstance(request, row.request):
            raise TypeError(f"{service} is asked with {row.request.__name__}, not {type(request).__name__}")
        key("", row.path, id)
        number = self.mailbox.ask(service, id, self._mesh.now_s, timeout_s)
        self._mesh.pass_on(self, service, id, number, encode(request))
        return number

    def wants(self, topic: str, id: str) -> bool:
        return (topic, None) in self.topics or (topic, id) in self.topics


@dataclass
class _Member:
    node: LoopbackNode
    core: Core
    pulse: Pulse
    owner: bool
    turn: int = 0
    """The tick in which it steps next."""


class LoopbackMesh:
    """Cores of several processes, stepped one after the other: the clock's owner first, then by id."""

    def __init__(self, step_s: float = 0.05, recorder: Recorder | None = None, owner: str = "") -> None:
        """`owner` names a clock's owner that is not a member: one whose recorded messages are injected."""
        self._step_s = step_s
        self._absent_owner = owner
        self._recorder = recorder
        self._members: dict[str, _Member] = {}
        self._arriving: list[_Member] = []
        self._woken: set[str] = set()
        """Who was asked or answered in this tick, and has a turn in the next."""
        self._tick = NO_TICK
        self._operator = LoopbackNode(self, OPERATOR, "console")

    @property
    def now_s(self) -> float:
        """The time of the newest tick."""
        return max(self._tick, 0) * self._step_s

    def add(self, core: Core, id: str, role: Role, owner: bool = False) -> None:
        """A process that starts with the next tick."""
        node = LoopbackNode(self, id, role)
        self._arriving.append(_Member(node, core, Pulse(node), owner))

    def remove(self, id: str, stop: bool = True) -> None:
        """A process that goes; with `stop` False as if killed."""
        member = self._members.pop(id)
        if stop:
            member.core.stop()
        self._announce(id, alive=False)

    def tick(self) -> None:
        """One step of every process whose turn it is."""
        self._start_arrivals()
        self._tick += 1
        woken, self._woken = self._woken, set()
        for id in sorted(self._members, key=lambda id: (not self._members[id].owner, id)):
            member = self._members[id]
            if member.turn > self._tick and id not in woken:
                continue
            member.node.boot_id = member.node.boot_id or boot_id(self.now_s)
            member.core.step(self.now_s, member.node.mailbox.at_tick(self._tick, self.now_s))
            member.pulse.beat(self.now_s)
            member.turn = next_turn(member.core, member.pulse.due_s, self._tick, self.now_s, self._step_s)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / self._step_s)):
            self.tick()

    def call(self, service: str, request: Message, id: str = "", role: Role = "console") -> Message:
        """Ask as the operator (or evaluator) and step the mesh until the answer is there; TimeoutError without."""
        row = service_for(service, role, serving=False)
        self._start_arrivals()
        self._operator.role = role
        number = self._operator.ask(service, request, id)
        for _ in range(round(row.timeout_s / self._step_s) + 2):
            self.tick()
            for event in self._operator.mailbox.at_tick(self._tick + 1, self.now_s):
                if isinstance(event, Reply) and event.ask == number:
                    return _answer(event)
        raise TimeoutError(f"no answer from {service}{f'/{id}' if id else ''} in {row.timeout_s:g} s")

    def say(self, topic: str, message: Message, id: str = "", role: Role = "console") -> None:
        """Publish from outside the mesh: arrives with the next tick."""
        self._start_arrivals()
        self._operator.role = role
        self._operator.publish(topic, message, id)

    def close(self) -> None:
        """Stop every core."""
        for id in sorted(self._members):
            self._members[id].core.stop()
        self._members.clear()

    def inject(self, letter: Letter) -> None:
        """A message with the sender and tick that it had when it was recorded."""
        self._start_arrivals()
        for member in self._members.values():
            if member.node.id != letter.sender and member.node.wants(letter.name, letter.id):
                member.node.mailbox.hold([letter])

    def deliver(self, sender: LoopbackNode, topic: str, id: str, full_key: str, payload: bytes) -> None:
        """To everybody who subscribed; nobody hears himself."""
        sender.seq += 1
        tick = self._tick_of(sender)
        if self._recorder is not None:
            self._recorder(self.now_s, full_key, sender.id, tick, payload)
        for member in self._members.values():
            if member.node is not sender and member.node.wants(topic, id):
                letter = Letter(Kind.MESSAGE, topic, id, sender.id, tick, sender.seq, payload)
                member.node.mailbox.hold([letter])

    def pass_on(self, asker: LoopbackNode, service: str, id: str, number: int, payload: bytes) -> None:
        """A question, to the one process that serves it."""
        asker.seq += 1
        servers = [m.node for _, m in sorted(self._members.items()) if (service, id) in m.node.services]
        if not servers:
            return
        server = servers[0]
        self._wake(asker, server.id)

        def answer(reply: bytes) -> None:
            server.seq += 1
            self._wake(server, asker.id)
            asker.mailbox.hold(
                [Letter(Kind.REPLY, service, id, server.id, self._tick_of(server), server.seq, reply, number)]
            )

        def refuse(text: str) -> None:
            asker.mailbox.hold(
                [Letter(Kind.REPLY, service, id, server.id, self._tick_of(server), ask=number, error=text)]
            )

        letter = Letter(Kind.REQUEST, service, id, asker.id, self._tick_of(asker), asker.seq, payload)
        letter.answer, letter.refuse = answer, refuse
        server.mailbox.hold([letter])

    def _start_arrivals(self) -> None:
        arriving, self._arriving = sorted(self._arriving, key=lambda member: member.node.id), []
        for member in arriving:
            if member.node.id in self._members:
                raise ValueError(f"{member.node.id} is on this mesh already")
            member.node.mailbox = Mailbox(member.node.id, self._owner(arriving))
            self._members[member.node.id] = member
            member.core.start(member.node)
        for member in arriving:
            self._announce(member.node.id, alive=True)
            if member.node.watching:
                others = (id for id in self._members if all(id != new.node.id for new in arriving))
                member.node.mailbox.hold([Letter(Kind.PRESENCE, "", id, alive=True) for id in others])

    def _owner(self, arriving: list[_Member]) -> str:
        owners = [m.node.id for m in [*self._members.values(), *arriving] if m.owner]
        return owners[0] if owners else self._absent_owner

    def _announce(self, id: str, alive: bool) -> None:
        for member in self._members.values():
            if member.node.watching:
                member.node.mailbox.hold([Letter(Kind.PRESENCE, "", id, alive=alive)])

    def _wake(self, speaker: LoopbackNode, id: str) -> None:
        """Followers of the clock end each other's rest; its owner and the operator do not."""
        member = self._members.get(speaker.id)
        if member is not None and not member.owner:
            self._woken.add(id)

    def _tick_of(self, node: LoopbackNode) -> int:
        return NO_TICK if node is self._operator else self._tick


def _answer(reply: Reply) -> Message:
    if reply.message is None:
        raise TimeoutError(reply.error)
    return reply.message
