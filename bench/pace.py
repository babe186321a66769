"""How much faster than real time a mesh of real processes runs, read off the evaluator's clock, and what it costs."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from console.bring_up import Ready, bring_up
from console.client import Client
from wire.messages.truth import JudgeReply, JudgeRequest

Meanwhile = Callable[[Ready, float], None]
"""What goes on while a mesh is measured, for so many seconds of the wall."""


def look_on(ready: Ready, seconds: float) -> None:
    """Nobody asks for anything."""
    time.sleep(seconds)


@dataclass(frozen=True)
class Pace:
    times_real_time: float
    simulated_s: float
    cpu_share: dict[str, float]
    """Of each process: seconds of processor time for a simulated second. Depends far less than the pace on what else runs."""


def pace(site_file: Path, warm_up_s: float, measure_s: float, meanwhile: Meanwhile = look_on) -> Pace:
    """Bring the site up, let it run, and compare simulated with wall-clock and processor seconds."""
    ready = bring_up(site_file, quiet=True)
    try:
        pids = {process.id: process.pid for process in ready.mesh.processes() if process.pid}
        with Client(ready.site, ready.mesh.credentials_dir, "evaluator") as evaluator:
            time.sleep(warm_up_s)
            began, before_s = time.monotonic(), evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
            used_before_s = {id: cpu_s(pid) for id, pid in pids.items()}
            meanwhile(ready, measure_s)
            after_s = evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
            passed_s = after_s - before_s
            used_s = {id: cpu_s(pid) - used_before_s[id] for id, pid in pids.items()}
            wall_s = time.monotonic() - began
            return Pace(passed_s / wall_s, passed_s, {id: used / passed_s for id, used in used_s.items()})
    finally:
        ready.mesh.stop()


def times_real_time(site_file: Path, warm_up_s: float, measure_s: float) -> float:
    return pace(site_file, warm_up_s, measure_s).times_real_time


def cpu_s(pid: int) -> float:
    """Processor time that a process has used so far, in all its threads."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
