"""Which robot does which job, in which order: a greedy start, then annealing by moving and swapping jobs.

One job at a time for each robot (one hand). The objective is 20 x the time until the last robot is done + the seconds
that all of them walk. The number of evaluations is fixed, so that the same jobs always get the same schedule.
"""

from dataclasses import dataclass
from math import exp, inf
from random import Random

MAKESPAN_WEIGHT = 20.0
MOST_EVALUATIONS, JOB_BUDGET = 8_000, 160_000
"""Schedules tried, and jobs in them together: at most about 0.2 s."""
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
    shifts, way_s = problem.shifts, problem.way_s
    end: list[float | None] = [None] * len(shifts)
    begin = [0.0] * len(shifts)
    clock = [0.0] * len(sequences)
    todo = [iter(jobs) for jobs in sequences]
    next_way = [problem.start_s[robot] for robot in range(len(sequences))]
    job_of = [next(jobs, None) for jobs in todo]
    travel = 0.0
    moved = True
    while moved:
        moved = False
        for robot, job in enumerate(job_of):
            while job is not None:
                way = next_way[robot][job]
                start = clock[robot] + way
                shift = shifts[job]
                for wait in shift.waits:
                    done = end[wait.job]
                    if done is None:
                        break
                    if done - wait.offset_s > start:
                        start = done - wait.offset_s
                else:
                    travel += way
                    begin[job] = start
                    end[job] = clock[robot] = start + shift.duration_s
                    next_way[robot] = way_s[job]
                    job = job_of[robot] = next(todo[robot], None)
                    moved = True
                    continue
                break
    if any(job is not None for job in job_of):
        return None
    return Timing(max(clock, default=0.0), travel, tuple(begin), tuple(clock))


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
    return _anneal(problem, start, timing, Random(seed), min(MOST_EVALUATIONS, JOB_BUDGET // count))


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
