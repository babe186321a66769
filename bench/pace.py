"""How much faster than real time a mesh of real processes runs, read off the evaluator's clock."""

import time
from pathlib import Path

from console.bring_up import bring_up
from console.client import Client
from wire.messages.truth import JudgeReply, JudgeRequest


def times_real_time(site_file: Path, warm_up_s: float, measure_s: float) -> float:
    """Bring the site up, let it run, and compare simulated with wall-clock seconds."""
    ready = bring_up(site_file, quiet=True)
    try:
        with Client(ready.site, ready.mesh.credentials_dir, "evaluator") as evaluator:
            time.sleep(warm_up_s)
            began, before_s = time.monotonic(), evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
            time.sleep(measure_s)
            after_s = evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
            return (after_s - before_s) / (time.monotonic() - began)
    finally:
        ready.mesh.stop()
