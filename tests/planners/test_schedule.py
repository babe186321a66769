"""Properties of schedules: order, skills, one thing at a time, never worse than the greedy start."""

from random import Random

from hypothesis import given, settings
from hypothesis import strategies as st

from planners.tasks.schedule import Problem, Shift, Wait, evaluate, greedy, schedule


def problem(seed: int, jobs: int, robots: int) -> Problem:
    """Random points in a 12 m square; some jobs wait for earlier ones, some suit only some robots."""
    rng = Random(seed)

    def point() -> tuple[float, float]:
        return rng.uniform(0.0, 12.0), rng.uniform(0.0, 12.0)

    def way(a: tuple[float, float], b: tuple[float, float]) -> float:
        return (abs(a[0] - b[0]) + abs(a[1] - b[1])) / 0.5

    entries, exits = [point() for _ in range(jobs)], [point() for _ in range(jobs)]
    starts = [point() for _ in range(robots)]
    shifts = []
    for index in range(jobs):
        able = tuple(r for r in range(robots) if rng.random() < 0.8) or (rng.randrange(robots),)
        waits = tuple(Wait(j, rng.choice((0.0, 5.0))) for j in range(index) if rng.random() < 0.1)
        shifts.append(Shift(rng.uniform(3.0, 20.0), able, waits))
    return Problem(
        tuple(shifts),
        tuple(tuple(way(start, entry) for entry in entries) for start in starts),
        tuple(tuple(way(end, entry) for entry in entries) for end in exits),
    )


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), jobs=st.integers(1, 14), robots=st.integers(1, 4))
def test_a_schedule_keeps_its_promises(seed: int, jobs: int, robots: int) -> None:
    task = problem(seed, jobs, robots)
    sequences, timing = schedule(task)
    assert sorted(job for own in sequences for job in own) == list(range(jobs))
    for robot, own in enumerate(sequences):
        clock = 0.0
        for index, job in enumerate(own):
            assert robot in task.shifts[job].robots
            way = task.way_s[own[index - 1]][job] if index else task.start_s[robot][job]
            assert timing.begin_s[job] >= clock + way - 1e-6
            clock = timing.begin_s[job] + task.shifts[job].duration_s
    for job, shift in enumerate(task.shifts):
        for wait in shift.waits:
            end = timing.begin_s[wait.job] + task.shifts[wait.job].duration_s
            assert timing.begin_s[job] + wait.offset_s >= end - 1e-6
    first = evaluate(task, greedy(task))
    assert first is not None
    assert timing.cost <= first.cost + 1e-9


def test_the_search_pays_and_repeats() -> None:
    gains = []
    for seed in range(6):
        task = problem(seed, 10, 3)
        start = evaluate(task, greedy(task))
        _, timing = schedule(task)
        assert start is not None
        assert schedule(task)[1] == timing
        gains.append(start.makespan_s / timing.makespan_s)
    assert sum(gains) / len(gains) > 1.05


def test_circular_waiting_is_seen() -> None:
    shifts = (Shift(1.0, (0,)), Shift(1.0, (0,), (Wait(0),)))
    task = Problem(shifts, ((1.0, 1.0),), ((0.0, 1.0), (1.0, 0.0)))
    assert evaluate(task, [[1, 0]]) is None
    assert evaluate(task, [[0, 1]]) is not None
