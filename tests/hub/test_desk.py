"""What operators hear, and what they find in the log."""

import logging
from pathlib import Path

import pytest

from hub.task import Task
from tests.hub.home import Flat
from tests.hub.test_episode import fetch
from wire.messages.operator import ControlReply, ControlRequest, TaskQuery


def _say(home: Flat, verb: str, task: str | None = None) -> ControlReply:
    reply = home.mesh.call("control", ControlRequest(verb=verb, task=task))
    assert isinstance(reply, ControlReply)
    return reply


@pytest.fixture
def home() -> Flat:
    home = Flat(fetch)
    home.mesh.run(3.0)
    return home


@pytest.mark.parametrize(
    ("verb", "ok", "text"),
    [
        ("pause", True, "no task is running; there is nothing to pause"),
        ("cancel", True, "no task is running; there is nothing to cancel"),
        ("resume", False, "no task is paused; there is nothing to resume"),
        ("stop", True, "no task is running; stopping dog-1, dog-2 all the same"),
    ],
)
def test_an_idle_fleet_is_told_so(home: Flat, verb: str, ok: bool, text: str) -> None:
    assert _say(home, verb) == ControlReply(ok=ok, text=text)


def test_a_task_by_name(home: Flat) -> None:
    home.ask()
    assert _say(home, "pause", "t-9") == ControlReply(ok=False, text="there is no task t-9; running or waiting: t-1")
    home.until_end()
    assert _say(home, "pause", "t-1") == ControlReply(ok=False, text="t-1 has ended: done; there is nothing to pause")


def test_asking_again_changes_nothing(home: Flat) -> None:
    home.ask()
    home.mesh.run(1.0)
    assert _say(home, "resume").text == "t-1 is not paused: it is running"
    assert [_say(home, "pause").ok, _say(home, "pause").ok] == [True, True]
    home.mesh.run(3.0)
    assert _say(home, "pause").text == "t-1 is paused already"
    assert _say(home, "resume").text == "t-1 goes on"
    assert home.until_end().status == "done"


def test_a_pause_that_is_taken_back_at_once(home: Flat) -> None:
    home.ask()
    home.mesh.run(1.0)
    home.robots[0].deaf = home.robots[1].deaf = True
    _say(home, "pause")
    assert _say(home, "resume") == ControlReply(ok=True, text="t-1 goes on")
    assert home.until_end().status == "done"


def test_a_pause_does_not_undo_a_stop(home: Flat) -> None:
    home.ask()
    home.mesh.run(1.0)
    home.robots[0].deaf = home.robots[1].deaf = True
    _say(home, "stop")
    assert _say(home, "pause") == ControlReply(ok=False, text="t-1 is being cancelled")
    assert home.until_end().status == "cancelled"


def test_every_decision_is_a_line_in_the_log(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    failing = iter(["blocked"])
    home = Flat(fetch, fail=lambda c: next(failing, None) if c.action == "pickup" else None)
    home.mesh.run(3.0)
    caplog.set_level(logging.INFO, "hub")
    home.ask()
    home.mesh.run(2.0)
    _say(home, "pause")
    home.mesh.run(2.0)
    _say(home, "resume")
    home.until_end()
    lines = [record.getMessage() for record in caplog.records if record.name == "hub"]
    for words in (
        "asked: put the apple in the fridge",
        "plan: plan p-1: 3 nodes",
        "command: t-1-e0-1 dog-1 take pickup Apple obj-",
        "halt: pause: paused by the operator",
        "replan: resumed",
        "halt: replan: dog-1 could not pickup obj-",
        ": blocked",
        "node: put done: dog-1 put Apple obj-",
        "end: done: all goals hold",
    ):
        assert any(words in line for line in lines), (words, lines)
    assert all(line.startswith("t-1 at ") and "\n" not in line and len(line) < 300 for line in lines)
    assert len(lines) == sum(1 for _ in home.hub._journal.log())
    assert home.mesh.call("task_query", TaskQuery()).status == "done"


def test_a_task_tells_the_time_since_it_was_given() -> None:
    """On the wall's clock the time since 1970 would stand there."""
    task = Task("t-1", "open the fridge", 1_795_809_936.2)
    task.say(1_795_809_936.2, "asked: open the fridge")
    task.say(1_795_809_941.1, "refused: no robot is there")
    assert list(task.log) == ["0.0 s: asked: open the fridge", "4.9 s: refused: no robot is there"]
