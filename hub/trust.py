"""How far a source's word goes: a Beta count of how often a robot's own eyes bore it out."""

from dataclasses import dataclass
from math import log

_PRIOR = (4.0, 1.0)
_ROBOT = 0.97
_LOWEST, _HIGHEST = 0.02, 0.98
_FADE = 0.995
"""Each verdict weighs the older ones this much less, so that a repaired source recovers."""


@dataclass
class _Record:
    right: float
    wrong: float
    odds: float


class Trust:
    """Reputation of every source that is not a robot; robots are believed."""

    def __init__(self) -> None:
        self._records: dict[str, _Record] = {}

    def score(self, source: str, right: bool) -> None:
        """A robot has looked at what this source claimed."""
        record = self._record(source)
        record.right = record.right * _FADE + (1.0 if right else 0.0)
        record.wrong = record.wrong * _FADE + (0.0 if right else 1.0)
        record.odds = _log_odds(record)

    def odds(self, source: str, robot: bool = False) -> float:
        """Log-odds that a claim of this source is true; negative for one that is wrong more often than right."""
        return _ROBOT_ODDS if robot else self._record(source).odds

    def probability(self, source: str) -> float:
        record = self._record(source)
        return _clamp(record.right / (record.right + record.wrong))

    def counts(self) -> dict[str, tuple[float, float]]:
        """(right, wrong) of every source: what a journal keeps."""
        return {source: (r.right, r.wrong) for source, r in self._records.items()}

    def restore(self, counts: dict[str, tuple[float, float]]) -> None:
        for source, (right, wrong) in counts.items():
            record = _Record(right, wrong, 0.0)
            record.odds = _log_odds(record)
            self._records[source] = record

    def _record(self, source: str) -> _Record:
        record = self._records.get(source)
        if record is None:
            record = _Record(*_PRIOR, 0.0)
            record.odds = _log_odds(record)
            self._records[source] = record
        return record


def _clamp(probability: float) -> float:
    return min(max(probability, _LOWEST), _HIGHEST)


def _log_odds(record: _Record) -> float:
    probability = _clamp(record.right / (record.right + record.wrong))
    return log(probability / (1.0 - probability))


_ROBOT_ODDS = log(_ROBOT / (1.0 - _ROBOT))
