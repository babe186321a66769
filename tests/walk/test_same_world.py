"""One episode over real processes, the real router and its access control ends in the world that it ends in in memory.

In lockstep an operator is the only thing outside the clock: which tick his words reach is up to the machine. So the
processes go first, and what depends on chance is read from what they answered: the hub says at which tick it took
the task, and the answers about the world and the verdict carry the time for which they hold. The run in memory is then
asked the same things at the same ticks. Nothing has to be left out of the comparison, and no part of the product needs
a way to start a task at a set time for a test's sake.

Equal to the last bit are: the task with its log; every object, robot and room of the fused world, with all positions,
confidences, sources and stamps; the verdict from the ground truth; every row of every journal; and every message that
a recorder may hear, from the first whole tick that it heard to the verdict.
"""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

import pytest

from bench.episode import journal_digest, make_mesh
from console.bring_up import Ready, bring_up
from console.client import Client
from console.places import free_port, generate_home
from console.task import RUNNING
from wire.keys import TOPICS, Role
from wire.link import CREDENTIALS_VARIABLE
from wire.loopback import LoopbackMesh
from wire.messages.goal import Goal
from wire.messages.operator import TaskQuery, TaskRequest, TaskState
from wire.messages.truth import JudgeReply, JudgeRequest
from wire.messages.world import SnapshotRequest, WorldState
from wire.model import Message
from wire.paths import id_in
from wire.recording import Record, read_recording
from wire.site import Clock, Site, load_site

pytestmark = [pytest.mark.walk, pytest.mark.timeout(400)]
HOME, ROBOTS, WORDS = 37, "2", "turn on the TV"
SETTLE_S = 2.0
"""So long the cameras have looked when the task comes: it then takes about ten simulated seconds."""
STEP_S = Clock().step_s
TASK = TaskRequest(task="task-1", instruction=WORDS)
LOOKER_ON = 'id = "view"\nrole = "view"\nmodule = "hub.view"\n'
RECORDED = [topic.path for topic in TOPICS if "view" in topic.subscribers and topic.name != "tick"]


@dataclass(frozen=True)
class End:
    """How an episode ended."""

    task: TaskState
    world: WorldState
    judged: JudgeReply
    journals: str


def write_home(folder: Path) -> Path:
    """Without the view, which follows no ticks and writes nothing that could be compared."""
    file = generate_home(
        HOME, folder / "site.toml", "--name", "same-world", "--robots", ROBOTS, "--port", str(free_port())
    )
    text = file.read_text()
    assert text.count(LOOKER_ON) == 1
    file.write_text(text.replace(LOOKER_ON, f"{LOOKER_ON}autostart = false\n"))
    return file


def test_over_processes_it_ends_as_in_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path.cwd()))
    home = write_home(tmp_path)
    walked = walk(home, tmp_path / "walked")
    said: list[Record] = []
    remembered = in_memory(load_site(home), tmp_path / "state", walked, said)
    assert walked.task.status == "done", walked.task.log
    assert walked.task == remembered.task
    assert walked.world == remembered.world
    assert walked.judged == remembered.judged
    assert walked.journals == remembered.journals
    assert first_difference(tmp_path / "walked", said, walked.task.started_s, walked.judged.stamp_s) is None


def walk(home: Path, recording: Path) -> End:
    ready = bring_up(home, quiet=True)
    try:
        with (
            recorder(ready, recording),
            Client(ready.site, ready.mesh.credentials_dir) as client,
            Client(ready.site, ready.mesh.credentials_dir, "evaluator") as evaluator,
        ):
            task = client.ask("task", TASK, TaskState)
            deadline = time.monotonic() + 300
            while task.status in RUNNING:
                assert time.monotonic() < deadline, task.log
                time.sleep(0.2)
                task = client.ask("task_query", TaskQuery(task=TASK.task), TaskState)
            world = client.ask("snapshot", SnapshotRequest(), WorldState)
            judged = evaluator.ask("judge", JudgeRequest(goals=goals_of(task)), JudgeReply)
            wait_for_record(recording, judged.stamp_s)  # then all that was said up to the verdict is recorded
    finally:
        ready.mesh.stop()
    return End(task, world, judged, journal_digest(ready.mesh.run_dir))


def in_memory(site: Site, state: Path, walked: End, said: list[Record]) -> End:
    """The same cores in this process, asked at the ticks at which the walked ones answered."""
    mesh = make_mesh(site, state, lambda *row: said.append(Record(*row)))
    ask_at(mesh, walked.task.started_s, "task", TASK)
    task = ask_at(mesh, walked.task.stamp_s, "task_query", TaskQuery(task=TASK.task))
    world = ask_at(mesh, walked.world.stamp_s, "snapshot", SnapshotRequest(), "view")
    judged = ask_at(mesh, walked.judged.stamp_s, "judge", JudgeRequest(goals=goals_of(walked.task)), "evaluator")
    mesh.close()
    assert isinstance(task, TaskState)
    assert isinstance(world, WorldState)
    assert isinstance(judged, JudgeReply)
    return End(task, world, judged, journal_digest(state))


def ask_at(mesh: LoopbackMesh, stamp_s: float, service: str, request: Message, role: Role = "console") -> Message:
    """Ask so that the question is handed over at the tick of this time."""
    while mesh.now_s < stamp_s - 1.5 * STEP_S:
        mesh.tick()
    return mesh.call(service, request, role=role)


def goals_of(task: TaskState) -> tuple[Goal, ...]:
    return tuple(state.goal for state in task.goals)


@contextmanager
def recorder(ready: Ready, out: Path) -> Iterator[None]:
    """A process that records, from some time before the body of the `with` to its end."""
    command = [sys.executable, "-m", "wire.recorder", "--site", str(ready.mesh.site_file), "--out", str(out)]
    environment = {**os.environ, CREDENTIALS_VARIABLE: str(ready.mesh.credentials_dir)}
    process = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
    try:
        wait_for_record(out, SETTLE_S)
        yield
    finally:
        process.terminate()
        process.wait(20)


def wait_for_record(recording: Path, after_s: float) -> None:
    deadline = time.monotonic() + 60
    while not recording.exists() or not any(row.now_s > after_s for row in read_recording(recording)):
        assert time.monotonic() < deadline, f"nothing was recorded after {after_s} s"
        time.sleep(0.2)


def first_difference(
    recording: Path, said: list[Record], started_s: float, end_s: float
) -> tuple[Record | None, Record | None] | None:
    """What was recorded beside what was said in memory, from the first whole tick on; None when all is equal."""
    recorded = list(read_recording(recording))
    joined_s = min(row.now_s for row in recorded)
    assert joined_s < started_s, "the recording has the whole task"
    spans = [sorted(span(rows, joined_s, end_s), key=order) for rows in (recorded, said)]
    assert {"cam-1", "dog-1", "dog-2"} <= {row.key.removeprefix("observation/") for row in spans[0]}
    pairs = zip_longest(*spans)
    return next((pair for pair in pairs if pair[0] != pair[1]), None)


def span(rows: list[Record], joined_s: float, end_s: float) -> list[Record]:
    """What a recorder may hear, without the tick in whose middle it came."""
    return [row for row in rows if joined_s < row.now_s <= end_s and is_recorded(row)]


def is_recorded(row: Record) -> bool:
    return any(id_in("", path, f"/{row.key}") is not None for path in RECORDED)


def order(row: Record) -> tuple[int, str, str]:
    """Two senders' messages of one tick come in any order; one sender's on one key in his."""
    return (row.tick, row.sender, row.key)
