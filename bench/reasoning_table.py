"""Trials summed up: for each planner and error rate how many episodes succeeded, and what that cost."""

from collections.abc import Sequence
from math import sqrt
from statistics import median
from typing import Any

Trial = dict[str, Any]
_Z = 1.96


def summary(trials: Sequence[Trial]) -> list[dict[str, Any]]:
    """One row for each planner and rate, in the order in which they come."""
    cells: dict[tuple[str, float], list[Trial]] = {}
    for trial in trials:
        cells.setdefault((trial["planner"], trial["rate"]), []).append(trial)
    return [_row(planner, rate, own) for (planner, rate), own in cells.items()]


def _row(planner: str, rate: float, trials: Sequence[Trial]) -> dict[str, Any]:
    tasks = [trial["task"] for trial in trials]
    good = sum(trial["success"] for trial in trials)
    low, high = interval(good, len(trials))
    return {
        "planner": planner,
        "rate": rate,
        "episodes": len(trials),
        "succeeded": good,
        "success_low": round(low, 3),
        "success_high": round(high, 3),
        "goals_true": round(sum(t["goals_true"] for t in trials) / sum(t["goals"] for t in trials), 3),
        "wrongly_done": sum(
            task["status"] == "done" and not t["success"] for task, t in zip(tasks, trials, strict=True)
        ),
        "calls": median(task["model_calls"] for task in tasks),
        "tokens": median(task["prompt_tokens"] + task["completion_tokens"] for task in tasks),
        "replans": median(task["replans"] for task in tasks),
        "path_m": round(median(task["path_m"] for task in tasks), 1),
        "sim_s": round(median(trial["sim_s"] for trial in trials), 1),
    }


def interval(good: int, number: int) -> tuple[float, float]:
    """Wilson's interval of a share, at 95 %."""
    share, spread = good / number, _Z * _Z / number
    middle = (share + spread / 2.0) / (1.0 + spread)
    half = _Z * sqrt(share * (1.0 - share) / number + spread / (4.0 * number)) / (1.0 + spread)
    return max(middle - half, 0.0), min(middle + half, 1.0)


def table_text(rows: Sequence[dict[str, Any]], label: str) -> str:
    """For people. `label`: where the answers came from."""
    head = (
        f"{'planner':<14}{'errors':>7}{'succeeded':>11}{'goals true':>12}{'wrongly done':>14}{'calls':>7}{'tokens':>9}"
    )
    lines = [label, f"{head}{'replans':>9}{'path':>9}"]
    for row in rows:
        share = f"{row['succeeded']}/{row['episodes']}"
        lines.append(
            f"{row['planner']:<14}{row['rate']:>7.0%}{share:>11}{row['goals_true']:>12.0%}{row['wrongly_done']:>14}{row['calls']:>7g}"
            f"{row['tokens']:>9g}{row['replans']:>9g}{row['path_m']:>7g} m"
        )
    return "\n".join(lines)
