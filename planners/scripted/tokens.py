"""From typed words to the tokens of the grammar: particles, separators and list commas told apart by their neighbours.

The grammar can then decide every step on the next token alone (LALR), so that no sentence has two readings.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from planners.scripted.lexicon import Meaning, Word
from planners.scripted.vocabulary import tables

STATES = frozenset({"OPEN", "ISOPEN", "ISCLOSED", "CLEAN", "ISCLEAN", "DIRTY", "ISSLICED"})
DETERMINERS = frozenset({"THE", "ALL", "BOTH", "NUM"})
JOINTS = frozenset({"COMMA", "AND", "THEN", "STOP", "BUT"})


def clause_starts() -> frozenset[str]:
    """Token types that can only begin a clause."""
    return frozenset(tables()["verb"]) | {"NOT", "FIRST"}


def tokens(words: Sequence[Word]) -> list[Word]:
    """The grammar's tokens."""
    kept = list(_without_fillers(words))
    kept = _retyped(kept)
    return list(_joined(kept))


def _without_fillers(words: Sequence[Word]) -> Iterator[Word]:
    started = False
    for word in words:
        calling = word.kind in ("ROBOT", "CALL")
        if word.kind == "DROPPED" or (not started and (calling or word.kind in JOINTS)):
            continue
        started = True
        yield word


def _retyped(words: list[Word]) -> list[Word]:
    """Words whose part of speech the neighbours settle."""
    out: list[Word] = []
    for index, word in enumerate(words):
        before = out[-1].kind if out else ""
        after = words[index + 1].kind if index + 1 < len(words) else ""
        kind = _part_of_speech(word.kind, before, after)
        if word.kind == "OR" and any(w.kind in ("NOT", "WITHOUT") for w in out):
            kind = "AND"
        base = "1" if kind == "NUM" and word.kind == "ONES" else word.meaning.base
        out.append(replace(word, meaning=replace(word.meaning, kind=kind, base=base)))
    return out


def _part_of_speech(kind: str, before: str, after: str) -> str:
    if kind in ("ON", "OFF"):
        ends = after in JOINTS | {"", "BEFORE", "AFTER", "WITHOUT", "IN", "ON", "FROM", "EXCEPT", "FIRST", "THERE"}
        if before == "TURN" or ends:
            return f"P_{kind}"
        return "FROM" if kind == "OFF" else "ON"
    if kind in STATES and before in DETERMINERS | {"ADJ"} and after in ("NOUN", "ONES", "ADJ"):
        return "ADJ"
    if kind == "ONES":
        return "ONES" if before in ("THE", "ALL", "ADJ", "EXCEPT") else "NUM"
    if kind == "CLOSE" and before == "IS":
        return "ISCLOSED"
    return kind


def _joined(words: list[Word]) -> Iterator[Word]:
    """Runs of commas and conjunctions as one token: AND in a list, RAND in a list of rooms, SEP and its kin between
    clauses."""
    index = 0
    while index < len(words):
        word = words[index]
        if word.kind not in JOINTS:
            if word.kind == "WITHOUT":
                yield from _split_without(word)
            else:
                yield word
            index += 1
            continue
        run = [word]
        while index + len(run) < len(words) and words[index + len(run)].kind in JOINTS:
            run.append(words[index + len(run)])
        index += len(run)
        kind = _joint(run, words[index:])
        if kind:
            meaning = Meaning(kind, " ".join(w.meaning.base for w in run))
            yield Word(meaning, run[0].text, run[0].start, run[-1].end)


def _split_without(word: Word) -> Iterator[Word]:
    yield replace(word, meaning=Meaning("SEP", "without"))
    yield replace(word, meaning=Meaning("NOT", "without"))


def _joint(run: Sequence[Word], rest: Sequence[Word]) -> str:
    kinds = {word.kind for word in run}
    if not rest:
        return "SEP" if kinds & {"AND", "BUT", "THEN"} else ""
    if rest[0].kind in ("EXCEPT", "WITHOUT"):
        return ""
    following = rest[0].kind
    if kinds == {"COMMA"} and following in ("BEFORE", "AFTER"):
        return ""
    if "THEN" in kinds:
        return "SEPTHEN"
    if kinds & {"STOP", "BUT"} or following in clause_starts() | {"BEFORE", "AFTER"}:
        return "SEPAND" if kinds == {"AND"} else "SEP"
    nouns = [word.kind for word in rest if word.kind not in DETERMINERS]
    lists_rooms = nouns[:1] == ["ROOM"] and nouns[1:2] != ["NOUN"]
    return "RAND" if lists_rooms else "AND"
