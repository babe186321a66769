"""Goals: accepted once, run once, one result each, whatever the order and number of the messages."""

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from devices.device import Device
from devices.goals_journal import GoalsJournal, open_journal
from devices.worker import Outcome, Pose
from tests.devices.driver import command
from wire.bus import Request
from wire.messages.command import (
    CancelRequest,
    Command,
    CommandAck,
    DeviceCard,
    GoalsReply,
    GoalsRequest,
    Progress,
    Result,
    RobotReport,
)
from wire.model import Message


class Counting:
    """Works on every goal for a few steps and counts how often each was begun."""

    def __init__(self, steps: int = 4) -> None:
        self.begun: Counter[str] = Counter()
        self.steps, self.left, self.committed, self.halted = steps, 0, False, 0
        self.progress = (0.5, "working")
        self.pose = Pose((1.0, 2.0, 0.0), 0.0, (), 3.0, 4, False, False)

    def card(self, boot_id: str) -> DeviceCard:
        return DeviceCard(id="dog-1", kind="quadruped", boot_id=boot_id)

    def fault_of(self, given: Command) -> str:
        return "" if given.point_m is not None else "goto: a point is missing"

    def begin(self, given: Command) -> None:
        self.begun[given.goal_id] += 1
        self.left = self.steps

    def work(self, now_s: float) -> Outcome | None:
        self.left -= 1
        return Outcome("done", "ok", "arrived") if self.left <= 0 else None

    def idle(self, now_s: float) -> None:
        pass

    def halt(self) -> None:
        self.halted += 1

    def drop(self) -> None:
        self.left = 0


class Wire:
    """Collects what the device publishes."""

    id, boot_id = "dog-1", "boot-1"

    def __init__(self) -> None:
        self.sent: list[Message] = []

    def publish(self, topic: str, message: Message, id: str = "") -> None:
        self.sent.append(message)

    def serve(self, service: str, id: str = "") -> None:
        pass

    def of(self, kind: type) -> list:
        return [message for message in self.sent if isinstance(message, kind)]


class Bench:
    """A device with its journal, asked without a mesh."""

    def __init__(self, journal: GoalsJournal | None = None, worker: Counting | None = None) -> None:
        self.journal, self.worker, self.wire = journal or open_journal(), worker or Counting(), Wire()
        self.now_s = 10.0
        self.device = Device("dog-1", self.worker, self.journal, lost_hub_s=2.0)
        self.device.start(self.wire)

    def ask(self, message: Message, service: str = "goal") -> Message:
        answers: list[Message] = []
        self.device.hear(Request(service, "dog-1", message, answers.append), self.now_s)
        assert len(answers) == 1
        return answers[0]

    def goal(self, goal_id: str, **fields: object) -> CommandAck:
        ack = self.ask(command(goal_id, **{"point_m": (1.0, 1.0), **fields}))
        assert isinstance(ack, CommandAck)
        return ack

    def step(self, count: int = 1) -> None:
        for _ in range(count):
            self.now_s += 0.05
            self.device.step(self.now_s)


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_the_same_goal_again_answers_with_its_state(bench: Bench) -> None:
    assert bench.goal("g-1").status == "running"
    assert bench.goal("g-1").status == "running"
    bench.step(10)
    assert bench.goal("g-1").status == "done"
    bench.step(10)
    assert bench.worker.begun == {"g-1": 1}
    assert [r.goal_id for r in bench.wire.of(Result)] == ["g-1"]


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"robot": "dog-2"}, "this is dog-1"),
        ({"point_m": None}, "a point is missing"),
        ({"valid_until_s": 5.0}, "too late"),
    ],
)
def test_what_cannot_be_done_is_refused_with_the_reason(bench: Bench, fields: dict, words: str) -> None:
    ack = bench.goal("g-1", **fields)
    assert not ack.accepted
    assert words in ack.reason
    bench.step(10)
    assert not bench.worker.begun
    assert not bench.wire.of(Result)


def test_an_old_hub_is_fenced_off(bench: Bench) -> None:
    assert bench.goal("g-1", epoch=3).accepted
    bench.step(10)
    refused = bench.goal("g-2", epoch=2)
    assert not refused.accepted
    assert "epoch 2 is over" in refused.reason
    cancel = bench.ask(CancelRequest(robot="dog-1", epoch=2), "cancel")
    assert isinstance(cancel, CommandAck)
    assert not cancel.accepted
    assert bench.goal("g-2", epoch=4).accepted


def test_busy_refuses_but_what_is_being_cancelled_makes_room(bench: Bench) -> None:
    bench.goal("g-1")
    assert "busy with g-1" in bench.goal("g-2").reason
    bench.worker.committed = True
    bench.ask(CancelRequest(robot="dog-1", goal_id="g-1", epoch=1), "cancel")
    assert bench.goal("g-2").status == "accepted"
    bench.step(1)
    assert not bench.wire.of(Result)
    bench.worker.committed = False
    bench.step(10)
    assert [(r.goal_id, r.status) for r in bench.wire.of(Result)] == [("g-1", "cancelled"), ("g-2", "done")]


def test_restart_interrupts_what_was_running(tmp_path: Path) -> None:
    path = tmp_path / "dog-1.sqlite"
    before = Bench(open_journal(path), Counting(steps=1000))
    before.goal("g-1", epoch=2)
    before.step(5)
    before.journal.close()
    after = Bench(open_journal(path))
    assert after.goal("g-1", epoch=2).accepted
    after.step(3)
    results = after.wire.of(Result)
    assert [(r.goal_id, r.status, r.code) for r in results] == [("g-1", "interrupted", "interrupted")]
    assert not after.worker.begun
    reply = after.ask(GoalsRequest(), "goals")
    assert isinstance(reply, GoalsReply)
    assert reply.epoch == 2
    assert [(g.goal_id, g.status) for g in reply.goals] == [("g-1", "interrupted")]
    assert not after.goal("g-3", epoch=1).accepted
    after.journal.close()


def test_accepted_goals_are_on_the_disk_before_the_answer(tmp_path: Path) -> None:
    path = tmp_path / "dog-1.sqlite"
    bench = Bench(open_journal(path), Counting(steps=1000))
    other = open_journal(path)
    statuses = []
    message = command("g-1", point_m=(1.0, 1.0))
    bench.device.hear(Request("goal", "dog-1", message, lambda _: statuses.append(other.record("g-1"))), 10.0)
    assert statuses[0] is not None
    assert statuses[0].status == "running"
    bench.journal.close()
    other.close()


def test_reports_ten_a_second_and_progress_two(bench: Bench) -> None:
    bench.worker.steps = 1000
    bench.goal("g-1")
    bench.step(100)
    assert 48 <= len(bench.wire.of(RobotReport)) <= 52
    assert len(bench.wire.of(Progress)) == 0 or 9 <= len(bench.wire.of(Progress)) <= 11


Move = st.one_of(
    st.tuples(st.just("goal"), st.integers(0, 4), st.integers(0, 3), st.sampled_from([5.0, 10.2, 1e6])),
    st.tuples(st.just("cancel"), st.one_of(st.none(), st.integers(0, 4)), st.integers(0, 3), st.just(0.0)),
    st.tuples(st.just("step"), st.integers(1, 6), st.just(0), st.just(0.0)),
    st.tuples(st.just("commit"), st.integers(0, 1), st.just(0), st.just(0.0)),
    st.tuples(st.just("restart"), st.just(0), st.just(0), st.just(0.0)),
)


@settings(max_examples=150, deadline=None)
@given(st.lists(Move, max_size=40))
def test_every_accepted_goal_runs_at_most_once_and_has_one_result(moves: list) -> None:
    bench = Bench()
    begun: Counter[str] = Counter()
    results: list[Result] = []
    accepted: set[str] = set()
    for kind, which, epoch, valid_until_s in moves:
        if kind == "goal":
            if bench.goal(f"g-{which}", epoch=epoch, valid_until_s=valid_until_s).accepted:
                accepted.add(f"g-{which}")
        elif kind == "cancel":
            goal_id = None if which is None else f"g-{which}"
            bench.ask(CancelRequest(robot="dog-1", goal_id=goal_id, epoch=epoch), "cancel")
        elif kind == "step":
            bench.step(which)
        elif kind == "commit":
            bench.worker.committed = bool(which)
        else:
            begun += bench.worker.begun
            results += bench.wire.of(Result)
            bench = Bench(bench.journal)
    bench.worker.committed = False
    bench.step(20)
    begun += bench.worker.begun
    results += bench.wire.of(Result)
    assert all(count == 1 for count in begun.values())
    assert Counter(r.goal_id for r in results) == dict.fromkeys(accepted, 1)
    for result in results:
        record = bench.journal.record(result.goal_id)
        assert record is not None
        assert record.status == result.status
