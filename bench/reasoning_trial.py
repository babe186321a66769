"""One home, one planner, one error rate: an episode with the hub, real devices and pictures, judged by the simulator.

`python -m bench.reasoning_trial --planner single_shot --home 6 --rate 0.1` prints one line of JSON.
"""

import argparse
import json
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.emulated import emulated_model
from bench.episode import run_episode
from console.places import generate_home
from wire.planner_table import Budget, PlannerChoice
from wire.site import load_site

LIMIT_S = 420.0
"""Simulated seconds after which an episode has failed."""
BUDGET = Budget(tokens=200_000, calls=200, seconds=3600.0)
"""What it costs is measured here, not bounded."""
_KEPT = ("status", "reason", "planner", "replans", "fails", "path_m", "action_steps", "prompt_tokens", "completion_tokens",
         "model_calls", "stand_in", "instruction")  # fmt: skip


def run_trial(
    planner: str, home: int, rate: float, robots: int, host: str = "", model: str = "qwen3:8b"
) -> dict[str, Any]:
    """`host`: of a real model, which makes its own errors; else the emulated one makes them at `rate`."""
    with TemporaryDirectory(prefix="r2x-reasoning-") as folder, ExitStack() as stack:
        file = generate_home(home, Path(folder) / "site.toml", "--robots", str(robots))
        url = host or stack.enter_context(emulated_model(rate, home))
        choice = PlannerChoice(name=planner, model=model, host=url, grammar=False, fallback=False, budget=BUDGET)
        site = load_site(file).model_copy(update={"planner": choice})
        result = run_episode(site, Path(folder), None, LIMIT_S)
    task = {name: result["task"][name] for name in _KEPT}
    return {"planner": planner, "home": home, "rate": rate, **_judged(result), "task": task}


def _judged(result: dict[str, Any]) -> dict[str, Any]:
    goals = [goal["true"] for goal in result["goals"]]
    return {
        "success": result["success"],
        "goals_true": sum(goals),
        "goals": len(goals),
        "collisions": result["collisions"],
        "sim_s": round(result["sim_s"], 2),
        "wall_s": round(result["wall_s"], 1),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--planner", required=True)
    parser.add_argument("--home", type=int, required=True)
    parser.add_argument("--rate", type=float, default=0.0)
    parser.add_argument("--robots", type=int, default=2)
    parser.add_argument("--host", default="")
    parser.add_argument("--model", default="qwen3:8b")
    given = parser.parse_args()
    print(json.dumps(run_trial(given.planner, given.home, given.rate, given.robots, given.host, given.model)))


if __name__ == "__main__":
    main()
