"""Answers the questions of `tests.planners.test_ollama_contract`, so that the contract can be rehearsed."""

from tests.ollama_double.brain import Brain, ChatRequest
from tests.ollama_double.dials import Dials

MARK = "This is a contract test of R2X."


def knows(request: ChatRequest) -> bool:
    return MARK in request.prompt


def make(dials: Dials) -> Brain:
    return _Contract()


class _Contract:
    def reply(self, request: ChatRequest) -> str:
        return '{"colour": "red"}' if request.pictures else '{"number": 7}'
