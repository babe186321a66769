"""Words that say nothing about what should be true, and the uses of them that do: those are refused, not dropped."""

from collections.abc import Iterator, Sequence

from planners.scripted.lexicon import Word
from planners.scripted.syntax import Unclear
from planners.scripted.vocabulary import tables

DETERMINERS = frozenset({"THE", "ALL", "BOTH", "NUM", "NO"})
JOINTS = frozenset({"COMMA", "AND", "THEN", "STOP", "BUT"})
NUMBERS = frozenset({"NUM", "ONES"})
STATIVE = frozenset({"LEAVE", "ENSURE", "CHECK_IF", "TOUCH", "IS", "SHOULD", "NOT", "WITHOUT"})
"""With these, "only the TV" also says what should be of everything else."""


def clause_starts() -> frozenset[str]:
    """Token types that can only begin a clause."""
    return frozenset(tables()["verb"]) | {"NOT", "FIRST"}


def without_fillers(words: Sequence[Word]) -> list[Word]:
    """The words that carry content. Raises Unclear for small words whose meaning cannot be carried."""
    kept = list(_without_calls(words))
    return [word for index, word in enumerate(kept) if not _is_idle(kept, index)]


def _without_calls(words: Sequence[Word]) -> Iterator[Word]:
    """Politeness goes, and calls to all robots at the beginning or, after a comma, at the end."""
    before = ""
    for index, word in enumerate(words):
        at_the_end = before == "COMMA" and all(w.kind in ("CALL", "DROPPED", "STOP") for w in words[index:])
        if word.kind == "CALL" and (not before or at_the_end):
            continue
        if word.kind == "DROPPED" and before not in DETERMINERS:
            continue
        if not before and word.kind in JOINTS:
            continue
        before = word.kind
        yield word


def _is_idle(words: Sequence[Word], index: int) -> bool:
    """Whether "only" or "at least" changes nothing here."""
    word = words[index]
    following = words[index + 1].kind if index + 1 < len(words) else ""
    if word.kind == "ATLEAST":
        return following in NUMBERS
    if word.kind != "ONLY":
        return False
    if following in NUMBERS:
        raise Unclear(f"a number means at least so many here: leave out '{word.text}'", word.text)
    starts = not index or words[index - 1].kind in JOINTS
    if starts and following in clause_starts() and (following not in STATIVE or word.text.lower() == "just"):
        return True
    if any(w.kind in STATIVE for w in _clause(words, index)):
        reason = f"'{word.text}' also says what should be of everything else: say that in words of its own"
        raise Unclear(reason, word.text)
    return True


def _clause(words: Sequence[Word], index: int) -> Iterator[Word]:
    """The words of one clause: up to the next joint that a verb follows, on both sides."""
    start = index
    while start > 0 and words[start].kind not in clause_starts() - {"NOT"}:
        start -= 1
    if start > 0 and words[start - 1].kind == "NOT":
        start -= 1
    yield from words[start:index]
    for word in words[index:]:
        if word.kind in clause_starts() - {"NOT"}:
            return
        yield word
