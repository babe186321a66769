"""The emulated planner as a model server, with errors at a rate. It is no model: what it shows is how planners cope."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

DIALS = ("invented_id", "missing_dependency", "wrong_skill", "dropped_negation", "broken_json", "prose")


def dials_at(rate: float) -> dict[str, float]:
    """Every kind of error as likely, so that a reply in which all of them can be made has one with this chance."""
    return dict.fromkeys(DIALS, 1.0 - (1.0 - rate) ** (1.0 / len(DIALS)))


@contextmanager
def emulated_model(rate: float, seed: int) -> Iterator[str]:
    """Serves while it is open; the address. Raises SystemExit where the source tree with its tests is not there."""
    try:
        brain, dials, server = (import_module(f"tests.ollama_double.{name}") for name in ("brain", "dials", "server"))
    except ModuleNotFoundError:
        raise SystemExit(
            "the emulated planner lies under tests/: run this in the source tree, or name a --host"
        ) from None
    state = server.State(brain.emulated(dials.Dials(seed=seed, **dials_at(rate))))
    with server.running(state) as url:
        yield url
