"""Counts what a task spends on a model, keeps the record of every call, and ends it when the budget is spent."""

from dataclasses import replace

from planners.asking import Answer, Model, ModelFailed, Question
from wire.messages.plan import ModelCall
from wire.planner_table import Budget

MOST_CALLS = 64
"""In one reply; `PlanReply.calls` holds no more."""
_TASKS = 32
"""So many tasks are remembered."""


class Meter:
    """See planners.asking.Model."""

    def __init__(self, model: Model, budget: Budget, seed: int = 0) -> None:
        """`seed` is added to that of every question."""
        self._model, self._budget, self._seed = model, budget, seed
        self._spent: dict[str, list[ModelCall]] = {}
        self._task = ""
        self._calls: list[ModelCall] = []

    def open(self, task: str) -> None:
        """From now on it is for this task; the records begin anew."""
        self._task, self._calls = task, []
        self._spent[task] = self._spent.pop(task, [])
        while len(self._spent) > _TASKS:
            del self._spent[next(iter(self._spent))]

    def calls(self) -> tuple[ModelCall, ...]:
        """Since `open`."""
        return tuple(self._calls)

    def ask(self, question: Question) -> Answer:
        why = self._over()
        if why:
            raise ModelFailed(why, ModelCall(purpose=question.purpose, model="none", outcome="unasked"), again=False)
        try:
            answer = self._model.ask(replace(question, seed=question.seed + self._seed))
        except ModelFailed as failure:
            if failure.call.outcome != "unasked":
                self._record(failure.call)
            raise
        self._record(answer.call)
        return answer

    def _record(self, call: ModelCall) -> None:
        self._calls.append(call)
        self._spent.setdefault(self._task, []).append(call)

    def _over(self) -> str:
        """Which part of the budget is spent; empty while there is some left of each."""
        spent, budget = self._spent.setdefault(self._task, []), self._budget
        tokens = sum(call.prompt_tokens + call.completion_tokens for call in spent)
        seconds = sum(call.latency_s for call in spent)
        if len(self._calls) >= MOST_CALLS:
            return f"{MOST_CALLS} calls of the model for one plan are too many"
        if len(spent) >= budget.calls:
            return f"the task's budget of {budget.calls} calls of the model is spent"
        if tokens >= budget.tokens:
            return f"the task's budget of {budget.tokens} tokens is spent"
        if seconds >= budget.seconds:
            return f"the task's budget of {budget.seconds:g} s of the model's time is spent"
        return ""
