"""Asks a model again where that may help: which failures, how often, after how long, and what is changed."""

from collections.abc import Callable
from dataclasses import replace

from planners.asking import Answer, Model, ModelFailed, Question
from wire.messages.plan import CallOutcome

RETRIES: dict[CallOutcome, tuple[float, ...]] = {
    "busy": (0.5, 1.0, 2.0),
    "broken": (0.5, 1.0, 2.0),
    "refused": (2.0,),
    "looping": (0.0,),
    "empty": (0.0,),
}
"""Seconds before each further try. What is not in here is not tried again."""
_WARMER = 0.3


class RetryingModel:
    """See planners.asking.Model. Every try is a call of `model`."""

    def __init__(self, model: Model, sleep: Callable[[float], None]) -> None:
        self._model, self._sleep = model, sleep

    def ask(self, question: Question) -> Answer:
        tries: dict[CallOutcome, int] = {}
        while True:
            try:
                return self._model.ask(question)
            except ModelFailed as failure:
                outcome = failure.call.outcome
                pauses, tried = RETRIES.get(outcome, ()), tries.get(outcome, 0)
                if not failure.again or tried >= len(pauses):
                    raise
                tries[outcome] = tried + 1
                self._sleep(pauses[tried])
                question = changed(question, outcome)


def changed(question: Question, outcome: CallOutcome) -> Question:
    """A model that repeats itself, or says nothing, does so again unless something is different."""
    if outcome not in ("looping", "empty"):
        return question
    think = question.think or outcome == "empty"
    return replace(question, seed=question.seed + 1, temperature=max(question.temperature, _WARMER), think=think)
