"""One whole episode in one process: the same cores over the in-memory mesh, in lockstep, as fast as they are.

`python -m bench.episode --seed 7 [--robots N] [--instruction TEXT] [--record FILE] [--json]`

Two runs say the same bytes: their `wire_sha256` and `journal_sha256` are equal. Should they ever not be, two recordings
tell which message differs first.
"""

import argparse
import hashlib
import importlib
import json
import os
import sqlite3
import time
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from console.places import generate_home
from console.task import task_document
from wire.bus import Core
from wire.loopback import LoopbackMesh, Recorder
from wire.messages.goal import Goal
from wire.messages.operator import TaskQuery, TaskRequest, TaskState
from wire.messages.truth import JudgeReply, JudgeRequest
from wire.recording import RecordingWriter
from wire.site import STATE_VARIABLE, Process, Site, load_site

_RUNNING = ("planning", "running", "paused")
_CORE_ROLES = ("sim", "hub", "planner", "cctv", "robot")


def build_core(site: Site, row: Process) -> Core:
    """The core that this row of the process table runs."""
    core: Core = importlib.import_module(f"{row.module}.__main__").build(site, row.id)
    return core


def make_mesh(site: Site, state: Path, recorder: Recorder | None = None) -> LoopbackMesh:
    """All cores of a site on one in-memory mesh; `state` takes their journals."""
    os.environ[STATE_VARIABLE] = str(state)
    mesh = LoopbackMesh(site.clock.step_s, recorder)
    for row in site.process:
        if row.role != "router" and row.role in _CORE_ROLES:
            mesh.add(build_core(site, row), row.id, row.role, owner=row.role == "sim")
    return mesh


def run_episode(
    site: Site,
    state: Path,
    instruction: str | None,
    limit_s: float,
    record: Recorder | None = None,
    settle_s: float = 2.0,
) -> dict[str, Any]:
    """Do one instruction (the scene's own by default) and judge it; `record` is handed everything that is published."""
    wire_hash = hashlib.sha256()

    def note(now_s: float, key: str, sender: str, tick: int, payload: bytes) -> None:
        wire_hash.update(f"{now_s:.3f} {tick} {sender} {key} ".encode() + payload)
        if record is not None:
            record(now_s, key, sender, tick, payload)

    mesh = make_mesh(site, state, note)
    began = time.perf_counter()
    mesh.run(settle_s)
    before = _judge(mesh)
    task = mesh.call("task", TaskRequest(task="task-1", instruction=instruction or before.task.instruction))
    while isinstance(task, TaskState) and task.status in _RUNNING and mesh.now_s < limit_s:
        mesh.run(1.0)
        task = mesh.call("task_query", TaskQuery(task="task-1"))
    assert isinstance(task, TaskState)
    asked = None if instruction is None else tuple(g.goal for g in task.goals)
    judged = _judge(mesh, asked, before.stamp_s)
    wall_s = time.perf_counter() - began
    sim_s = mesh.now_s
    mesh.close()
    return {
        "success": judged.success,
        "goals": [{"goal": g.goal.text or g.goal.predicate, "true": g.holds, "note": g.note} for g in judged.goals],
        "task": task_document(task),
        "collisions": judged.collisions,
        "sim_s": sim_s,
        "wall_s": wall_s,
        "times_real_time": sim_s / wall_s,
        "wire_sha256": wire_hash.hexdigest(),
        "journal_sha256": journal_digest(state),
    }


def _judge(mesh: LoopbackMesh, goals: tuple[Goal, ...] | None = None, since_s: float = 0.0) -> JudgeReply:
    """Of the scene's own task without goals."""
    reply = mesh.call("judge", JudgeRequest(goals=goals, since_s=since_s), role="evaluator")
    assert isinstance(reply, JudgeReply)
    return reply


def journal_digest(state: Path) -> str:
    """One digest of every row of every journal under `state`."""
    digest = hashlib.sha256()
    for file in sorted(state.glob("**/*.sqlite*")):
        if not file.name.endswith((".sqlite", ".sqlite3")):
            continue
        connection = sqlite3.connect(file)
        for line in connection.iterdump():
            digest.update(line.encode())
        connection.close()
    return digest.hexdigest()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--robots", type=int, default=3)
    parser.add_argument("--instruction", default=None)
    parser.add_argument("--limit-s", type=float, default=600.0)
    parser.add_argument("--record", type=Path, default=None, help="a recording of everything that is said")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    with TemporaryDirectory(prefix="r2x-episode-") as folder, ExitStack() as stack:
        home = generate_home(arguments.seed, Path(folder) / "site.toml", "--robots", str(arguments.robots))
        record = stack.enter_context(RecordingWriter(arguments.record)).write if arguments.record else None
        result = run_episode(load_site(home), Path(folder), arguments.instruction, arguments.limit_s, record)
    print(json.dumps(result, indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
