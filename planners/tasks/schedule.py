"""Which robot does which job, in which order: a greedy start, then annealing by moving and swapping jobs.

One job at a time for each robot (one hand). The objective is 20 x the time until the last robot is done + the seconds
that all of them walk. The number of evaluations is fixed, so that the same jobs always get the same schedule.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, inf
from random import Random

MAKESPAN_WEIGHT = 20.0
EVALUATION_BUDGET = 60_000
"""Evaluated jobs in all: about 0.1 s."""
HOT, COLD = 100.0, 0.5
Sequences = list[list[int]]


@dataclass(frozen=True)
class Wait:
    """Another job must be done before this one is `offset_s` old."""

    job: int
    offset_s: float = 0.0


@dataclass(frozen=True)
class Shift:
    """One job for the schedule: how long it takes, who may do it, what it waits for."""

    duration_s: float
    robots: tuple[int, ...]
    waits: tuple[Wait, ...] = ()


@dataclass(frozen=True)
class Problem:
    """`start_s[r][j]`: robot r to job j's entry; `way_s[i][j]`: from the exit of job i to the entry of job j."""

    shifts: tuple[Shift, ...]
    start_s: tuple[tuple[float, ...], ...]
    way_s: tuple[tuple[float, ...], ...]

    @property
    def robots(self) -> int:
        return len(self.start_s)


@dataclass(frozen=True)
class Timing:
    """What comes of a schedule."""

    makespan_s: float
    travel_s: float
    begin_s: tuple[float, ...]
    robot_end_s: tuple[float, ...]

    @property
    def cost(self) -> float:
        return MAKESPAN_WEIGHT * self.makespan_s + self.travel_s


def evaluate(problem: Problem, sequences: Sequences) -> Timing | None:
    """Times of every job when each robot works through its list; None when robots wait for each other for ever."""
    shifts = problem.shifts
    end: list[float | None] = [None] * len(shifts)
    begin = [0.0] * len(shifts)
    clock = [0.0] * problem.robots
    at = [0] * problem.robots
    travel = 0.0
    left = sum(map(len, sequences))
    while left:
        moved = False
        for robot, jobs in enumerate(sequences):
            while at[robot] < len(jobs):
                job = jobs[at[robot]]
                start = clock[robot] + _way(problem, robot, jobs, at[robot])
                for wait in shifts[job].waits:
                    done = end[wait.job]
                    if done is None:
                        break
                    start = max(start, done - wait.offset_s)
                else:
                    travel += _way(problem, robot, jobs, at[robot])
                    begin[job] = start
                    end[job] = clock[robot] = start + shifts[job].duration_s
                    at[robot] += 1
                    left -= 1
                    moved = True
                    continue
                break
        if not moved:
            return None
    return Timing(max(clock, default=0.0), travel, tuple(begin), tuple(clock))


def _way(problem: Problem, robot: int, jobs: Sequence[int], index: int) -> float:
    if index == 0:
        return problem.start_s[robot][jobs[0]]
    return problem.way_s[jobs[index - 1]][jobs[index]]


def greedy(problem: Problem) -> Sequences:
    """The robot that comes free first takes the ready job that it can begin first."""
    sequences: Sequences = [[] for _ in range(problem.robots)]
    clock = [0.0] * problem.robots
    end: dict[int, float] = {}
    todo = set(range(len(problem.shifts)))
    while todo:
        ready = [j for j in sorted(todo) if all(w.job in end for w in problem.shifts[j].waits)]
        best = (inf, inf, -1, -1)
        for job in ready:
            for robot in problem.shifts[job].robots:
                last = sequences[robot]
                way = problem.way_s[last[-1]][job] if last else problem.start_s[robot][job]
                start = clock[robot] + way
                for wait in problem.shifts[job].waits:
                    start = max(start, end[wait.job] - wait.offset_s)
                best = min(best, (start, way, job, robot))
        start, _, job, robot = best
        sequences[robot].append(job)
        clock[robot] = end[job] = start + problem.shifts[job].duration_s
        todo.discard(job)
    return sequences


def schedule(problem: Problem, seed: int = 0) -> tuple[Sequences, Timing]:
    """A near-optimal schedule, never worse than the greedy one. Jobs must not wait for each other in a circle."""
    start = greedy(problem)
    timing = evaluate(problem, start)
    assert timing is not None, "the greedy schedule follows the order of waiting"
    count = len(problem.shifts)
    if count < 2:
        return start, timing
    return _anneal(problem, start, timing, Random(seed), EVALUATION_BUDGET // count)


def _anneal(
    problem: Problem, start: Sequences, timing: Timing, rng: Random, evaluations: int
) -> tuple[Sequences, Timing]:
    current, cost = start, timing.cost
    best, best_timing = start, timing
    for step in range(evaluations):
        heat = HOT * (1.0 - step / evaluations) + COLD
        candidate = _neighbour(problem, current, rng)
        found = evaluate(problem, candidate) if candidate is not None else None
        if candidate is None or found is None:
            continue
        worse = found.cost - cost
        if worse <= 0.0 or rng.random() < exp(-worse / heat):
            current, cost = candidate, found.cost
            if cost < best_timing.cost:
                best, best_timing = candidate, found
    return best, best_timing


def _neighbour(problem: Problem, sequences: Sequences, rng: Random) -> Sequences | None:
    """One job moved to another place, or two jobs swapped; None where a robot may not do it."""
    changed = list(sequences)
    source = rng.choice([r for r in range(problem.robots) if changed[r]])
    index = rng.randrange(len(changed[source]))
    job = changed[source][index]
    target = rng.randrange(problem.robots)
    if target not in problem.shifts[job].robots:
        return None
    changed[source] = changed[source][:index] + changed[source][index + 1 :]
    goal = changed[target]
    if goal and rng.random() < 0.5:
        other = rng.randrange(len(goal))
        swapped = goal[other]
        if source not in problem.shifts[swapped].robots:
            return None
        changed[target] = [*goal[:other], job, *goal[other + 1 :]]
        place = min(index, len(changed[source]))
        changed[source] = [*changed[source][:place], swapped, *changed[source][place:]]
    else:
        place = rng.randrange(len(goal) + 1)
        changed[target] = [*goal[:place], job, *goal[place:]]
    return changed
