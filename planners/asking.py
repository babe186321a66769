"""What planners know of language models: a question, its answer, and the ways in which there is none."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from wire.messages.plan import ModelCall


@dataclass(frozen=True)
class Question:
    """One call. Everything that decides the answer is in here, so that its hash can stand for it."""

    purpose: str
    """What it is for, in one word: `goals`, `repair`, `plan`, `decompose`, `look` ..."""
    system: str
    """Kept the same to the byte between calls of a purpose: servers keep the state of a common beginning."""
    user: str
    schema: dict[str, Any] | None = None
    """JSON schema that the reply is held to; None for free text."""
    pictures: tuple[bytes, ...] = ()
    """PNG or JPEG files."""
    max_tokens: int = 512
    temperature: float = 0.0
    seed: int = 0
    think: bool = False
    """Have a model that can do so think first, in words that are not part of the answer."""


@dataclass(frozen=True)
class Answer:
    """What came back whole. `text` is as the server sent it: nothing in it has been believed yet."""

    text: str
    call: ModelCall


class ModelFailed(Exception):
    """There is no answer: `call.outcome` is the kind of failure, the exception's text the sentence for people.

    A planner lets it pass (`planners.modelled` sees to what comes then), and raises one itself where answers are of no
    use to it: `ModelFailed(reason, rejected(answer))`.
    """

    def __init__(self, reason: str, call: ModelCall, again: bool = True, rejects: Sequence[ModelCall] = ()) -> None:
        """`again`: the same question may get an answer another time. `rejects`: other answers that were of no use."""
        super().__init__(reason)
        self.call, self.again, self.rejects = call, again, tuple(rejects)


def rejected(answer: Answer) -> ModelCall:
    """The record of an answer that was not what was asked for. In `PlanReply.calls` it stands for the call's own."""
    return answer.call.model_copy(update={"outcome": "invalid"})


class Model(Protocol):
    """A language model, wherever it runs."""

    def ask(self, question: Question) -> Answer:
        """Blocks until the whole answer is there. Raises ModelFailed, and nothing else, when there is none."""
