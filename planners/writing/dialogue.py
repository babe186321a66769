"""One question to a model, and what is wrong with its answer said back to it, a bounded number of times."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeVar

from planners.asking import Model, ModelFailed, Question, rejected
from planners.parse import Faulty
from planners.prompt import one_line, system_prompt
from wire.messages.plan import ModelCall

Read = TypeVar("Read")
REPAIRS = 2
_WARMER = 0.3
"""From the second repair on: the same answer twice helps nobody."""
_SHOWN = 1500
_WORLD, _STEPS = ("reading",), ("steps", "reading")
_WITH: dict[str, tuple[str, ...]] = {
    "plan": _STEPS,
    "decompose": _WORLD,
    "functions": _STEPS,
    "smart_decompose": _STEPS,
    "smart_allocate": _WORLD,
    "emos_assign": _WORLD,
    "emos_act": _STEPS,
}
"""Purpose -> further texts that its system prompt ends with: how steps are written, how the world is read."""


def system_of(purpose: str) -> str:
    """The whole system prompt of a purpose, always the same."""
    return "\n".join(system_prompt(part) for part in (purpose, *_WITH.get(purpose, ())))


class Dialogue:
    """The questions for one plan. `judged`: the calls whose answers were of no use."""

    def __init__(self, model: Model, seed: int = 0) -> None:
        self._model, self._seed = model, seed
        self.judged: list[ModelCall] = []

    def ask(
        self, purpose: str, user: str, schema: dict[str, Any], read: Callable[[str], Read], max_tokens: int = 1024
    ) -> Read:
        """What `read` makes of the answer. Raises ModelFailed when there is no usable one after all repairs."""
        question = Question(purpose, system_of(purpose), user, schema, max_tokens=max_tokens, seed=self._seed)
        for repair in range(REPAIRS + 1):
            answer = self._model.ask(question)
            try:
                return read(answer.text)
            except Faulty as faulty:
                last = faulty
                self.judged.append(rejected(answer))
            question = replace(
                question,
                purpose="repair",
                user=f"{user}\n{_objection(answer.text, last)}",
                temperature=_WARMER if repair else 0.0,
                seed=self._seed + repair + 1,
            )
        reason = f"the {purpose} of the model could not be used: {last}"
        raise ModelFailed(reason, self.judged[-1], rejects=self.judged[:-1])


def _objection(text: str, faulty: Faulty) -> str:
    faults = "\n".join(f"- {one_line(fault, 240)}" for fault in faulty.faults)
    return (
        f"you replied: {one_line(text, _SHOWN)}\nthat cannot be used:\n{faults}\nreply with the whole JSON, corrected"
    )
