"""Who rests is left out of the ticks in between, hears everything afterwards, and keeps its heartbeat."""

from collections.abc import Sequence
from math import inf

import pytest

from tests.wire.cores import Clockwork, Diary, Gossip, Walker
from wire.bus import Core, Event, Node, Received, Reply, Request
from wire.clock import LONGEST_REST_S, Roll, next_turn
from wire.loopback import LoopbackMesh
from wire.messages.clock import Health
from wire.messages.command import CardRequest, DeviceCard


class Sleeper(Gossip):
    """A hub that rests for as long as it is told to after every step."""

    def __init__(self, rest_s: float) -> None:
        super().__init__()
        self.rest_s, self.stepped_s = rest_s, list[float]()

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self.stepped_s.append(round(now_s, 6))
        super().step(now_s, events)

    def rests_until_s(self) -> float:
        return self.stepped_s[-1] + self.rest_s


def turns(rest_s: float, seconds: float) -> list[float]:
    mesh, hub = LoopbackMesh(), Sleeper(rest_s)
    mesh.add(hub, "hub", "hub")
    mesh.run(seconds)
    return hub.stepped_s


def test_a_core_has_its_turn_when_it_wants_to() -> None:
    assert turns(0.1, 0.4) == [0.0, 0.1, 0.2, 0.3]
    assert turns(0.12, 0.4) == [0.0, 0.15, 0.3], "not before it wanted to"


@pytest.mark.parametrize("rest_s", [0.0, -5.0, 0.01])
def test_a_time_that_is_past_asks_for_every_tick(rest_s: float) -> None:
    assert turns(rest_s, 0.2) == [0.0, 0.05, 0.1, 0.15]


def test_no_rest_is_longer_than_promised_and_a_heartbeat_ends_it() -> None:
    assert turns(inf, 1.6) == [0.0, 0.5, 1.0, 1.5]
    for step_s in (0.05, 0.025, 0.15, 0.3):
        tick = next_turn(Sleeping(), inf, 10, 10 * step_s, step_s)
        assert tick == 11 or (tick - 10) * step_s <= LONGEST_REST_S + 1e-9


class Sleeping(Diary):
    """Rests for ever."""

    def start(self, node: Node) -> None: ...

    def step(self, now_s: float, events: Sequence[Event]) -> None: ...

    def stop(self) -> None: ...

    def rests_until_s(self) -> float:
        return inf


def test_who_says_nothing_of_resting_steps_in_every_tick() -> None:
    core: Core = Walker()
    assert next_turn(core, inf, 7, 0.35, 0.05) == 8


def test_everything_said_meanwhile_is_there_at_the_next_turn() -> None:
    def lines(rest_s: float) -> list[str]:
        mesh, hub = LoopbackMesh(), Sleeper(rest_s)
        mesh.add(hub, "hub", "hub")
        mesh.add(Clockwork(), "sim", "sim", owner=True)
        for id in ("dog-1", "dog-2"):
            mesh.add(Walker(), id, "robot")
        mesh.run(1.0)
        return hub.lines

    dogs = [line.split()[1] for line in lines(0.2) if line.startswith("0.30 event/")]  # the cards came at 0.10
    assert dogs == ["event/dog-1"] * 4 + ["event/dog-2"] * 4
    told = [line for line in lines(0.2) if " event/dog-1 " in line]
    assert len(told) == 18
    assert all(f'"seq":{number},' in line for number, line in enumerate(told))
    assert lines(0.2) == lines(0.2)


def test_a_resting_process_is_as_alive_as_others() -> None:
    heard: list[float] = []

    class Ear(Sleeping):
        def start(self, node: Node) -> None:
            node.subscribe("health")

        def step(self, now_s: float, events: Sequence[Event]) -> None:
            heard.extend(e.message.stamp_s for e in events if isinstance(e, Received) and isinstance(e.message, Health))

    mesh = LoopbackMesh()
    mesh.add(Ear(), "hub", "hub")
    mesh.add(Sleeping(), "dog-1", "robot")
    mesh.run(3.05)
    assert [round(s, 6) for s in heard] == [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]


def test_time_waits_for_those_alone_whose_turn_it_is() -> None:
    roll = Roll({"hub": "hub", "dog-1": "robot"})
    roll.presence("hub", True)
    roll.presence("dog-1", True)
    assert roll.begin(0) == ["dog-1", "hub"]
    roll.done("hub", 0, next_turn=4)
    roll.done("dog-1", 0)
    assert roll.begin(1) == ["dog-1"]
    roll.done("dog-1", 1, next_turn=2)
    roll.done("hub", 1, next_turn=50)
    assert roll.begin(3) == ["dog-1"]
    assert roll.begin(4) == ["dog-1", "hub"], "who was not asked has nothing to say of its turns"


def test_who_is_told_something_by_name_has_the_next_turn() -> None:
    roll = Roll({"hub": "hub", "dog-1": "robot", "planner": "planner"})
    for id in ("hub", "dog-1", "planner"):
        roll.presence(id, True)
    roll.begin(0)
    for id in ("dog-1", "hub", "planner"):
        wakes = ("dog-1", "planner", "console-1") if id == "hub" else ()
        roll.done(id, 0, next_turn=9, wakes=wakes)
    assert roll.begin(1) == ["dog-1", "planner"], "a process, and whoever has this role"
    roll.done("planner", 1, next_turn=9, wakes=("hub",))
    roll.done("dog-1", 1, next_turn=9, wakes=("planner",))
    roll.done("dog-1", 1, next_turn=9, wakes=("dog-1",))
    assert roll.begin(2) == ["hub", "planner"], "a second answer to one tick does not count"
    roll.done("hub", 2, next_turn=9)
    roll.done("planner", 2, next_turn=9)
    assert roll.begin(3) == []


def test_a_question_and_its_answer_end_the_rest_of_those_they_are_for() -> None:
    answered_s: list[float] = []

    class Asker(Sleeping):
        """A hub at rest that asks once, in its second turn."""

        def start(self, node: Node) -> None:
            self._node, self._turns = node, 0

        def step(self, now_s: float, events: Sequence[Event]) -> None:
            self._turns += 1
            if self._turns == 2:
                self._node.ask("card", CardRequest(), "dog-1")
            answered_s.extend(round(now_s, 6) for event in events if isinstance(event, Reply))

    class Card(Sleeping):
        def start(self, node: Node) -> None:
            node.serve("card", node.id)

        def step(self, now_s: float, events: Sequence[Event]) -> None:
            for event in events:
                if isinstance(event, Request):
                    event.reply(DeviceCard(id="dog-1", kind="walker", boot_id="b"))

    mesh = LoopbackMesh()
    mesh.add(Asker(), "hub", "hub")
    mesh.add(Card(), "dog-1", "robot")
    mesh.run(2.0)
    assert answered_s == [0.6], "asked at 0.5, heard and answered at 0.55, known at 0.6"


def test_who_comes_back_has_the_next_turn_and_who_dies_at_rest_is_gone() -> None:
    roll = Roll({"hub": "hub", "dog-1": "robot"})
    for id in ("hub", "dog-1"):
        roll.presence(id, True)
    roll.begin(0)
    roll.done("hub", 0, next_turn=4)
    roll.done("dog-1", 0, next_turn=4)
    roll.presence("hub", False)
    assert roll.absent == ["hub"]
    assert roll.begin(1) == []
    roll.presence("hub", True)
    assert roll.begin(2) == ["hub"]
    roll.presence("hub", False)
    roll.presence("dog-1", False)
    assert roll.waiting == []
    assert roll.deserted
