"""How near to the best the schedules are: makespans of greedy, of our search and of CP-SAT, in one run.

`python -m planners.bench_schedule [--json] [--seeds N] [--limit-s S]`; CP-SAT needs the extra `bench` (ortools).
"""

import argparse
import importlib.util
import json
import statistics
import sys
import time
from random import Random
from typing import Any

from planners.tasks.schedule import Problem, Sequences, Shift, Timing, Wait, evaluate, greedy, schedule

CASES = ((6, 3), (10, 3), (16, 3), (16, 5))
"""Jobs and robots."""
SIDE_M, SPEED_MPS = 14.0, 0.5


def make_problem(seed: int, jobs: int, robots: int) -> Problem:
    """Errands in a home: carry something, switch something, two of them into a fridge that somebody must open."""
    rng = Random(f"{seed} {jobs} {robots}")

    def point() -> tuple[float, float]:
        return rng.uniform(0.0, SIDE_M), rng.uniform(0.0, SIDE_M)

    def way_s(a: tuple[float, float], b: tuple[float, float]) -> float:
        return float(round((abs(a[0] - b[0]) + abs(a[1] - b[1])) / SPEED_MPS))

    fridge = point()
    entries, exits, shifts = [fridge], [fridge], [Shift(6.0, tuple(range(robots)))]
    for index in range(1, jobs):
        start, end = point(), fridge if index <= 2 else point()
        if index % 4 == 3:
            end = start
        carry_s = way_s(start, end)
        duration = 5.0 if index % 4 == 3 else 14.0 + carry_s
        waits = (Wait(0, 7.0 + carry_s),) if index <= 2 else ()
        entries.append(start)
        exits.append(end)
        shifts.append(Shift(duration, tuple(range(robots)), waits))
    starts = [point() for _ in range(robots)]
    return Problem(
        tuple(shifts),
        tuple(tuple(way_s(start, entry) for entry in entries) for start in starts),
        tuple(tuple(way_s(end, entry) for entry in entries) for end in exits),
    )


def solve_exactly(problem: Problem, hint: Timing, limit_s: float) -> Timing | None:
    """CP-SAT on the same problem and objective: a circuit of optional jobs for each robot."""
    from ortools.sat.python import cp_model

    model = cp_model.CpModel()
    jobs = range(len(problem.shifts))
    begin = [model.new_int_var(0, 5000, "") for _ in jobs]
    end = [begin[j] + int(problem.shifts[j].duration_s) for j in jobs]
    makespan = model.new_int_var(0, 5000, "")
    travel: list[Any] = []
    visited: dict[int, list[Any]] = {j: [] for j in jobs}
    arcs_of: list[dict[tuple[int, int], Any]] = []
    for robot in range(problem.robots):
        arcs: dict[tuple[int, int], Any] = {(0, 0): model.new_bool_var("")}
        for j in jobs:
            arcs[j + 1, j + 1] = model.new_bool_var("")
            visited[j].append(arcs[j + 1, j + 1].negated())
            arcs[j + 1, 0] = model.new_bool_var("")
            for i in (-1, *jobs):
                if i == j:
                    continue
                arc = arcs[i + 1, j + 1] = model.new_bool_var("")
                way = int(problem.start_s[robot][j] if i < 0 else problem.way_s[i][j])
                model.add(begin[j] >= way + (0 if i < 0 else end[i])).only_enforce_if(arc)
                travel.append(way * arc)
        model.add_circuit([(a, b, arc) for (a, b), arc in arcs.items()])
        arcs_of.append(arcs)
    for j in jobs:
        model.add_exactly_one(visited[j])
        model.add(makespan >= end[j])
        model.add_hint(begin[j], int(hint.begin_s[j]))
        for wait in problem.shifts[j].waits:
            model.add(begin[j] + int(wait.offset_s) >= end[wait.job])
    model.minimize(20 * makespan + sum(travel))
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds = limit_s
    solver.parameters.num_workers = 2
    if solver.solve(model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    return evaluate(problem, [_follow(arcs, solver) for arcs in arcs_of])


def _follow(arcs: dict[tuple[int, int], Any], solver: Any) -> list[int]:
    """One robot's list of jobs from the arcs that were chosen."""
    following = {a: b for (a, b), arc in arcs.items() if a != b and solver.value(arc)}
    jobs, at = [], following.get(0, 0)
    while at:
        jobs.append(at - 1)
        at = following[at]
    return jobs


def measure(seeds: int, limit_s: float) -> dict[str, Any]:
    """Ratios to the best makespan found by any method, by case."""
    exact = importlib.util.find_spec("ortools") is not None
    report: dict[str, Any] = {"cp_sat": exact, "limit_s": limit_s, "seeds": seeds, "cases": []}
    for jobs, robots in CASES:
        ratios: dict[str, list[float]] = {"greedy": [], "search": [], "cp_sat": []}
        took_s: list[float] = []
        for seed in range(seeds):
            problem = make_problem(seed, jobs, robots)
            found, search_s = _methods(problem, limit_s, exact)
            took_s.append(search_s)
            best = min(timing.makespan_s for timing in found.values())
            for name, timing in found.items():
                ratios[name].append(timing.makespan_s / best)
        row = {n: {"median": statistics.median(r), "max": max(r)} for n, r in ratios.items() if r}
        report["cases"].append({"jobs": jobs, "robots": robots, "search_s": statistics.median(took_s), "ratio": row})
    return report


def _methods(problem: Problem, limit_s: float, exact: bool) -> tuple[dict[str, Timing], float]:
    start: Sequences = greedy(problem)
    began = time.perf_counter()
    _, searched = schedule(problem)
    took_s = time.perf_counter() - began
    first = evaluate(problem, start)
    assert first is not None
    found = {"greedy": first, "search": searched}
    if exact:
        solved = solve_exactly(problem, searched, limit_s)
        if solved is not None:
            found["cp_sat"] = solved
    return found, took_s


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="the whole report as JSON")
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--limit-s", type=float, default=8.0, help="seconds that CP-SAT may take for one problem")
    arguments = parser.parse_args()
    report = measure(arguments.seeds, arguments.limit_s)
    if arguments.json:
        sys.stdout.write(json.dumps(report, indent=2) + "\n")
        return
    if not report["cp_sat"]:
        sys.stdout.write("ortools is not installed (extra `bench`): compared with greedy alone\n")
    for case in report["cases"]:
        ratios = ", ".join(f"{n} {r['median']:.3f} (max {r['max']:.2f})" for n, r in case["ratio"].items())
        sys.stdout.write(f"{case['jobs']} jobs, {case['robots']} robots: makespan to the best {ratios}\n")


if __name__ == "__main__":
    main()
