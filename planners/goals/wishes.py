"""Is one goal of a reply what the operator's own words ask for? Each objection is one sentence for the model."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from planners.goals.offered import EVERYTHING, Offered
from planners.goals.reply import Wish
from planners.goals.words import ALSO, ASKED_BY, OPPOSITE, Instruction, Told, cues, denies, negates
from planners.prompt import one_line
from planners.scripted.resolve import FLAG, named
from planners.scripted.transports import enclosed
from wire.catalogue import type_row
from wire.names import called

LIGHT = frozenset(
    {
        "get",
        "put",
        "take",
        "set",
        "check",
        "start",
        "use",
        "cut",
        "drop",
        "lay",
        "grab",
        "return",
        "collect",
        "see",
        "remove",
    }
)
"""Verbs that say little alone: "get the TV off" moves nothing."""
ACTS = frozenset(ASKED_BY) - {"ISOPEN", "ISCLOSED", "ISON", "ISOFF", "ISCLEAN", "ISSLICED", "VIEW"}
"""Token types of verbs that ask for something wherever they stand."""
PLACED = ("in", "at")


@dataclass(frozen=True)
class Entry:
    """A wish with the operator's words that it rests on."""

    wish: Wish
    kept: bool
    span: frozenset[int]
    told: tuple[Told, ...]
    types: frozenset[str]
    rooms: frozenset[str]

    @property
    def everything(self) -> bool:
        return self.wish.a == EVERYTHING


def entry_of(wish: Wish, kept: bool, instruction: Instruction, offered: Offered) -> Entry:
    """Looks up what a wish names, and where its words stand."""
    names = [name for name in (wish.a, wish.b, wish.a_in, wish.b_in, *wish.out) if name is not None]
    span = instruction.find(wish.of)
    return Entry(
        wish,
        kept,
        span,
        tuple(instruction.within(span)),
        frozenset(kind for name in names if (kind := offered.type_of(name)) is not None),
        frozenset(name for name in names if name in offered.rooms),
    )


def is_act(told: Told) -> bool:
    """A verb that cannot be passed over."""
    return told.word.kind in ACTS and told.word.meaning.base not in LIGHT


def wish_faults(entry: Entry, instruction: Instruction, offered: Offered) -> list[str]:
    """What is wrong with it; nothing where it may stand."""
    unknown = list(_unknown_names(entry, offered))
    if unknown:
        return unknown
    if not entry.span:
        return [f"of '{_cut(entry.wish.of)}' is not in the instruction: copy words of it"]
    faults = [
        *_affordance(entry, offered),
        *_unasked(entry),
        *_stray(entry, instruction),
        *_ungrounded(entry, instruction),
        *_amount(entry, instruction),
    ]
    return list(dict.fromkeys(faults))


def _cut(text: str) -> str:
    return one_line(text, 60)


def _unknown_names(entry: Entry, offered: Offered) -> Iterator[str]:
    wish = entry.wish
    if wish.p not in offered.predicates and not (entry.kept and wish.p == "touched"):
        yield f"p cannot be '{_cut(wish.p)}'" + (" in goals: put it into keep" if wish.p == "touched" else "")
    subjects = {*offered.types, *offered.rooms, *offered.things}
    for name in (wish.a, *wish.out):
        if name not in subjects and not (name == EVERYTHING and name == wish.a):
            yield f"'{_cut(name)}' is not offered: choose an offered name, or put the operator's words into unknown"
    places = {*offered.rooms, *offered.holders()}
    for place in (wish.b, wish.a_in):
        if place is not None and place not in places:
            why = "holds nothing" if place in subjects else "is not offered"
            yield f"'{_cut(place)}' {why}: b and a_in are rooms, or things to put something in or on"
    if wish.b_in is not None and wish.b_in not in offered.rooms:
        yield f"b_in '{_cut(wish.b_in)}' is no offered room"


def _affordance(entry: Entry, offered: Offered) -> Iterator[str]:
    """Fridges open, apples do not."""
    flag = FLAG.get("in" if entry.wish.p in PLACED else entry.wish.p)
    kind = offered.type_of(entry.wish.a)
    if flag is not None and kind is not None and not type_row(kind).can(flag[0]):
        yield f"{named(kind)} cannot be {flag[1]}: '{entry.wish.of}'"
    holder = offered.type_of(entry.wish.b or "") or ""
    if any(on.text.startswith("on") and _names(noun, holder) for on, noun in _prepositions(entry.told)) and enclosed(
        holder
    ):
        yield f"things go into {named(holder)}, not on top of it: put the words into unknown"
    if entry.wish.p not in PLACED and entry.wish.b is not None:
        yield f"b is only for in and at, not for {entry.wish.p}"


def _names(noun: Told, type_name: str) -> bool:
    return noun.word.kind in ("NOUN", "ID") and type_name in noun.word.meaning.types


def _prepositions(told: Sequence[Told]) -> Iterator[tuple[Told, Told]]:
    """Each "in", "on" or "into" with the word that follows it, articles left out."""
    yield from (
        (before, after)
        for before, after in pairwise(word for word in told if word.word.kind not in ("THE", "ADJ"))
        if before.word.kind in ("IN", "ON", "INTO")
    )


def _unasked(entry: Entry) -> Iterator[str]:
    """A predicate for which nothing in its words speaks."""
    denied = any(denies(told) for told in entry.told)
    speaks = {predicate for told in entry.told if told.word.kind != "TURN" for predicate in told.asks}
    speaks |= turned(entry.told)
    if any(negates(told) for told in entry.told):
        speaks |= {OPPOSITE[predicate] for predicate in speaks if predicate in OPPOSITE}
    acts = any(is_act(told) for told in entry.told)
    particle = _before_turning(entry.told)
    if particle is not None and not denied and entry.wish.p == OPPOSITE[particle]:
        yield f"'{_cut(entry.wish.of)}' asks for {particle}, not for {entry.wish.p}"
        return
    same = {"in", "at"} if entry.wish.p in PLACED else {entry.wish.p}
    if speaks & same:
        return
    strange = any(told.nameless and not told.asks for told in entry.told)
    if entry.kept and entry.wish.p == "touched" and denied and not acts:
        return
    if acts or not strange:
        yield f"'{_cut(entry.wish.of)}' does not ask for {entry.wish.p}: change p, or leave the goal out"


def turned(told: Sequence[Told]) -> set[str]:
    """ "Turn off", "turn the TV off": the particle says which; without one it may be either."""
    if all(word.word.kind != "TURN" for word in told):
        return set()
    said = {word.text for word in told} & {"on", "off"}
    return said or {"on", "off"}


def _before_turning(told: Sequence[Told]) -> str | None:
    """The particle that stands right after the verb; an "on" further on may be a place."""
    for verb, particle in pairwise(told):
        if verb.word.kind == "TURN" and particle.text in ("on", "off"):
            return particle.text
    return None


def _ungrounded(entry: Entry, instruction: Instruction) -> Iterator[str]:
    """A type or a room that the operator did not name, in known words or in others."""
    hints = cues()["hints"]
    strange = any(told.nameless and (not told.asks or told.text in hints["things"]) for told in entry.told)
    named_types = {name for told in instruction.told for name in told.word.meaning.types}
    discarded = any(told.word.kind == "DISCARD" or told.text in hints["binned"] for told in entry.told)
    for kind in sorted(entry.types - named_types):
        if not strange and not (discarded and kind == "GarbageCan"):
            yield f"no word of '{_cut(entry.wish.of)}' names {called(kind)}"
    if (
        entry.everything
        and not strange
        and all(told.word.kind not in ("EVERYTHING", "ONES", "NOTHING", "ALL") for told in entry.told)
    ):
        yield f"'{_cut(entry.wish.of)}' does not say everything"
    if entry.everything:
        for told in entry.told:
            if told.word.kind == "NOUN" and not entry.types & set(told.word.meaning.types):
                yield f"'{told.text}' is one thing and not everything: make it a, or leave it out of the quotation"
    rooms = {id for told in instruction.told if told.word.kind in ("ROOM", "ROOMWORD") for id in told.word.meaning.ids}
    wide = any(told.word.kind in ("HOUSE", "ANYWHERE") or told.text in hints["wide"] for told in instruction.told)
    for room in sorted(entry.rooms - rooms):
        if not strange and not wide:
            yield f"no word of '{_cut(entry.wish.of)}' names {room}"


def _stray(entry: Entry, instruction: Instruction) -> Iterator[str]:
    """Strange words in a quotation stand for something in the goal, or they hide what it does not do."""
    runs: list[list[Told]] = []
    for told in entry.told:
        if told.nameless and not told.asks and not denies(told):
            if runs and max(runs[-1][-1].at) + 1 == min(told.at):
                runs[-1].append(told)
            else:
                runs.append([told])
    known = {name for told in instruction.told for name in told.word.meaning.types}
    rooms = {id for told in instruction.told for id in told.word.meaning.ids}
    speaks = any(told.asks for told in entry.told if told.word.kind not in ALSO)
    explained = len(entry.types - known) + len(entry.rooms - rooms) + (not speaks) + entry.everything
    for run in runs[explained:]:
        words = " ".join(told.word.text for told in run)
        yield f"'{words}' has no part in {entry.wish.p} {entry.wish.a}: quote only the goal's own words"


def _amount(entry: Entry, instruction: Instruction) -> Iterator[str]:
    """Every one, so many, or one: as the noun is said."""
    wish = entry.wish
    if entry.kept or wish.a == EVERYTHING:
        return
    for index, told in enumerate(instruction.told):
        if told.at <= entry.span and told.word.kind == "NOUN" and _subject(told, wish, instruction.told[:index]):
            yield from _noun_amount(told, wish, instruction.told[max(index - 4, 0) : index])
            return


def _subject(told: Told, wish: Wish, before: Sequence[Told]) -> bool:
    """The noun is what the goal is about, and not an exception from it."""
    return wish.a in told.word.meaning.types and not any(t.word.kind in ("EXCEPT", "ALLBUT") for t in before[-3:])


def _noun_amount(told: Told, wish: Wish, before: Sequence[Told]) -> Iterator[str]:
    quantifiers = quantifiers_before(before)
    number = next((int(t.word.meaning.base) for t in quantifiers if t.word.kind == "NUM"), None)
    if any(t.word.kind == "BOTH" for t in quantifiers):
        number = 2
    if number is not None and number > 1:
        if wish.n != number:
            yield f"'{told.text}' are {number}: n must be {number}"
        return
    one = number == 1 or any(t.word.kind == "ONES" for t in quantifiers)
    every = any(t.word.kind in ("ALL", "NO") for t in quantifiers) or (told.word.meaning.plural and not one)
    if every and not wish.all:
        yield f"'{told.text}' means every one: all must be true"
    if not every and (wish.all or (wish.n or 1) > 1):
        yield f"'{told.text}' is one: leave out all and n"


def quantifiers_before(before: Sequence[Told]) -> list[Told]:
    """The words just before a noun that say how many: back to the first that is none of them."""
    found: list[Told] = []
    for told in reversed(before):
        if told.word.kind not in (
            "THE",
            "ALL",
            "BOTH",
            "NUM",
            "OF",
            "NO",
            "ONES",
            "ADJ",
            "DIRTY",
            "ISCLEAN",
            "CLEAN",
            "OPEN",
            "ISOPEN",
            "ISCLOSED",
        ):
            break
        found.append(told)
    return found
