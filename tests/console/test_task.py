"""What is said of a task that goes on when nobody waits for it any more."""

import pytest

from console.task import RUNNING, task_text
from wire.messages.operator import TaskState


@pytest.mark.parametrize("status", RUNNING)
def test_a_task_that_goes_on_is_named_with_the_way_to_end_it(status: str) -> None:
    state = TaskState(task="task-1", instruction="open the fridge", status=status, stamp_s=9.0, started_s=1.0)
    assert task_text(state).splitlines() == [
        f"{status}: open the fridge",
        "task-1 goes on; `justw cancel task-1` ends it",
    ]


def test_a_plan_without_goals_ends_without_an_empty_line() -> None:
    state = TaskState(
        task="task-1",
        instruction="open the fridge",
        status="done",
        reason="every step is done",
        stamp_s=9.0,
        started_s=1.0,
    )
    assert [line.split(",")[0] for line in task_text(state).splitlines()] == ["done: every step is done", "planner -"]
