"""The in-memory mesh: who hears what, when, and in which order."""

from collections.abc import Sequence

import pytest

from tests.wire.cores import Clockwork, Diary, Gossip, Walker
from wire.bus import Event, Node, Received, Request
from wire.codec import decode
from wire.loopback import LoopbackMesh
from wire.messages.clock import Health
from wire.messages.command import CardRequest
from wire.messages.observation import EventLog
from wire.messages.operator import ControlReply, ControlRequest


def house() -> tuple[LoopbackMesh, Clockwork, Gossip, Walker]:
    mesh = LoopbackMesh(step_s=0.05)
    sim, hub, dog = Clockwork(), Gossip(), Walker()
    for core, id, role in ((hub, "hub", "hub"), (dog, "dog-1", "robot"), (Walker(), "dog-2", "robot")):
        mesh.add(core, id, role)
    mesh.add(sim, "sim", "sim", owner=True)
    return mesh, sim, hub, dog


def test_followers_hear_each_other_one_tick_later_and_of_latest_the_newest() -> None:
    mesh, sim, hub, _ = house()
    mesh.tick()
    assert sim.lines == []
    assert hub.lines == ["0.00 dog-1 came", "0.00 dog-2 came", "0.00 sim came"]
    mesh.tick()
    assert [line[:28] for line in sim.lines] == ['0.05 velocity/dog-1 {"robot"', '0.05 velocity/dog-2 {"robot"']
    assert all('"forward_mps":0.3' in line for line in sim.lines)
    assert [line[:17] for line in hub.lines[3:]] == ["0.05 event/dog-1 ", "0.05 event/dog-2 ", "0.05 progress/dog"]


def test_a_question_and_its_answer() -> None:
    mesh, _, hub, dog = house()
    for _ in range(3):
        mesh.tick()
    assert any(line.startswith("0.05 ? card/dog-1") for line in dog.lines)
    assert [line[:17] for line in hub.lines if "!" in line] == ["0.10 ! 1 card/dog", "0.10 ! 2 card/dog"]


def test_presence_of_who_goes_and_comes() -> None:
    mesh, _, hub, dog = house()
    mesh.tick()
    mesh.remove("dog-1")
    assert dog.lines[-1] == "stopped"
    mesh.tick()
    mesh.add(Walker(), "dog-3", "robot")
    mesh.tick()
    came_and_went = [line for line in hub.lines if "came" in line or "went" in line]
    assert came_and_went[3:] == ["0.05 dog-1 went", "0.10 dog-3 came"]


def test_a_restarted_process_has_another_boot_id_and_an_equal_run_the_same() -> None:
    def boot_ids() -> list[str]:
        said: list[Health] = []
        mesh = LoopbackMesh(
            0.05, lambda *row: said.append(decode(Health, row[4])) if row[1] == "health/dog-1" else None
        )
        mesh.add(Walker(), "dog-1", "robot")
        mesh.run(2.0)
        mesh.remove("dog-1", stop=False)
        mesh.add(Walker(), "dog-1", "robot")
        mesh.run(2.0)
        return [health.boot_id for health in said]

    first, *_, last = boot_ids()
    assert first != last
    assert boot_ids() == [first] * 4 + [last] * 4


def test_two_runs_are_the_same() -> None:
    def run() -> list[str]:
        mesh, sim, hub, dog = house()
        mesh.run(seconds=2.0)
        return sim.lines + hub.lines + dog.lines

    assert run() == run()


class Desk(Diary):
    """A hub that answers the operator one step after it was asked."""

    def start(self, node: Node) -> None:
        node.serve("control")
        self._open: list[Request] = []

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for request in self._open:
            request.reply(ControlReply(ok=True, text=f"at {now_s:.2f}"))
        self._open = [event for event in events if isinstance(event, Request)]

    def stop(self) -> None: ...


def test_the_operator_calls() -> None:
    mesh = LoopbackMesh()
    mesh.add(Desk(), "hub", "hub")
    assert mesh.call("control", ControlRequest(verb="stop")) == ControlReply(ok=True, text="at 0.05")


def test_no_answer_in_time_is_said() -> None:
    mesh = LoopbackMesh()
    with pytest.raises(TimeoutError, match="no answer from control in 2 s"):
        mesh.call("control", ControlRequest(verb="stop"))
    assert mesh.now_s == pytest.approx(2.0, abs=0.06)


class Lonely(Diary):
    def start(self, node: Node) -> None:
        self._node = node

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        if now_s == 0.0:
            self._node.ask("card", CardRequest(), "dog-9", timeout_s=0.2)
        self.note(now_s, events)

    def stop(self) -> None: ...


def test_a_question_to_nobody_times_out() -> None:
    mesh = LoopbackMesh()
    hub = Lonely()
    mesh.add(hub, "hub", "hub")
    mesh.run(1.0)
    assert hub.lines == ["0.20 ! 1 card/dog-9 no answer from card/dog-9 in 0.2 s"]


class Probe:
    """Hands its node out, to be misused."""

    def start(self, node: Node) -> None:
        self.node = node

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self.events = events

    def stop(self) -> None: ...


@pytest.fixture
def probe() -> Node:
    core, mesh = Probe(), LoopbackMesh()
    mesh.add(core, "dog-1", "robot")
    mesh.tick()
    return core.node


def test_what_the_tables_do_not_grant_fails_at_once(probe: Node) -> None:
    with pytest.raises(PermissionError, match="robot may not subscribe to truth"):
        probe.subscribe("truth")
    with pytest.raises(PermissionError, match="robot may not call judge"):
        probe.ask("judge", CardRequest())
    with pytest.raises(PermissionError, match="robot may not publish world_delta"):
        probe.publish("world_delta", CardRequest())


def test_wrong_types_and_ids_fail_at_once(probe: Node) -> None:
    with pytest.raises(TypeError, match="event carries EventLog, not CardRequest"):
        probe.publish("event", CardRequest(), "dog-1")
    line = EventLog(source="dog-1", seq=0, stamp_s=0.0, text="")
    for bad in ("", "*", "dog-1/x", "Dog", "@adv", "x" * 33):
        with pytest.raises(ValueError, match="id"):
            probe.publish("event", line, bad)


def test_everything_published_is_handed_to_the_recorder() -> None:
    seen: list[tuple[float, str, str, int]] = []
    mesh = LoopbackMesh(recorder=lambda now_s, key, sender, tick, payload: seen.append((now_s, key, sender, tick)))
    mesh.add(Walker(), "dog-1", "robot")
    mesh.tick()
    assert seen[-2:] == [(0.0, "robot/dog-1/progress", "dog-1", 0), (0.0, "health/dog-1", "dog-1", 0)]


class Hasty(Desk):
    """Tries what a server must not do before it answers properly."""

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for request in (event for event in events if isinstance(event, Request)):
            with pytest.raises(TypeError, match="control is answered by ControlReply, not CardRequest"):
                request.reply(CardRequest())
            request.reply(ControlReply(ok=True, text="once"))
            with pytest.raises(RuntimeError, match="has its answer already"):
                request.reply(ControlReply(ok=True, text="twice"))


def test_a_request_is_answered_once_and_with_the_right_type() -> None:
    mesh = LoopbackMesh()
    mesh.add(Hasty(), "hub", "hub")
    assert mesh.call("control", ControlRequest(verb="stop")) == ControlReply(ok=True, text="once")


def test_health_twice_a_second() -> None:
    heard: list[Event] = []

    class Ear(Probe):
        def start(self, node: Node) -> None:
            node.subscribe("health")

        def step(self, now_s: float, events: Sequence[Event]) -> None:
            heard.extend(events)

    mesh = LoopbackMesh()
    mesh.add(Ear(), "hub", "hub")
    mesh.add(Walker(), "dog-1", "robot")
    mesh.run(5.0)
    beats = [e.message for e in heard if isinstance(e, Received)]
    assert len(beats) == 10
    assert all(isinstance(beat, Health) and beat.process == "dog-1" for beat in beats)
