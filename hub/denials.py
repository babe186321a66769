"""What a robot's hand found not to be so: no such thing here. Cameras that go on saying it are not believed for a while."""

from dataclasses import dataclass
from math import hypot

from hub.records import Thing

_FURNITURE_S, _LOOSE_S = 3600.0, 120.0
_REACH_M = 0.3
_OUTVOTED = -1e3
"""No number of further looks brings a denied name back."""


@dataclass(frozen=True, slots=True)
class _Denial:
    type: str
    x: float
    y: float
    reach_m: float
    until_s: float


class Denials:
    """Pairs of type and place that were tried in vain."""

    def __init__(self) -> None:
        self._denials: list[_Denial] = []

    def add(self, thing: Thing, now_s: float) -> None:
        """A robot was there, and there was no such thing."""
        loose = thing.shape.kind == "pickup"
        reach_m = max(_REACH_M, 0.0 if loose else 0.8 * thing.shape.half_diagonal_m)
        until_s = now_s + (_LOOSE_S if loose else _FURNITURE_S)
        self._denials = [d for d in self._denials if d.until_s > now_s]
        self._denials.append(_Denial(thing.type, thing.x, thing.y, reach_m, until_s))

    def denies(self, thing: Thing, type: str, now_s: float) -> bool:
        return any(
            d.type == type and now_s < d.until_s and hypot(d.x - thing.x, d.y - thing.y) < d.reach_m
            for d in self._denials
        )

    def rename(self, thing: Thing, now_s: float) -> bool:
        """Give a denied thing the type that it has most other votes for; False when there is none."""
        if not self.denies(thing, thing.type, now_s):
            return True
        others = [type for type in sorted(thing.votes) if not self.denies(thing, type, now_s)]
        if not others:
            return False
        thing.votes[thing.type] = _OUTVOTED
        thing.retype(max(others, key=lambda type: thing.votes[type]))
        return True
