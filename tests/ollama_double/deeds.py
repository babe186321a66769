"""The emulated planner's understanding: clauses of what was heard, and what each of them asks for."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from tests.ollama_double.english import Heard

JOINING = ("then", "before", "after")
ENDING = (".", "!", "?", ";", ":")
TURNING = ("but", "so", "because", "since")
SOFT = frozenset({"and", "but", "so", "because", "since", "as", "however", "plus"})
EMPTY = ("word", "mark", "pronoun", "to", "from")
ARTICLES = frozenset({"the", "a", "an", "my", "our", "your", "that", "this"})
IDLE = frozenset(
    {"please", "also", "just", "the", "a", "can", "you", "could", "to", "would", "now", "we", "i", "kindly"}
)


@dataclass
class Clause:
    """Words up to the next one that begins something new; `joint` is what stood before it."""

    items: list[Heard]
    joint: str = ""
    wishes: list[dict[str, Any]] = field(default_factory=list)

    def all(self, kind: str) -> list[Heard]:
        return [item for item in self.items if item.kind == kind]

    def span(self) -> tuple[int, int]:
        return self.items[0].start, self.items[-1].end

    def core(self) -> tuple[int, int]:
        """Without the words before the first that means something."""
        first = next((i for i, item in enumerate(self.items) if item.kind not in EMPTY), 0)
        while first and self.items[first - 1].text.lower() in ARTICLES:
            first -= 1
        return self.items[first].start, self.items[-1].end


def clauses(heard: Sequence[Heard]) -> list[Clause]:
    found = [Clause([])]
    for index, item in enumerate(heard):
        if item.kind == "deny" and found[-1].all("verb") and found[-1].all("noun") and _begins(heard[index + 1 :]):
            found.append(Clause([item], "and"))
        elif item.kind in JOINING or item.text in ENDING or item.text.lower() in TURNING:
            found.append(Clause([], item.kind if item.kind in JOINING else "mark"))
        elif _goes_on(item, found, heard[index + 1 :]):
            found.append(Clause([], "and"))
        elif not (item.kind == "mark" and not found[-1].items):
            found[-1].items.append(item)
    return _merged([clause for clause in found if any(i.kind != "mark" for i in clause.items)])


def _merged(found: list[Clause]) -> list[Clause]:
    """ "Grab the mug and stash it in the sink" is one deed."""
    kept: list[Clause] = []
    for clause in found:
        before = kept[-1] if kept else None
        taken = before is not None and [i.value[0] for i in before.all("verb")] == ["move"] and not before.all("to")
        if before is not None and taken and clause.all("pronoun") and clause.all("to") and not clause.all("noun")[1:]:
            before.items += [item for item in clause.items if item.kind != "pronoun"]
        else:
            kept.append(clause)
    return kept


def _goes_on(item: Heard, found: Sequence[Clause], rest: Sequence[Heard]) -> bool:
    """A comma or an "and" that another clause follows."""
    if item.kind == "mark" and found[-1].joint in ("before", "after") and len(found) <= 2:
        return True
    kinds = [other.kind for other in rest]
    if item.text.lower() in ("and", ",") and found[-1].all("to") and "to" in kinds:
        before = kinds[: kinds.index("to")]
        if "noun" in before and "verb" not in before:
            return True
    return (item.kind == "mark" or item.text.lower() in SOFT) and _begins(rest)


def _begins(rest: Sequence[Heard]) -> bool:
    """A verb or a denial comes before any noun."""
    for item in rest:
        if item.kind in ("verb", "deny"):
            return True
        if item.kind in JOINING:
            return True
        if item.kind != "word" or item.text.lower() not in IDLE:
            return False
    return False


class Understanding:
    """Goes through clauses; remembers what "it" is."""

    def __init__(self) -> None:
        self._last: list[dict[str, Any]] = []
        self._deed: str | None = None
        self.unknown: list[str] = []
        self.ask = ""

    def read(self, clause: Clause) -> None:
        """Fills in the wishes of a clause."""
        deed = self._deed_of(clause)
        if deed is None:
            self._hear_command(clause)
            return
        denied = bool(clause.all("deny"))
        subjects, place = self._parts(clause, deed)
        if not subjects:
            if not clause.all("verb") or deed == "touched":
                return
            words = [
                i.text for i in clause.items if i.kind == "word" and len(i.text) > 3 and i.text.lower() not in IDLE
            ]
            if words and deed != "visited":
                self.unknown.append(words[-1])
            return
        keeping = denied and not (clause.all("state") and deed in ("on", "off", "open", "closed"))
        if denied and not keeping:
            deed = {"on": "off", "off": "on", "open": "closed", "closed": "open"}[deed]
        wishes = [self._wish(deed, subject, place, keeping) for subject in subjects]
        if any(wish is None for wish in wishes):
            self.ask = f"where should it go: {clause.items[0].text} ...?"
            return
        clause.wishes = [wish for wish in wishes if wish is not None]
        self._last = [{k: v for k, v in s.items() if k in ("a", "all", "n", "a_in")} for s in subjects]
        self._last += [{"a": place["b"]}] if "b" in place else []

    def _hear_command(self, clause: Clause) -> None:
        """ "Feed the goldfish": no word that it knows, and still something to do."""
        words = [item.text for item in clause.items if item.text.lower() not in IDLE - ARTICLES]
        if (
            len(words) > 2
            and words[1].lower() in ARTICLES
            and words[0].lower() not in ("be", "pardon", "forgive", "excuse")
        ):
            self.unknown.append(words[2])

    def _deed_of(self, clause: Clause) -> str | None:
        states = [item.value[0] for item in clause.all("state")]
        deeds = [item.value[0] for item in clause.all("verb")]
        if clause.all("deny") and not states and not deeds and (clause.all("noun") or clause.all("room")):
            return "visited" if clause.all("room") and not clause.all("noun") else "touched"
        if (not deeds or deeds[0] == "turn") and states:
            self._deed = states[-1]
        elif deeds and deeds[0] == "turn":
            self._deed = next((d for d in deeds if d != "turn"), "move")
        elif deeds:
            named = [d for d in deeds if d != "move"] if states else deeds
            self._deed = (
                states[-1] if states and deeds[0] == "move" and states[-1] in ("on", "off") else (named or deeds)[0]
            )
        elif clause.joint not in ("and", "then") or not (clause.all("noun") or clause.all("room")):
            return None
        return self._deed

    # Things and places

    def _parts(self, clause: Clause, deed: str) -> tuple[list[dict[str, Any]], dict[str, Any]]:
        items = clause.items
        cut = next((i for i, item in enumerate(items) if item.kind == "except"), len(items))
        body, out = items[:cut], _names(items[cut:])
        place: dict[str, Any] = {}
        if deed in ("move", "discard"):
            body, place = _destination(body)
            if not place and out:
                _, place = _destination(items)
                out = [name for name in out if name != place.get("b")]
            if deed == "discard" and "b" not in place:
                place = {"b": "GarbageCan"}
        subjects = list(self._subjects(body, deed))
        for subject in subjects:
            if out:
                subject["except"] = out
        return subjects, place

    def _subjects(self, items: Sequence[Heard], deed: str) -> Iterator[dict[str, Any]]:
        found = list(_named(items))
        if not found and any(item.kind == "pronoun" for item in items):
            found = [dict(last) for last in self._last[:1]]
        rooms = [room for item in items if item.kind == "room" for room in item.value]
        if deed == "visited" and not found:
            yield from ({"a": room} for room in rooms)
            return
        where = (_holders(items) or rooms)[:1]
        for subject in found:
            yield {**subject, "a_in": where[0]} if where else subject

    def _wish(self, deed: str, subject: dict[str, Any], place: dict[str, Any], keeping: bool) -> dict[str, Any] | None:
        if deed in ("move", "discard"):
            if "b" not in place and not keeping:
                return None
            return {
                "p": "at" if place.get("room") else "in",
                **subject,
                **{k: v for k, v in place.items() if k != "room"},
            }
        if deed == "touched" and not keeping:
            return {"p": "visited", **subject}
        return {"p": deed, **subject}


def _named(items: Sequence[Heard]) -> Iterator[dict[str, Any]]:
    """Things up to the first place, each with how many of it are meant."""
    every, number = False, None
    for index, item in enumerate(items):
        if item.kind == "every" and item.text.lower() == "both":
            number = 2
        elif item.kind in ("every", "house") or item.text.lower() == "no":
            every = True
        elif item.kind == "number":
            number = int(item.value[0])
        elif item.kind == "everything":
            yield {"a": "Everything", "all": True}
        elif item.kind == "noun" and not _placed(items[:index]):
            yield from _counted(item, every, number)
            every, number = every and _listed(items[index + 1 :]), None


def _placed(before: Sequence[Heard]) -> bool:
    """A preposition stands between this noun and one before it."""
    marks = [i for i, item in enumerate(before) if item.kind in ("to", "from")]
    return bool(marks) and any(item.kind in ("noun", "everything") for item in before[: marks[-1]])


def _holders(items: Sequence[Heard]) -> list[str]:
    """What the things are in or on."""
    return [item.value[0] for index, item in enumerate(items) if item.kind == "noun" and _placed(items[:index])]


def _counted(item: Heard, every: bool, number: int | None) -> Iterator[dict[str, Any]]:
    types = item.value if item.many or every else item.value[:1]
    for name in types:
        wish: dict[str, Any] = {"a": name}
        if number is not None:
            wish["n"] = number
        elif every or item.many:
            wish["all"] = True
        yield wish


def _listed(rest: Sequence[Heard]) -> bool:
    """ "Every mug and plate": the next noun has no article of its own."""
    return bool(rest) and rest[0].text.lower() in ("and", ",") and len(rest) > 1 and rest[1].kind == "noun"


def _names(items: Sequence[Heard]) -> list[str]:
    """What is left out: rooms before things, since "the one in the kitchen" is told by its room."""
    rooms = [name for item in items if item.kind == "room" for name in item.value]
    return rooms or [name for item in items if item.kind == "noun" for name in item.value]


def _destination(items: Sequence[Heard]) -> tuple[list[Heard], dict[str, Any]]:
    """Where the last "in", "on" or "to" before a name leads; what stands before it is what goes there."""
    marks = [i for i, item in enumerate(items) if item.kind == "to" and _name_after(items[i + 1 :]) is not None]
    if not marks:
        return list(items), {}
    at = marks[-1]
    target = _name_after(items[at + 1 :])
    assert target is not None
    if target.kind == "room" and len(marks) > 1:
        holder = _name_after(items[marks[-2] + 1 : at])
        if holder is not None and holder.kind == "noun":
            return list(items[: marks[-2]]), {"b": holder.value[0], "b_in": target.value[0]}
    if target.kind == "room":
        return list(items[:at]), {"b": target.value[0], "room": True}
    return list(items[:at]), {"b": target.value[0]}


def _name_after(items: Sequence[Heard]) -> Heard | None:
    for item in items:
        if item.kind in ("noun", "room"):
            return item
        if item.kind not in ("word", "every"):
            return None
    return None
