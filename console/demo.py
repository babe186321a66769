"""The demonstration: a generated home, its mesh, one instruction, judged from the world as it is."""

import json
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from console.bring_up import Ready, bring_up
from console.client import Client
from console.floor_map import FloorMap
from console.output import terminal
from console.places import flying, free_port, generate_home
from console.task import RUNNING, run_task
from deploy.launch import ProcessInfo
from wire.costs import STAND_IN
from wire.messages.command import RobotReport
from wire.messages.goal import Goal, Selector
from wire.messages.operator import TaskState
from wire.messages.truth import JudgeReply, JudgeRequest
from wire.messages.world import SnapshotRequest, WorldState
from wire.model import Vec2
from wire.site import Site


@dataclass
class Run:
    """What one demonstration left behind."""

    task: TaskState
    judged: JudgeReply
    world: WorldState
    trails: dict[str, list[Vec2]]
    wall_s: float
    sim_s: float
    ended: list[ProcessInfo] = field(default_factory=list)


def demonstrate(
    seed: int, out: Path, instruction: str | None, limit_s: float, keep: bool, quiet: bool, drones: int
) -> dict[str, Any]:
    """Bring a home up, do one instruction, write summary.json, run.rrd and map.png; returns the summary.

    With a drone the scene's own task is followed by a look from above, judged as the rest is.
    """
    out.mkdir(parents=True, exist_ok=True)
    recording = (out / "run.rrd").resolve()
    recording.unlink(missing_ok=True)
    if not quiet:
        terminal.print(f"generating the home of seed {seed} ...", markup=False)
    site_file = generate_home(
        seed, out / "site.toml", "--name", f"demo-{seed}", "--port", str(free_port()),
        "--view-port", str(free_port()), "--save", str(recording), *flying(drones),
    )  # fmt: skip
    ready = bring_up(site_file, quiet=quiet)
    try:
        run = _run(ready, instruction, limit_s, quiet)
    finally:
        ended = [] if keep else ready.mesh.stop()
    run.ended = ended
    summary = _summary(seed, run)
    (out / "summary.json").write_text(json.dumps(summary, indent=2, sort_keys=True) + "\n")
    _draw(ready, run, out / "map.png")
    return summary


def _run(ready: Ready, instruction: str | None, limit_s: float, quiet: bool) -> Run:
    began = time.monotonic()
    trails: dict[str, list[Vec2]] = {}

    def trace(report: RobotReport) -> None:
        trail = trails.setdefault(report.robot, [])
        here = report.position_enu_m[:2]
        if not trail or abs(here[0] - trail[-1][0]) + abs(here[1] - trail[-1][1]) > 0.08:
            trail.append(here)

    with (
        Client(ready.site, ready.mesh.credentials_dir, "evaluator") as evaluator,
        Client(ready.site, ready.mesh.credentials_dir) as client,
    ):
        before = evaluator.ask("judge", JudgeRequest(), JudgeReply)
        asked = before.task if instruction is None else None
        words = instruction or before.task.instruction
        look = _look_from_above(ready.site) if asked is not None else None
        words = f"{words}, and {look.text}" if look is not None else words
        if not quiet:
            terminal.print(f"\ninstruction: {words}\n", markup=False)
        client.on("robot_report", RobotReport, trace)
        final = run_task(client, words, limit_s, quiet)
        goals = (*asked.goals, *((look,) if look is not None else ())) if asked else tuple(g.goal for g in final.goals)
        judged = evaluator.ask("judge", JudgeRequest(goals=goals, since_s=before.stamp_s), JudgeReply)
        world = client.ask("snapshot", SnapshotRequest(), WorldState)
    return Run(final, judged, world, trails, time.monotonic() - began, judged.sim_s - before.sim_s)


def _look_from_above(site: Site) -> Goal | None:
    """What a drone is asked for, where there is one."""
    if all(robot.kind != "drone" for robot in site.robot):
        return None
    room = next((room for room in site.room if room.kind == "Kitchen"), site.room[0])
    selector = Selector(room=room.id)
    return Goal(predicate="seen_from_above", subject=selector, text=f"inspect the {room.name} from above")


def _summary(seed: int, run: Run) -> dict[str, Any]:
    task = run.task
    return {
        "seed": seed,
        "instruction": task.instruction,
        "success": run.judged.success and bool(run.judged.goals),
        "judged_by": "the evaluator, from ground truth",
        "task_status": task.status,
        "reason": _reason(task),
        "goals": [
            {
                "goal": g.goal.text or g.goal.predicate,
                "predicate": g.goal.model_dump(mode="json"),
                "true": g.holds,
                "note": g.note,
            }
            for g in run.judged.goals
        ],
        "planner": task.planner,
        "planner_note": task.planner_note,
        "plan_nodes": task.nodes_total,
        "plan_nodes_done": task.nodes_done,
        "replans": task.replans,
        "fails": task.fails,
        "action_steps": task.action_steps,
        "path_m": round(task.path_m, 2),
        "tokens": task.prompt_tokens + task.completion_tokens,
        "stand_in": task.stand_in,
        "collisions": run.judged.collisions,
        "sim_s": round(run.sim_s, 2),
        "wall_s": round(run.wall_s, 2),
        "times_real_time": round(run.sim_s / run.wall_s, 2) if run.wall_s > 0 else None,
        "processes": {p.id: {"state": p.state.lower(), "exit_code": p.exit_code} for p in run.ended},
    }


def _reason(task: TaskState) -> str:
    if task.refusal is not None:
        return task.refusal.reason
    return "it took too long and was given up" if task.status in RUNNING else task.reason


def _draw(ready: Ready, run: Run, path: Path) -> None:
    picture = FloorMap(ready.site)
    picture.draw_house()
    picture.draw_paths(run.trails)
    picture.draw_cameras()
    picture.draw_objects(run.world)
    picture.draw_legend()
    picture.draw_title(
        f"{run.task.instruction}: {'done' if run.judged.success else 'not done'}, {run.task.path_m:.0f} m"
    )
    picture.save(path)


def summary_text(summary: dict[str, Any], out: Path) -> str:
    goals = "\n".join(
        f"  {'yes' if g['true'] else 'NO':<4}{': '.join(filter(None, (g['goal'], g['note'])))}"
        for g in summary["goals"]
    )
    tokens = f"{summary['tokens']} tokens{' ' + STAND_IN if summary['stand_in'] else ''}"
    verdict = "succeeded" if summary["success"] else f"FAILED ({summary['reason'] or summary['task_status']})"
    return (
        f"\n{summary['instruction']}\n{verdict}, judged from the world as it is\n{goals}\n"
        f"  planner {summary['planner']}, {summary['plan_nodes']} plan nodes, {summary['replans']} replans, "
        f"{summary['action_steps']} action steps, {summary['path_m']} m, {tokens}\n"
        f"  {summary['sim_s']} simulated s in {summary['wall_s']} s ({summary['times_real_time']} x real time)\n"
        f"  {out}/summary.json  {out}/map.png  {out}/run.rrd (open with: .venv/bin/rerun {out}/run.rrd)"
    )
