"""Which errors an emulated model makes, how often, and by which seed: the same prompt always gets the same ones."""

from dataclasses import dataclass, fields
from hashlib import sha256
from random import Random
from typing import Literal

Slip = Literal[
    "invented_id", "missing_goal", "missing_dependency", "wrong_skill", "dropped_negation", "broken_json", "prose"
]


@dataclass(frozen=True)
class Dials:
    """Rates from 0 to 1. All but the last two are for brains to ask about with `slips`; `spoil` sees to the last two."""

    seed: int = 0
    invented_id: float = 0.0
    """It names a thing that is not there."""
    missing_goal: float = 0.0
    """It leaves out one thing of those that were asked for."""
    missing_dependency: float = 0.0
    """It leaves out that one step waits for another."""
    wrong_skill: float = 0.0
    """It takes a skill that does not fit the thing or that the robot has not."""
    dropped_negation: float = 0.0
    """It overlooks a `not`, `without`, `leave` or `keep`."""
    broken_json: float = 0.0
    """Its reply ends in the middle."""
    prose: float = 0.0
    """It talks before and after the JSON."""

    def slips(self, kind: Slip, prompt: str, seed: int = 0, what: str = "") -> bool:
        """Whether this error is made in the reply to this prompt; `what` tells several places in one reply apart."""
        rate: float = getattr(self, kind)
        return rate > 0.0 and self.rng(kind, prompt, seed, what).random() < rate

    def rng(self, *about: object) -> Random:
        """Chance that depends on nothing but the seed and what it is about."""
        return Random(sha256(repr((self.seed, *about)).encode()).digest())

    def spoil(self, text: str, prompt: str, seed: int = 0) -> str:
        """The reply with the errors that know nothing of its meaning."""
        if self.slips("broken_json", prompt, seed):
            text = text[: self.rng("cut", prompt, seed).randrange(len(text)) if text else 0]
        if self.slips("prose", prompt, seed):
            text = f"Sure! Here is what you asked for:\n```json\n{text}\n```\nLet me know if you need anything else."
        return text


def dials_from(words: list[str], seed: int) -> Dials:
    """From words such as `invented_id=0.1`. Raises ValueError with one sentence."""
    known = [field.name for field in fields(Dials) if field.name != "seed"]
    rates: dict[str, float] = {}
    for word in words:
        name, _, rate = word.partition("=")
        if name not in known:
            raise ValueError(f"there is no dial {name!r}; there are {', '.join(known)}")
        try:
            rates[name] = float(rate)
        except ValueError:
            raise ValueError(f"{word}: give a rate from 0 to 1, as in {name}=0.1") from None
        if not 0.0 <= rates[name] <= 1.0:
            raise ValueError(f"{word}: a rate lies between 0 and 1")
    return Dials(seed=seed, **rates)
