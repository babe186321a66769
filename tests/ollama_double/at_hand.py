"""The stand-in for tests: a server with given replies, and the site file's table that points at it."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tests.ollama_double.brain import ChatRequest
from tests.ollama_double.scenarios import Sequence
from tests.ollama_double.server import State, running
from wire.planner_table import PlannerChoice


class Says:
    """A brain that says the same whatever is asked; remembers what it was asked."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.heard: list[ChatRequest] = []

    def reply(self, request: ChatRequest) -> str:
        self.heard.append(request)
        return self.text


@contextmanager
def stand_in(scenario: str = "ok", text: str = '{"a": 1}', **more: Any) -> Iterator[tuple[State, PlannerChoice]]:
    """A server, and how a site file names it."""
    table = more.pop("table", {})
    state = State(Says(text), Sequence(scenario), **more)
    with running(state) as url:
        choice = {"name": "goals", "model": "qwen3:8b", "host": url, "timeout_s": 20.0, **table}
        yield state, PlannerChoice.model_validate(choice)
