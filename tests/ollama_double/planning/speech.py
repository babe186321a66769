"""What an instruction wants, as the emulated planner understands it: verbs, what they are about, where to, and what not."""

import re
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Literal

from tests.ollama_double.planning.prompt_text import Known, Thing
from wire.catalogue import catalogue
from wire.names import classes, names_of, plural

Verb = Literal["move", "toggle_on", "toggle_off", "open", "close", "slice", "clean", "find", "visit", "touch"]
_VERBS: tuple[tuple[str, Verb], ...] = (
    (r"(?:turn|switch|power) +off|power +down|shut +off|turning +off|switching +off", "toggle_off"),
    (r"(?:turn|switch|power) +on|turning +on|switching +on", "toggle_on"),
    (r"(?:pick +up|put|place|bring|carry|take|move|store|gather|return|throw|dispose +of)\b", "move"),
    (r"open(?:ing)?\b", "open"),
    (r"(?:close|closing|shut)\b", "close"),
    (r"(?:slice|cut|chop)\b", "slice"),
    (r"(?:wash|clean|rinse)\b", "clean"),
    (r"(?:find|locate|look +for|search +for)\b", "find"),
    (r"(?:go +to|visit|go +into|explore|look +into|check|inspect|look +at)\b", "visit"),
    (r"touch(?:ing)?\b", "touch"),
)
_NOT = re.compile(r"(?:do +not|don't|never|without|not)\b *")
_ALONE = re.compile(r"(?:leave|keep)\b *(.*?)(?: +(?:alone|as .* is|where .* is|in place))?$")
_POLITE = re.compile(r"\b(?:please|could you|can you|i want you to|make sure(?: that)?|kindly|now)\b", re.I)
_CUT = re.compile(r" *(?:[,;.]|\b(?:and then|then|and|but)\b)+ *")
_INTO = re.compile(r" +(?:into|onto|inside|in|on|to)(?: +top +of)? +")
_NUMBERS = {"two": 2, "both": 2, "three": 3, "four": 4}
_ALL = re.compile(r"\b(?:every|all|each)\b")


@dataclass(frozen=True)
class Noun:
    """What is meant: types by their words, or one thing by its name."""

    words: frozenset[str] = frozenset()
    name: str = ""
    room: str = ""
    every: bool = False
    count: int = 1
    without: "Noun | None" = None
    inside: "Noun | None" = None
    """Only what rests in or on such a thing."""
    it: bool = False
    """Whatever the wish before was about."""

    def means(self, thing: Thing) -> bool:
        if self.without is not None and self.without.means(thing):
            return False
        if self.inside is not None and (thing.holder is None or not self.inside.means(thing.holder)):
            return False
        if self.room and thing.room != self.room:
            return False
        return thing.name == self.name if self.name else thing.word in self.words


@dataclass(frozen=True)
class Wish:
    verb: Verb
    what: Noun
    to: Noun | None = None
    group: int = 0
    """Wishes of a later group come after those of earlier ones."""


@dataclass
class Wishes:
    wanted: list[Wish] = field(default_factory=list)
    banned: list[Wish] = field(default_factory=list)


@lru_cache(maxsize=1)
def _phrases() -> dict[str, frozenset[str]]:
    """What people call things -> the words of types."""
    table: dict[str, frozenset[str]] = {}
    for type in catalogue():
        for phrase in names_of(type):
            for form in (phrase, plural(phrase)):
                table[form] = table.get(form, frozenset()) | {type.lower()}
    for phrase, types in classes().items():
        for form in (phrase, plural(phrase)):
            table[form] = table.get(form, frozenset()) | {type.lower() for type in types}
    return table


def read_wishes(instruction: str, known: Known, negations: bool = True) -> Wishes:
    """Clause by clause; one without a verb of its own goes on with the last. `negations`: whether a not is noticed."""
    wishes = Wishes()
    verb: Verb | None = None
    waiting: list[Noun] = []
    group, at = 0, 0
    text = _POLITE.sub("", instruction.lower()).strip(" .!")
    for cut in (*_CUT.finditer(text), None):
        clause, separator = text[at : cut.start() if cut else None].strip(), cut[0] if cut else ""
        at = cut.end() if cut else at
        inner = re.split(r"\b(?=without\b)", clause)
        for part in filter(None, (p.strip() for p in inner)):
            left = _banned(part, known)
            if left is not None:
                (wishes.banned if negations else wishes.wanted).extend(
                    left if negations else [w for w in left if w.verb != "touch"]
                )
                continue
            verb, waiting = _clause(part, verb, waiting, group, known, wishes.wanted)
        group += "then" in separator
    return wishes


def _banned(part: str, known: Known) -> list[Wish] | None:
    """What must not be done; None when the clause forbids nothing."""
    not_ = _NOT.match(part)
    if not_ is not None:
        found: list[Wish] = []
        _clause(part[not_.end() :], None, [], 0, known, found)
        return found
    alone = _ALONE.fullmatch(part)
    if alone is None:
        return None
    return [Wish("touch", noun) for noun in (read_noun(alone[1], known),) if noun is not None]


def _clause(
    part: str, verb: Verb | None, waiting: list[Noun], group: int, known: Known, wanted: list[Wish]
) -> tuple[Verb | None, list[Noun]]:
    """Add the wishes of a clause. Returns its verb, and things that still wait to hear where they go."""
    for pattern, own in _VERBS:
        match = re.match(pattern, part)
        if match is not None:
            verb, part, waiting = own, part[match.end() :].strip(), []
            break
    else:
        split = re.fullmatch(r"(?:turn|switch|power) +(.*) +(on|off)", part)
        if split is not None:
            verb, part, waiting = ("toggle_on" if split[2] == "on" else "toggle_off"), split[1], []
    if verb is None:
        return verb, waiting
    if verb == "move":
        return verb, _move(part, waiting, group, known, wanted)
    noun = read_noun(part, known)
    if noun is not None:
        wanted.append(Wish(verb, noun, group=group))
    return verb, waiting


def _move(part: str, waiting: list[Noun], group: int, known: Known, wanted: list[Wish]) -> list[Noun]:
    part = re.sub(r" +from +(?=.* to )", " on ", part)
    for into in reversed(list(_INTO.finditer(f" {part}"))):
        to = read_noun(f" {part}"[into.end() :], known)
        what = read_noun(f" {part}"[: into.start()].strip(), known)
        if to is not None and (what is not None or not part[: into.start()].strip()):
            nouns = [*waiting, *([what] if what is not None else [])]
            wanted += [Wish("move", noun, to, group) for noun in nouns]
            return []
    noun = read_noun(part, known)
    return [*waiting, noun] if noun is not None else waiting


def read_noun(text: str, known: Known) -> Noun | None:
    """A thing by its name, a room, or types by what people call them, perhaps in a room or without some."""
    text = text.strip()
    if text in ("it", "them"):
        return Noun(it=True)
    head, _, but = text.partition(" except ")
    if but:
        noun = read_noun(head, known)
        other = read_noun(but, known) or read_noun(re.sub(r"^the one(s)?\b", head, but), known)
        if other is not None and noun is not None and not other.words and other.room:
            other = replace(noun, room=other.room)
        return replace(noun, without=other) if noun is not None else None
    if text in known.things:
        return Noun(name=text)
    for room in sorted(known.rooms, key=lambda r: -len(known.called[r])):
        if re.fullmatch(rf"(?:the +)?(?:{re.escape(known.called[room])}|{re.escape(room)})", text):
            return Noun(room=room)
        within = re.fullmatch(
            rf"(.*?) +(?:in|of|from) +(?:the +)?(?:{re.escape(known.called[room])}|{re.escape(room)})", text
        )
        if within is not None:
            noun = read_noun(within[1], known)
            return replace(noun, room=room) if noun is not None else Noun(room=room)
    held = re.fullmatch(r"(.+?) +(?:in|on|inside) +(.+)", text)
    if held is not None:
        noun, inside = read_noun(held[1], known), read_noun(held[2], known)
        if noun is not None and inside is not None:
            return replace(noun, inside=inside)
    return _types(text)


def _types(text: str) -> Noun | None:
    if text == "everything":
        return Noun(words=frozenset(t.lower() for t, row in catalogue().items() if row.kind == "pickup"), every=True)
    every = _ALL.search(text) is not None
    count = next((n for word, n in _NUMBERS.items() if re.search(rf"\b{word}\b", text)), 1)
    words = re.sub(r"\b(?:the|a|an|my|some|of|every|all|each|two|both|three|four|it|them)\b", " ", text).split()
    for start in range(len(words)):
        phrase = " ".join(words[start:])
        if phrase in _phrases():
            many = phrase not in {p for t in catalogue() for p in names_of(t)} and phrase.endswith("s") and count == 1
            return Noun(words=_phrases()[phrase], every=every or many, count=count)
    return None
