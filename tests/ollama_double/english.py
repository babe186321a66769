"""The emulated planner's ear: words of a sentence with what they mean, by its own English and the names offered to it."""

import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

LONGEST = 5
_PIECE = re.compile(r"[^\W_]+(?:['’-][^\W_]+)*|[.!?;:,]")
_MARKS = (".", "!", "?", ";", ":", ",")


@dataclass(frozen=True)
class Heard:
    """A word or phrase. `kind`: verb, state, noun, room, or a small word's table; `value`: what it stands for."""

    kind: str
    text: str
    start: int
    end: int
    value: tuple[str, ...] = ()
    many: bool = False


@lru_cache(maxsize=1)
def tables() -> dict[str, dict[str, tuple[str, ...]]]:
    read = tomllib.loads(Path(__file__).with_name("english.toml").read_text())
    return {
        table: {row: tuple(part.strip() for part in text.split(",")) for row, text in rows.items()}
        for table, rows in read.items()
    }


def spaced(name: str) -> str:
    """ "coffee table" of "CoffeeTable"."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name).lower()


def plurals(phrase: str) -> tuple[str, ...]:
    *rest, last = phrase.split()
    forms = [f"{last}s", f"{last}es"]
    if last.endswith("y"):
        forms.append(f"{last[:-1]}ies")
    if last.endswith(("f", "fe")):
        forms.append(f"{last.rstrip('e')[:-1]}ves")
    return tuple(" ".join((*rest, form)) for form in forms)


class Ear:
    """Knows English, and the types, rooms and things of one prompt."""

    def __init__(self, types: Sequence[str], rooms: Sequence[str], things: Sequence[str]) -> None:
        self._table: dict[str, tuple[str, tuple[str, ...], bool]] = {}
        for table in (
            "deny",
            "except",
            "every",
            "to",
            "from",
            "then",
            "before",
            "after",
            "pronoun",
            "everything",
            "house",
        ):
            for phrase in tables()[table]["words"]:
                self._table[phrase] = (table, (), False)
        for number, phrases in tables()["number"].items():
            self._table.update({phrase: ("number", (number,), False) for phrase in (number, *phrases)})
        for deed, phrases in tables()["verb"].items():
            for phrase in phrases:
                self._table.setdefault(phrase, ("verb", (deed,), False))
                self._table.setdefault(_gerund(phrase), ("verb", (deed,), False))
        for state, phrases in tables()["state"].items():
            self._table.update({phrase: ("state", (state,), False) for phrase in phrases if phrase not in self._table})
        self._add_nouns(set(types))
        self._add_rooms(rooms)
        self._table.update({name: ("noun", (name,), False) for name in things})
        self._table.update({phrase: ("word", (), False) for phrase in tables()["speaker"]["words"]})

    def _add_nouns(self, types: set[str]) -> None:
        rows = {**tables()["noun"], **tables()["class"]}
        for name in sorted(types):
            self._noun(spaced(name), (name,))
            for phrase in rows.get(name, ()):
                self._noun(phrase, (name,))
        for phrase, members in tables()["class"].items():
            self._noun(phrase, tuple(member for member in members if member in types))
        for phrase in tables()["mass"]["words"]:
            kind, value, _ = self._table[phrase]
            self._table[phrase] = (kind, value, True)

    def _noun(self, phrase: str, value: tuple[str, ...]) -> None:
        if value:
            self._table[phrase] = ("noun", value, False)
            for many in plurals(phrase):
                self._table.setdefault(many, ("noun", value, True))

    def _add_rooms(self, rooms: Sequence[str]) -> None:
        kinds: dict[str, list[str]] = {}
        for room in rooms:
            name = room.replace("-", " ")
            self._table[name] = self._table[room] = ("room", (room,), False)
            kinds.setdefault(re.sub(r" \d+$", "", name), []).append(room)
        for kind, ids in kinds.items():
            self._table.setdefault(kind, ("room", tuple(ids), False))
            self._table.setdefault(f"{kind}s", ("room", tuple(ids), True))
        for word, (room,) in tables()["room"].items():
            if room in rooms:
                self._table[word] = ("room", (room,), False)

    def hear(self, sentence: str) -> list[Heard]:
        """Longest phrases first; what is not known is a `word`."""
        pieces = list(_PIECE.finditer(sentence))
        words = [match.group().lower().replace("’", "'") for match in pieces]
        heard: list[Heard] = []
        at = 0
        while at < len(words):
            size, (kind, value, many) = self._longest(words[at : at + LONGEST])
            start, end = pieces[at].start(), pieces[at + size - 1].end()
            heard.append(Heard(kind, sentence[start:end], start, end, value, many))
            at += size
        return list(_with_particles(heard))

    def _longest(self, words: Sequence[str]) -> tuple[int, tuple[str, tuple[str, ...], bool]]:
        if words[0] in _MARKS:
            return 1, ("mark", (words[0],), False)
        for size in range(len(words), 0, -1):
            found = self._table.get(" ".join(words[:size]))
            if found is not None:
                return size, found
        return 1, ("word", (), False)


def _gerund(verb: str) -> str:
    first, *rest = verb.split()
    stem = first[:-1] if first.endswith("e") else first
    return " ".join((f"{stem}ing", *rest))


def _with_particles(heard: Sequence[Heard]) -> Iterator[Heard]:
    """ "On" and "off" at the end of a clause, or after a form of "be", are states and not places."""
    for index, item in enumerate(heard):
        word = item.text.lower()
        following = heard[index + 1].kind if index + 1 < len(heard) else "mark"
        article = index + 1 < len(heard) and heard[index + 1].text.lower() in ("the", "a", "my", "our", "your", "that")
        if word in ("on", "off") and not article and following not in ("noun", "room", "every", "number", "pronoun"):
            yield Heard("state", item.text, item.start, item.end, (word,))
        else:
            yield item
