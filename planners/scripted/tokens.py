"""From typed words to the tokens of the grammar: particles, separators and list commas told apart by their neighbours.

The grammar can then decide every step on the next token alone (LALR), so that no sentence has two readings.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from planners.scripted.fillers import DETERMINERS, JOINTS, clause_starts, without_fillers
from planners.scripted.lexicon import Meaning, Word
from planners.scripted.syntax import Unclear

STATES = frozenset({"OPEN", "ISOPEN", "ISCLOSED", "CLEAN", "ISCLEAN", "DIRTY", "ISSLICED"})
NAMES = DETERMINERS | {"NOUN", "ID", "ONES", "EVERYTHING", "ROOM", "ADJ", "IN", "ON"}
"""What an exception can begin with."""


def tokens(words: Sequence[Word]) -> list[Word]:
    """The grammar's tokens. Raises Unclear for small words whose meaning cannot be carried."""
    kept = without_fillers(words)
    kept = _retyped(list(_with_comma(kept)))
    return list(_joined(kept))


def _with_comma(words: list[Word]) -> Iterator[Word]:
    """A comma between "after opening the fridge" and the clause that follows it, where it has been left out."""
    fronted, verbs = False, 0
    for index, word in enumerate(words):
        before = words[index - 1].kind if index else ""
        if word.kind in ("BEFORE", "AFTER") and (not before or before in JOINTS):
            fronted, verbs = True, 0
        elif word.kind in JOINTS:
            fronted = fronted and word.kind == "AND"
            if any(w.kind in clause_starts() for w in words[index + 1 : index + 2]):
                verbs = 0
        elif fronted and word.kind in clause_starts() and before not in DETERMINERS | {"IS", "SHOULD", "NOT"}:
            verbs += 1
            if verbs == 2 and not any(w.kind == "LEAVE" for w in words[:index]):
                yield Word(Meaning("COMMA", ","), word.text, word.start, word.start)
                fronted = False
        yield word


def _retyped(words: list[Word]) -> list[Word]:
    """Words whose part of speech the neighbours settle."""
    out: list[Word] = []
    for index, word in enumerate(words):
        before = out[-1].kind if out else ""
        after = words[index + 1].kind if index + 1 < len(words) else ""
        if word.kind == "ALLBUT":
            _ask_all_of_what(words, index, out)
        kind = _part_of_speech(word.kind, before, after)
        if word.kind == "OR" and any(w.kind in ("NOT", "WITHOUT", "NO") for w in out):
            kind = "AND"
        base = "1" if kind == "NUM" and word.kind == "ONES" else word.meaning.base
        out.append(replace(word, meaning=replace(word.meaning, kind=kind, base=base)))
    return out


def _ask_all_of_what(words: list[Word], index: int, out: list[Word]) -> None:
    """ "All but" has a list before it, and something definite after it."""
    after = words[index + 1 : index + 2]
    part = f"{words[index].text} {after[0].text if after else ''}".strip()
    if after and after[0].kind in ("NUM", "ONES"):
        raise Unclear(f"which should be left out? '{part}' leaves it open", part, question=True)
    if not any(w.kind in ("NOUN", "ID", "THEM") for w in out):
        raise Unclear("all of what? Say 'everything except ...' or 'all lamps except ...'", part, question=True)


def _part_of_speech(kind: str, before: str, after: str) -> str:
    if kind == "ALLBUT":
        return "EXCEPT"
    if kind in ("ON", "OFF"):
        ends = after in JOINTS | {"", "BEFORE", "AFTER", "WITHOUT", "IN", "ON", "FROM", "EXCEPT", "FIRST", "THERE"}
        if before == "TURN" or ends:
            return f"P_{kind}"
        return "FROM" if kind == "OFF" else "ON"
    if kind in STATES and before in DETERMINERS | {"ADJ"} and after in ("NOUN", "ONES", "ADJ"):
        return "ADJ"
    if kind == "ONES":
        return "ONES" if before in ("THE", "ALL", "ADJ", "EXCEPT", "BUT") else "NUM"
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
        if _is_exception(words, index):
            yield replace(word, meaning=Meaning("EXCEPT", "but"))
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


def _is_exception(words: list[Word], index: int) -> bool:
    """Whether a "but" goes on with what is left out ("everything but the TV") and not with a clause of its own."""
    rest = words[index + 1 :]
    if words[index].kind != "BUT" or not rest or rest[0].kind not in NAMES:
        return False
    start = next((i for i in range(index - 1, -1, -1) if words[i].kind in clause_starts()), -1)
    clause = words[start + 1 : index]
    following = next((i for i, w in enumerate(rest) if w.kind in JOINTS), len(rest))
    stated = any(w.kind in ("IS", "SHOULD", "NOT") for w in rest[:following])
    if stated and (start < 0 or words[start].kind == "ENSURE"):
        stated = any(w.kind in ("IS", "SHOULD") for w in clause)
    return not stated and any(w.kind in ("ALL", "EVERYTHING", "NO") for w in clause)


def _split_without(word: Word) -> Iterator[Word]:
    yield replace(word, meaning=Meaning("SEP", "without"))
    yield replace(word, meaning=Meaning("NOT", "without"))


def _joint(run: Sequence[Word], rest: Sequence[Word]) -> str:
    kinds = {word.kind for word in run}
    if not rest:
        return "SEP" if kinds & {"AND", "BUT", "THEN"} else ""
    if rest[0].kind in ("EXCEPT", "WITHOUT") and kinds <= {"COMMA", "AND", "BUT"}:
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
