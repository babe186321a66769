"""A server for the planners that have a model: the stand-in, at the address that the environment names."""

from collections.abc import Iterator

import pytest

from tests.ollama_double.brain import emulated
from tests.ollama_double.dials import Dials
from tests.ollama_double.server import State, running


@pytest.fixture
def model_server(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """Its address. It makes no errors."""
    with running(State(emulated(Dials()))) as url:
        monkeypatch.setenv("OLLAMA_HOST", url)
        yield url
