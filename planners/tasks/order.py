"""Waiting among jobs: what the goals' order asks, and one thing at a time for each thing. Never in a circle."""

from collections.abc import Sequence

from planners.tasks.work import Job
from wire.messages.goal import Goal


def order_by_goals(jobs: list[Job], goals: Sequence[Goal]) -> None:
    """A job of a goal begins when every job of the goals before it is done."""
    for index, job in enumerate(jobs):
        if job.goal is None:
            continue
        for other, earlier in enumerate(jobs):
            if earlier.goal is not None and earlier.goal in goals[job.goal].after and other != index:
                _wait(jobs, index, other)


def order_by_things(jobs: list[Job]) -> None:
    """Jobs about the same thing one after another: states, then moves, then slicing; in the order of the goals."""
    for index, job in enumerate(jobs):
        for other in range(index):
            if not job.about & jobs[other].about or _follows(jobs, other, index) or _follows(jobs, index, other):
                continue
            late, early = (index, other) if job.rank >= jobs[other].rank else (other, index)
            _wait(jobs, late, early)


def _wait(jobs: list[Job], late: int, early: int) -> None:
    if not _follows(jobs, early, late):
        jobs[late].waits.append((0, early))


def _follows(jobs: list[Job], late: int, early: int) -> bool:
    """Whether one job comes after another already, over any number of waits."""
    seen: set[int] = set()
    todo = [late]
    while todo:
        for _, before in jobs[todo.pop()].waits:
            if before == early:
                return True
            if before not in seen:
                seen.add(before)
                todo.append(before)
    return False
