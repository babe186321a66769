"""The operator's words, each with what it may mean, and where a quotation of some of them stands among them."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files

from planners.goals.offered import INSTRUCTION_LIMIT
from planners.prompt import one_line
from planners.scripted.lexicon import Lexicon, Word
from wire.messages.world import WorldState
from wire.names import read_phrases

ASKED_BY: dict[str, frozenset[str]] = {
    "PUT": frozenset({"in", "at"}),
    "BRING": frozenset({"in", "at", "found"}),
    "PICK": frozenset({"in", "at", "touched"}),
    "DISCARD": frozenset({"in", "at"}),
    "OPEN": frozenset({"open"}),
    "ISOPEN": frozenset({"open"}),
    "CLOSE": frozenset({"closed"}),
    "ISCLOSED": frozenset({"closed"}),
    "SWITCH_ON": frozenset({"on"}),
    "ISON": frozenset({"on"}),
    "SWITCH_OFF": frozenset({"off"}),
    "ISOFF": frozenset({"off"}),
    "TURN": frozenset({"on", "off"}),
    "CLEAN": frozenset({"clean"}),
    "ISCLEAN": frozenset({"clean"}),
    "SLICE": frozenset({"sliced"}),
    "ISSLICED": frozenset({"sliced"}),
    "FIND": frozenset({"found", "visited", "in", "at"}),
    "GO": frozenset({"visited", "found", "seen_from_above"}),
    "VIEW": frozenset({"seen_from_above"}),
    "FLY_OVER": frozenset({"seen_from_above"}),
    "SHOOT": frozenset({"seen_from_above"}),
    "SURVEY": frozenset({"surveyed"}),
    "TOUCH": frozenset({"touched"}),
}
"""Token type of the grammar -> the predicates that such a verb or state asks for."""
ALSO: dict[str, frozenset[str]] = {
    "IN": frozenset({"in", "at"}),
    "INTO": frozenset({"in"}),
    "TO": frozenset({"at", "in"}),
    "ON": frozenset({"on", "in"}),
    "OFF": frozenset({"off"}),
    "DIRTY": frozenset({"clean"}),
    "ALONE": frozenset({"touched"}),
    "LEAVE": frozenset({"touched", "in", "at"}),
    "ABOVE": frozenset({"seen_from_above"}),
}
"""Small words that a goal may rest on, and that ask for nothing alone."""
OPPOSITE = {"on": "off", "off": "on", "open": "closed", "closed": "open"}
DENYING = frozenset({"NOT", "WITHOUT", "NO", "NOTHING"})
NAMING = frozenset({"NOUN", "ID", "ROOM"})
NAMELESS = frozenset({"UNKNOWN", "MAYBE"})
_RAW = re.compile(r"[^\W_]+(?:['_-][^\W_]+)*")


@lru_cache(maxsize=1)
def cues() -> dict[str, dict[str, frozenset[str]]]:
    """Every table of `cues.toml`."""
    read = read_phrases(files("planners.goals").joinpath("cues.toml").read_text())
    return {table: {row: frozenset(words) for row, words in rows.items()} for table, rows in read.items()}


@dataclass(frozen=True)
class Told:
    """One word or phrase of the instruction; `at`: the numbers of its words."""

    word: Word
    at: frozenset[int]

    @property
    def text(self) -> str:
        return self.word.text.lower()

    @property
    def nameless(self) -> bool:
        """A word that may name or ask for something, and that the grammar does not know."""
        return self.word.kind in NAMELESS and self.text not in cues()["small"]["words"]

    @property
    def asks(self) -> frozenset[str]:
        """The predicates that it may ask for."""
        if self.word.kind in ASKED_BY:
            return ASKED_BY[self.word.kind]
        if self.word.kind in NAMING:
            return frozenset()
        known = ALSO.get(self.word.kind, frozenset())
        return known | {predicate for predicate, words in cues()["asks"].items() if self.text in words}


class Instruction:
    """What the operator said, word by word."""

    def __init__(self, text: str, world: WorldState) -> None:
        self.text = one_line(text, INSTRUCTION_LIMIT)
        raw = list(_RAW.finditer(self.text))
        self._words = [match.group().lower() for match in raw]
        told = (
            Told(word, frozenset(i for i, m in enumerate(raw) if m.start() < word.end and word.start < m.end()))
            for word in Lexicon(world).words(self.text)
            if word.kind not in ("COMMA", "STOP")
        )
        self.told = [each for each in told if each.at]

    def find(self, words: str) -> frozenset[int]:
        """Where quoted words stand: in one piece if they do, else in their order; nowhere if one is not the operator's."""
        wanted = [match.group().lower() for match in _RAW.finditer(one_line(words, INSTRUCTION_LIMIT))]
        size = len(wanted)
        for start in range(len(self._words) - size + 1):
            if wanted and self._words[start : start + size] == wanted:
                return frozenset(range(start, start + size))
        return self._in_order(wanted)

    def _in_order(self, wanted: Sequence[str]) -> frozenset[int]:
        found: list[int] = []
        for word in wanted:
            start = found[-1] + 1 if found else 0
            if word not in self._words[start:]:
                return frozenset()
            found.append(self._words.index(word, start))
        return frozenset(found)

    def speaker_at(self, span: frozenset[int]) -> frozenset[int]:
        """Words of a quotation that say where the speakers themselves are or go: "I am off to bed"."""
        speaker = cues()["speaker"]
        if not span or self._words[min(span)] not in speaker["begins"]:
            return frozenset()
        return span & frozenset(i for place in speaker["places"] for i in self._at(place.split()))

    def _at(self, phrase: Sequence[str]) -> Iterator[int]:
        """The numbers of all words that belong to such a phrase."""
        for start in range(len(self._words) - len(phrase) + 1):
            if self._words[start : start + len(phrase)] == phrase:
                yield from range(start, start + len(phrase))

    def within(self, span: Iterable[int]) -> list[Told]:
        """The words and phrases that lie in a quotation."""
        places = frozenset(span)
        return [told for told in self.told if told.at <= places]


def denies(told: Told) -> bool:
    """Whether a word takes something out of what is asked for."""
    return told.word.kind in DENYING or excepts(told) or told.text in cues()["denies"]["words"]


def negates(told: Told) -> bool:
    """Whether a word turns a state into its opposite."""
    return told.word.kind in DENYING or told.text in ("dont", "wont", "cannot")


def excepts(told: Told) -> bool:
    """Whether a word leaves something out of a list."""
    return told.word.kind in ("EXCEPT", "ALLBUT")
