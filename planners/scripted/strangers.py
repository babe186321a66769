"""Words that no clause can use, refused before the grammar sees them; for good where no other reading would help."""

import re
from collections.abc import Sequence

from planners.scripted.fillers import clause_starts
from planners.scripted.lexicon import Word
from planners.scripted.syntax import Unclear

NAMING = {"IN", "ON", "INTO", "TO", "FROM", "THE", "ALL"}
"""Words that belong to the name that follows them when it is not understood."""

STRANGE = {
    "LIMIT": "I cannot do '{part}': {base}",
    "NOROOM": "there is no {base} in this building",
    "NOID": "nothing here is called {base}",
    "ROBOT": "robots are chosen by the planner: leave out '{base}'",
    "UNSEEN": "no camera here can recognise a {base}",
    "REPORTED": "only what you ask for yourself is done: leave out '{part}' and say what should be true at the end",
}
"""What to say of words that are known and of no use here."""

TALK = frozenset({"me", "us", "here", "him", "her", "what", "why", "who", "how", "which", "either"})
"""Limits that other wording may get round: somebody talks of people, or asks in passing."""
GIVING = frozenset({"hand", "pass", "give", "show", "tell", "serve", "lend"})
_MARKS = re.compile('["“”„«»]')


def refuse_strangers(words: Sequence[Word], instruction: str) -> None:
    """Raises Unclear for the first word that is of no use, those first for which there is no help."""
    _refuse_quotations(words, instruction)
    parts = [(word, _part(words, index)) for index, word in enumerate(words)]
    for word, part in parts:
        if word.kind == "CONTROL":
            raise Unclear(word.meaning.base, part, final=True)
    strange = [
        (word, part, _is_final(words, index)) for index, (word, part) in enumerate(parts) if word.kind in STRANGE
    ]
    unknown = [part for word, part in parts if word.kind == "UNKNOWN"]
    for word, part, final in strange:
        if final and (unknown or word.kind != "LIMIT"):
            raise _stranger(word, part, final=True)
    if unknown:
        listed = " and ".join(f"'{part}'" for part in unknown[:4])
        raise Unclear(f"I do not understand {listed}", unknown[0])
    for index, (word, part) in enumerate(parts):
        if word.kind == "MAYBE":
            raise Unclear(f"I do not know '{word.text}': do you mean {word.meaning.base}?", part, question=True)
        if word.kind in STRANGE:
            raise _stranger(word, part, final=_is_final(words, index))


def _stranger(word: Word, part: str, *, final: bool) -> Unclear:
    return Unclear(STRANGE[word.kind].format(part=part, base=word.meaning.base), part, final=final)


def _is_final(words: Sequence[Word], index: int) -> bool:
    """ "Me" is a person in passing, unless something is to be brought to them."""
    word = words[index]
    if word.kind != "LIMIT" or word.text.lower() not in TALK:
        return True
    before = words[index - 1] if index else None
    return before is not None and (before.kind in ("BRING", "TO") or before.text.lower() in GIVING)


def _refuse_quotations(words: Sequence[Word], instruction: str) -> None:
    """What stands in quotation marks is a name: with a verb in it, it may be something that somebody else wants."""
    marks = [match.start() for match in _MARKS.finditer(instruction)]
    for start, end in zip(marks[::2], [*marks[1::2], len(instruction)], strict=False):
        inside = [word for word in words if start < word.start < end]
        if len(inside) > 1 and any(word.kind in clause_starts() for word in inside):
            part = instruction[start + 1 : end].strip()
            asked = f"should '{part}' be done, or is it only quoted? Say it without quotation marks, or leave it out"
            raise Unclear(asked, part, question=True)


def _part(words: Sequence[Word], index: int) -> str:
    """A word with the small words before it: "to the moon"."""
    start = index
    while start > 0 and words[start - 1].kind in NAMING:
        start -= 1
    return " ".join(w.text for w in words[start : index + 1])
