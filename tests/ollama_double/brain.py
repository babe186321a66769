"""What answers in the stand-in: a request of `/api/chat` as brains see it, and which of them is asked.

A module `tests/ollama_double/brains/NAME.py` is found by itself. It has two functions:

    def knows(request: ChatRequest) -> bool: ...    # by the text of the prompt alone: is this a question for it?
    def make(dials: Dials) -> Brain: ...            # the brain, with the errors that it is to make

The first that knows a request, by name, answers it.
"""

import importlib
import pkgutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from tests.ollama_double import brains
from tests.ollama_double.dials import Dials


@dataclass(frozen=True)
class ChatRequest:
    """What a model would see of a request, and the options that decide its answer."""

    model: str
    system: str
    """The texts of the system messages, each on its own line."""
    user: str
    """The text of the last user message."""
    messages: tuple[tuple[str, str], ...] = ()
    """All of them: role and text."""
    schema: dict[str, Any] | None = None
    """The `format` of the request where it is a JSON schema. A model does not see it, its sampler does."""
    pictures: tuple[bytes, ...] = ()
    seed: int = 0
    temperature: float = 0.0
    num_predict: int = -1

    @property
    def prompt(self) -> str:
        """All text that a model would read."""
        return "\n".join(text for _, text in self.messages) or f"{self.system}\n{self.user}"


class Brain(Protocol):
    """Stands for a model."""

    def reply(self, request: ChatRequest) -> str:
        """The whole text of the answer. The same request gets the same answer."""


@dataclass(frozen=True)
class Candidate:
    """One purpose: whether a request is for it, and who answers."""

    name: str
    knows: Callable[[ChatRequest], bool]
    brain: Brain


class Emulation:
    """All emulated purposes as one brain; what comes back is spoiled as the dials say."""

    def __init__(self, dials: Dials, candidates: Sequence[Candidate]) -> None:
        self._dials, self._candidates = dials, candidates

    def reply(self, request: ChatRequest) -> str:
        for candidate in self._candidates:
            if candidate.knows(request):
                return self._dials.spoil(candidate.brain.reply(request), request.prompt, request.seed)
        return NOTHING_TO_SAY


NOTHING_TO_SAY = "I am a stand-in without a model, and none of my scripts knows this prompt."


def candidates(dials: Dials) -> list[Candidate]:
    """Every module under `brains`, by name."""
    found = []
    for row in sorted(pkgutil.iter_modules(brains.__path__), key=lambda row: row.name):
        module = importlib.import_module(f"{brains.__name__}.{row.name}")
        found.append(Candidate(row.name, module.knows, module.make(dials)))
    return found


def emulated(dials: Dials) -> Brain:
    """The emulated planner."""
    return Emulation(dials, candidates(dials))
