"""Words of the live world: types, rooms and ids, so that each word of an instruction gets a type."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from planners.scripted.fuzzy import closest
from planners.scripted.vocabulary import Phrase, fixed_phrases, tables
from wire.catalogue import catalogue, modelled_types
from wire.messages.world import WorldState
from wire.names import classes, collectives, names_of, plural, room_names

LONGEST_PHRASE = 8
_WORD = re.compile(r"(?P<word>[^\W_]+(?:['_-][^\W_]+)*)|(?P<mark>[^\s\"“”()])")
_ID = re.compile(r"[a-z][a-z0-9-]*-\d+")


@dataclass(frozen=True)
class Meaning:
    """What a phrase stands for. `ids`: rooms or one object; `types`: object types."""

    kind: str
    base: str
    types: tuple[str, ...] = ()
    ids: tuple[str, ...] = ()
    plural: bool = False


@dataclass(frozen=True)
class Word:
    """A phrase of the instruction with its meaning; `start` and `end` are positions in the text."""

    meaning: Meaning
    text: str
    start: int
    end: int

    @property
    def kind(self) -> str:
        return self.meaning.kind


class Lexicon:
    """The vocabulary at one moment: what is fixed, and what the world state names."""

    def __init__(self, world: WorldState) -> None:
        self._table: dict[Phrase, Meaning] = {
            phrase: Meaning(kind, base) for phrase, (kind, base) in fixed_phrases().items()
        }
        self._table.update({(word,): Meaning("CALL", word) for word in tables()["dropped"]["at_the_start"]})
        self._add_types({obj.type for obj in world.objects})
        self._add_rooms(world)
        for robot in world.robots:
            for name in ((robot.id,), tuple(robot.id.split("-"))):
                self._table[name] = Meaning("ROBOT", robot.id)
        for obj in world.objects:
            self._table[(obj.id,)] = Meaning("ID", obj.id, (obj.type,), (obj.id,))

    def _add_types(self, present: set[str]) -> None:
        known = present | set(modelled_types())
        for name in sorted(catalogue(), key=lambda n: (n in known, n)):
            kind = "NOUN" if name in known else "UNSEEN"
            for base in names_of(name):
                self._add_noun(base, Meaning(kind, base, (name,)))
        for base, types in classes().items():
            self._add_noun(base, Meaning("NOUN", base, types))
        for base in collectives():
            types = self._table[tuple(base.split())].types
            self._table[tuple(base.split())] = Meaning("NOUN", base, types, plural=True)

    def _add_noun(self, base: str, meaning: Meaning) -> None:
        self._table[tuple(base.split())] = meaning
        many = Meaning(meaning.kind, base, meaning.types, plural=True)
        self._table[tuple(plural(base).split())] = many

    def _add_rooms(self, world: WorldState) -> None:
        rooms: dict[Phrase, list[str]] = {}
        for area in world.areas:
            for base in {area.name.lower(), area.id.replace("-", " "), *room_names(area.kind)}:
                rooms.setdefault(tuple(base.split()), []).append(area.id)
            rooms.setdefault((area.id,), []).append(area.id)
        for phrase, ids in rooms.items():
            distinct, base = tuple(dict.fromkeys(ids)), " ".join(phrase)
            self._table[phrase] = Meaning("ROOM", base, ids=distinct)
            self._table.setdefault(tuple(plural(base).split()), Meaning("ROOM", base, ids=distinct, plural=True))
        every = tuple(area.id for area in world.areas)
        self._table[("rooms",)] = Meaning("ROOMWORD", "room", ids=every, plural=True)
        self._table[("room",)] = Meaning("ROOMWORD", "room", ids=every)
        absent = (word for kind in ("Kitchen", "LivingRoom", "Bedroom", "Bathroom") for word in room_names(kind))
        for word in absent:
            self._table.setdefault(tuple(word.split()), Meaning("NOROOM", word))

    def words(self, text: str) -> list[Word]:
        """The instruction as typed phrases: longest match first, then misspellings, the rest UNKNOWN."""
        pieces = list(self._pieces(text))
        found: list[Word] = []
        at = 0
        while at < len(pieces):
            meaning, size = self._match([piece[0] for piece in pieces[at : at + LONGEST_PHRASE]])
            start, end = pieces[at][1], pieces[at + size - 1][2]
            found.append(Word(meaning, text[start:end], start, end))
            at += size
        return found

    def _pieces(self, text: str) -> Iterable[tuple[str, int, int]]:
        """Words in lower case with their places; contractions spelled out, hyphens of no id split."""
        for match in _WORD.finditer(text.replace("’", "'")):
            word = match.group().lower()
            if word in tables()["contraction"]:
                parts = tables()["contraction"][word][0].split()
            elif "-" in word and (word,) not in self._table and not _ID.fullmatch(word):
                parts = word.split("-")
            else:
                parts = [word]
            yield from ((part, match.start(), match.end()) for part in parts)

    def _match(self, words: Sequence[str]) -> tuple[Meaning, int]:
        for size in range(len(words), 0, -1):
            meaning = self._table.get(tuple(words[:size]))
            if meaning is not None:
                return meaning, size
        if words[0] in ",":
            return Meaning("COMMA", ","), 1
        if words[0] in ";.!?:":
            return Meaning("STOP", words[0]), 1
        if _ID.fullmatch(words[0]):
            return Meaning("NOID", words[0]), 1
        return self._misspelt(words)

    def _misspelt(self, words: Sequence[str]) -> tuple[Meaning, int]:
        for size in (2, 1):
            if len(words) < size or (size == 2 and tuple(words[1:2]) in self._table and len(words[1]) < 4):
                continue
            guess = closest(words[:size], self._table)
            if guess.sure:
                return self._table[guess.phrases[0]], size
            if guess.phrases:
                return Meaning("MAYBE", " or ".join(repr(" ".join(p)) for p in guess.phrases[:3])), size
        return Meaning("UNKNOWN", words[0]), 1
