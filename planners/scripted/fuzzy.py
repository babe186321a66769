"""Misspelt names: the vocabulary's phrases that are closest in spelling, and whether one is beyond doubt.

One slip of the finger (a letter left out, doubled or swapped) is corrected. A replaced letter in a short word, a wrong
first letter or two candidates are doubts, which are asked about: "cable" is not silently a table.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from rapidfuzz.distance import OSA

from planners.scripted.vocabulary import Phrase, tables

SHORTEST = 4
CORRECTABLE = frozenset({"NOUN", "ROOM", "OPEN", "CLOSE", "TURN", "CLEAN", "SLICE", "FIND", "BRING", "PUT", "EXCEPT"})


@dataclass(frozen=True)
class Guess:
    """Candidates, best first."""

    phrases: tuple[Phrase, ...] = ()
    sure: bool = False


def closest(words: Sequence[str], table: Mapping[Phrase, object]) -> Guess:
    """What the unknown words may be a misspelling of."""
    text = "".join(words)
    if len(text) < SHORTEST or " ".join(words) in _strangers() or words[0] in _strangers():
        return Guess()
    limit = 2 if len(text) >= 9 else 1
    near: list[tuple[int, bool, str, Phrase]] = []
    for phrase, meaning in table.items():
        joined = "".join(phrase)
        if getattr(meaning, "kind", "") not in CORRECTABLE or len(joined) < SHORTEST or len(phrase) < len(words):
            continue
        edits = OSA.distance(text, joined, score_cutoff=limit)
        if edits <= limit:
            near.append((edits, joined.endswith("s") != text.endswith("s"), joined, phrase))
    near.sort()
    return _decide(text, near, table)


def _decide(text: str, near: list[tuple[int, bool, str, Phrase]], table: Mapping[Phrase, object]) -> Guess:
    if not near:
        return Guess()
    best = [phrase for edits, _, _, phrase in near if edits == near[0][0]]
    meanings = {_sense(table[phrase]) for phrase in best}
    sure = len(meanings) == 1 and (near[0][0] == 0 or not _doubtful(text, near[0][2]))
    return Guess(tuple(best), sure)


def _sense(meaning: object) -> tuple[object, ...]:
    return (getattr(meaning, "kind", ""), getattr(meaning, "types", ()), getattr(meaning, "ids", ()))


def _doubtful(text: str, target: str) -> bool:
    if text[0] != target[0]:
        return True
    replaced = len(text) == len(target) and sorted(text) != sorted(target)
    return len(target) < 6 and replaced


def _strangers() -> Collection[str]:
    return tables()["stranger"]["words"]
