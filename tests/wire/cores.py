"""Small cores that talk to each other, for the tests of the mesh."""

from collections.abc import Sequence

from wire.bus import Event, Node, Presence, Received, Reply, Request
from wire.messages.command import CardRequest, DeviceCard, Progress
from wire.messages.driver import VelocityCommand
from wire.messages.observation import EventLog
from wire.messages.truth import JudgeReply, TruthState, TruthTask
from wire.messages.world import WorldState


def describe(event: Event) -> str:
    """One line that differs when the event differs."""
    match event:
        case Received(topic, id, message):
            return f"{topic}/{id} {message.model_dump_json()}"
        case Request(service, id, message):
            return f"? {service}/{id} {message.model_dump_json()}"
        case Reply(ask, service, id, message, error):
            return f"! {ask} {service}/{id} {message.model_dump_json() if message else error}"
        case Presence(process, alive):
            return f"{process} {'came' if alive else 'went'}"


class Diary:
    """Writes down what it is handed. The base of the cores below."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def note(self, now_s: float, events: Sequence[Event]) -> None:
        self.lines += [f"{now_s:.2f} {describe(event)}" for event in events]


class Clockwork(Diary):
    """A clock's owner that hears velocities, and tells the truth and judges to whoever may hear it."""

    def start(self, node: Node) -> None:
        self._node = node
        node.subscribe("velocity")
        node.serve("judge")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self.note(now_s, [event for event in events if not isinstance(event, Request)])
        self._node.publish("truth", TruthState(stamp_s=now_s, world=WorldState(seq=1, stamp_s=now_s)))
        task = TruthTask(instruction="find the mug", goals=())
        for event in events:
            if isinstance(event, Request):
                reply = JudgeReply(stamp_s=now_s, task=task, goals=(), success=True, collisions=0, sim_s=now_s)
                event.reply(reply)

    def stop(self) -> None:
        self.lines.append("stopped")


class Walker(Diary):
    """A robot: three velocities and a line of log a step, answers its card, echoes what the hub logs."""

    def start(self, node: Node) -> None:
        self._node = node
        self._steps = 0
        node.serve("card", node.id)

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self.note(now_s, events)
        for event in events:
            if isinstance(event, Request):
                event.reply(DeviceCard(id=self._node.id, kind="walker", boot_id=f"{self._steps}"))
        for speed in (0.1, 0.2, 0.3):
            command = VelocityCommand(
                robot=self._node.id, seq=self._steps, forward_mps=speed, left_mps=0.0, yaw_rate_radps=0.0
            )
            self._node.publish("velocity", command, self._node.id)
        line = EventLog(source=self._node.id, seq=self._steps, stamp_s=now_s, text=f"{len(self.lines)} lines")
        self._node.publish("event", line, self._node.id)
        progress = Progress(goal_id="g", robot=self._node.id, stamp_s=now_s, fraction=0.0, note=line.text)
        self._node.publish("progress", progress, self._node.id)
        self._steps += 1

    def stop(self) -> None:
        self.lines.append("stopped")


class Gossip(Diary):
    """A hub: hears everybody's log, watches who is there, and asks every newcomer for its card."""

    def start(self, node: Node) -> None:
        self._node = node
        node.subscribe("event")
        node.subscribe("progress", "dog-1")
        node.watch_presence()

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self.note(now_s, events)
        for event in events:
            if isinstance(event, Presence) and event.alive and event.process.startswith("dog"):
                self._node.ask("card", CardRequest(), event.process)

    def stop(self) -> None:
        self.lines.append("stopped")
