"""The whole mesh on real processes: pictures to robots, a hub that is killed in the middle, a verdict from the truth."""

import json
import os
import signal
import sqlite3
import time
from collections import Counter
from pathlib import Path

import pytest

from console.bring_up import Ready, bring_up
from console.client import Client
from console.demo import demonstrate
from console.places import free_port, generate_home
from console.task import HUB_BACK_TRIES
from wire.messages.command import Command
from wire.messages.operator import TaskQuery, TaskRequest, TaskState
from wire.messages.truth import JudgeReply, JudgeRequest

pytestmark = [pytest.mark.walk, pytest.mark.timeout(400)]
SEED = 0
ONCE = ("pickup", "put", "open", "close", "toggle_on", "toggle_off")


def _query(client: Client) -> TaskState:
    return client.ask("task_query", TaskQuery(task="task-1"), TaskState)


def _wait_until_some_steps_are_done(client: Client, ready: Ready) -> None:
    deadline = time.monotonic() + 150
    while not _done_steps(ready.mesh.run_dir):
        assert time.monotonic() < deadline, "no step was done in time"
        assert _query(client).status in ("planning", "running")
        time.sleep(0.2)


def _done_steps(run_dir: Path) -> Counter[tuple[str, str]]:
    """(action, object) of every handling that a robot has finished, from the robots' own journals."""
    steps: Counter[tuple[str, str]] = Counter()
    for file in sorted(run_dir.glob("dog-*.sqlite")):
        connection = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
        for (row,) in connection.execute("SELECT command FROM goals WHERE status = 'done'"):
            command = Command.model_validate_json(row)
            if command.action in ONCE:
                thing = command.item if command.action == "put" else command.target
                steps[(command.action, thing.id if thing else "")] += 1
        connection.close()
    return steps


def test_a_killed_hub_goes_on_and_repeats_no_finished_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site_file = generate_home(
        SEED, tmp_path / "site.toml", "--name", "killed", "--port", str(free_port()), "--view-port", str(free_port())
    )
    monkeypatch.setenv("PYTHONPATH", str(Path.cwd()))
    ready = bring_up(site_file, quiet=True)
    try:
        with Client(ready.site, ready.mesh.credentials_dir, "evaluator") as evaluator:
            words = evaluator.ask("judge", JudgeRequest(), JudgeReply).task.instruction
            with Client(ready.site, ready.mesh.credentials_dir) as client:
                client.ask("task", TaskRequest(task="task-1", instruction=words), TaskState)
                _wait_until_some_steps_are_done(client, ready)
                hub = {p.id: p.pid for p in ready.mesh.processes()}["hub"]
                before = _done_steps(ready.mesh.run_dir)
                os.kill(hub, signal.SIGKILL)
                deadline = time.monotonic() + 200
                while (state := client.ask("task_query", TaskQuery(task="task-1"), TaskState, tries=HUB_BACK_TRIES)).status in (
                    "planning", "running",
                ):  # fmt: skip
                    assert time.monotonic() < deadline, state.log
                    time.sleep(0.5)
            judged = evaluator.ask("judge", JudgeRequest(), JudgeReply)
        after = _done_steps(ready.mesh.run_dir)
    finally:
        ready.mesh.stop()
    assert state.status == "done", (state.reason, state.log)
    assert judged.success, [(g.goal.text, g.holds) for g in judged.goals]
    assert all(after[step] == times for step, times in before.items()), "a finished step was done again"


def test_the_demo_succeeds_and_leaves_its_pictures_and_summary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path.cwd()))
    summary = demonstrate(SEED, tmp_path, None, limit_s=300.0, keep=False, quiet=True, drones=1)
    assert json.loads((tmp_path / "summary.json").read_text()) == summary
    assert summary["success"], summary
    assert summary["tokens"] == 0
    assert summary["planner"] == "scripted"
    assert summary["path_m"] > 5.0
    assert all(p["exit_code"] == 0 for p in summary["processes"].values()), summary["processes"]
    assert (tmp_path / "map.png").stat().st_size > 20_000
    assert (tmp_path / "run.rrd").stat().st_size > 100_000
