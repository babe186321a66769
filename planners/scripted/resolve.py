"""Noun phrases to selectors: types by what can be done with them, rooms and places as restrictions, pronouns."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from planners.scripted.syntax import Group, Place, Rooms, State, Thing, Unclear
from planners.scripted.vocabulary import tables
from wire.catalogue import modelled_types, type_row
from wire.messages.goal import Selector
from wire.messages.world import ObjectState, WorldState
from wire.names import called

FLAG = {
    "open": ("openable", "opened"),
    "closed": ("openable", "closed"),
    "on": ("toggleable", "switched on"),
    "off": ("toggleable", "switched off"),
    "clean": ("dirtyable", "cleaned"),
    "sliced": ("sliceable", "sliced"),
    "in": ("pickupable", "carried"),
    "holder": ("receptacle", "used to put things in or on"),
}
"""What a predicate asks of its subject: the flag of the type, and the participle for a refusal."""

IMPLIED: dict[str, State] = {"open": "closed", "closed": "open", "on": "off", "off": "on", "clean": "dirty"}
"""The adjective that a goal makes superfluous: to close the open fridge is to close the fridge."""


def named(type_name: str) -> str:
    name = called(type_name)
    return f"an {name}" if name[0] in "aeiou" else f"a {name}"


@dataclass
class Referents:
    """What pronouns can stand for: the subjects and the places of the last clause that named any."""

    subjects: tuple[Selector, ...] = ()
    places: tuple[Selector, ...] = ()
    room: str | None = None


@dataclass(frozen=True)
class Limits:
    """Where a thing must be to be meant."""

    rooms: tuple[str, ...] = ()
    insides: tuple[str, ...] = ()


class Resolver:
    """Looks the words up in the world as it is believed to be."""

    def __init__(self, world: WorldState) -> None:
        self._world = world
        self._present = {obj.type for obj in world.objects}
        self.last = Referents()

    # Rooms

    def rooms(self, rooms: Rooms) -> tuple[str, ...]:
        """The rooms meant; asks where one is meant and several fit."""
        found: list[str] = []
        for ids, every in zip(rooms.choices, rooms.every, strict=True):
            if len(ids) > 1 and not every:
                raise Unclear(f"which one is meant by '{rooms.text}': {one_of(ids)}?", rooms.text, question=True)
            found.extend(ids)
        self.last.room = found[-1]
        return tuple(dict.fromkeys(found))

    # Things

    def subjects(self, group: Group, predicate: str, inherited: Thing | None = None) -> tuple[Selector, ...]:
        """Every selector that a list member stands for, when `predicate` is to be made true of it."""
        thing = group.thing
        _check_quant(thing, predicate)
        _check_states(thing, predicate)
        limits = self.limits(group.places)
        if thing.head in ("it", "them"):
            return self._pronoun(thing, predicate, limits)
        if thing.room_choice:
            rooms = Rooms(thing.text, (thing.room_choice,), (thing.plural or thing.quant == "all",))
            limits = Limits(limits.rooms + self.rooms(rooms), limits.insides)
        if thing.head == "id":
            self.check(thing.types[0], predicate, thing.text)
            return (Selector(type=thing.types[0], id=thing.id),)
        types, count = self._types(thing, predicate, inherited, limits)
        _check_one_place(group, predicate, count, limits)
        return tuple(
            Selector(type=name, room=room, inside=inside, count=count)
            for name in types
            for room in limits.rooms or (None,)
            for inside in limits.insides or (None,)
        )

    def _types(
        self, thing: Thing, predicate: str, inherited: Thing | None, limits: Limits
    ) -> tuple[tuple[str, ...], int | None]:
        types = thing.types
        if thing.head == "everything":
            types = self._everything(predicate, limits)
        elif thing.head == "one":
            if inherited is None:
                raise Unclear(f"what is meant by '{thing.text}'?", thing.text, question=True)
            types = inherited.types or modelled_types()
        count = _count(thing)
        if thing.states and count is not None and len(self._known(types, limits)) != 1:
            count = None
        fitting = tuple(t for t in types if self._affords(t, predicate))
        if not fitting:
            self.check(types[0], predicate, thing.text)
        if count is None or len(fitting) == 1:
            return fitting, count
        return (self._single(fitting, thing, limits),), count

    def _single(self, types: Sequence[str], thing: Thing, limits: Limits) -> str:
        """One type of several: the one that is there, else a question."""
        here = {o.type for o in self._known(types, limits)}
        if len(here) == 1:
            return here.pop()
        choice = one_of([called(t) for t in types])
        raise Unclear(f"which kind is meant by '{thing.text}': {choice}?", thing.text, question=True)

    def _known(self, types: Sequence[str], limits: Limits) -> list[ObjectState]:
        rooms = limits.rooms
        return [o for o in self._world.objects if o.type in types and (not rooms or o.room in rooms)]

    def _everything(self, predicate: str, limits: Limits) -> tuple[str, ...]:
        """To switch everything is about what is there and what homes have, not about every candle there might be."""
        if predicate not in ("on", "off"):
            return modelled_types()
        known = {o.type for o in self._known(modelled_types(), limits)}
        return tuple(t for t in modelled_types() if t in known or t in tables()["switched"]["types"])

    def _pronoun(self, thing: Thing, predicate: str, limits: Limits) -> tuple[Selector, ...]:
        if limits != Limits():
            raise Unclear(f"I do not understand a place after '{thing.text}'", thing.text)
        fitting = tuple(
            s
            for s in dict.fromkeys((*self.last.subjects, *self.last.places))
            if s.type is not None and self._affords(s.type, predicate)
        )
        if thing.head == "them":
            many = tuple(s for s in self.last.subjects if s in fitting)
            if many:
                return many
        if len(fitting) == 1:
            return fitting
        if not fitting:
            raise Unclear(f"what does '{thing.text}' stand for?", thing.text, question=True)
        choice = one_of([called(s.type or "") for s in fitting])
        raise Unclear(f"does '{thing.text}' stand for the {choice}?", thing.text, question=True)

    def _affords(self, type_name: str, predicate: str) -> bool:
        if predicate in ("found", "visited", "touched", "seen_from_above"):
            return type_name in self._present or type_name in modelled_types()
        return type_row(type_name).can(FLAG[predicate][0])

    def check(self, type_name: str, predicate: str, part: str) -> None:
        """Refuse what cannot be done with things of a type."""
        if not self._affords(type_name, predicate):
            raise Unclear(f"{named(type_name)} cannot be {FLAG[predicate][1]}", part, final=True)

    # Places

    def limits(self, places: Iterable[Place]) -> Limits:
        """Places that tell which thing is meant."""
        rooms: list[str] = []
        insides: list[str] = []
        for place in places:
            if place.preposition in ("TO", "INTO"):
                raise Unclear(f"I do not understand '{place.text}' at this place", place.text)
            if isinstance(place.what, Rooms):
                rooms.extend(self.rooms(place.what))
            elif isinstance(place.what, Thing):
                holders = self.subjects(Group(place.what.text, place.what), "holder")
                insides.extend(dict.fromkeys(h.type for h in holders if h.type))
                rooms.extend(dict.fromkeys(h.room for h in holders if h.room))
                if any(h.id for h in holders):
                    raise Unclear(f"say the kind and the room instead of '{place.what.text}'", place.text)
            elif place.what == "there":
                rooms.append(self.there(place))
        return Limits(tuple(dict.fromkeys(rooms)), tuple(dict.fromkeys(insides)))

    def there(self, place: Place) -> str:
        if self.last.room is None:
            raise Unclear("which room is meant by 'there'?", place.text, question=True)
        return self.last.room

    def narrow(self, selector: Selector, places: Sequence[Place]) -> Selector:
        """A selector of one thing, restricted further."""
        limits = self.limits(places)
        if len(limits.rooms) > 1 or len(limits.insides) > 1:
            text = " ".join(p.text for p in places)
            raise Unclear(f"only one place can be meant by '{text}'", text, question=True)
        room = limits.rooms[0] if limits.rooms else selector.room
        inside = limits.insides[0] if limits.insides else selector.inside
        return selector.model_copy(update={"room": room, "inside": inside})


def _count(thing: Thing) -> int | None:
    """How many are meant; None is every one."""
    if thing.quant in ("count", "both"):
        return thing.count
    return None if thing.plural or thing.quant == "all" else 1


def _check_one_place(group: Group, predicate: str, count: int | None, limits: Limits) -> None:
    """ "Two mugs from the kitchen and the bathroom" are not two from each, and what is found in one is not looked for
    in the other."""
    several = len(limits.rooms) > 1 or len(limits.insides) > 1
    if several and count is not None and (count > 1 or predicate == "found"):
        raise Unclear(f"in which of the places? Say it for each: '{group.text}'", group.text, question=True)


def _check_quant(thing: Thing, predicate: str) -> None:
    """ "No" asks for the opposite, which only a clause about how things should be can turn into a goal."""
    if thing.quant == "none":
        raise Unclear(f"say what should not be: 'make sure that {thing.text} is ...'", thing.text)
    if thing.quant == "any" and not thing.plural and predicate in IMPLIED:
        text = thing.text
        raise Unclear(f"is every one meant by '{text}', or one of them?", text, question=True)


def _check_states(thing: Thing, predicate: str) -> None:
    for state in thing.states:
        if IMPLIED.get(predicate) != state:
            raise Unclear(f"I cannot choose things by being {state}: '{thing.text}'", thing.text)
        if thing.quant in ("a", "count", "both"):
            raise Unclear(f"I cannot tell which are {state}: say 'all' instead of '{thing.text}'", thing.text)


def share(members: Sequence[Group]) -> list[Group]:
    """A list's shared words given to each member: the quantifier of the first, the places after the last.

    "The apples and mugs in the kitchen" share a determiner and so the place. With a determiner of its own the last
    member may keep the place for itself, which is asked; a place with "from" is always shared.
    """
    first, last = members[0], members[-1]
    out = []
    for member in members:
        thing = member.thing
        if member is not first and thing.quant == "bare" and thing.head == "noun" and first.thing.quant != "bare":
            if first.thing.quant in ("count", "both"):
                raise Unclear(f"how many are meant by '{thing.text}'?", thing.text, question=True)
            thing = replace(thing, quant=first.thing.quant)
        out.append(replace(member, thing=thing))
    alone = len(members) > 1 and bool(last.places) and not any(m.places for m in members[:-1])
    if not alone:
        return out
    shared = all(p.preposition == "FROM" for p in last.places) or all(m.thing.quant == "bare" for m in members[1:])
    if not shared:
        others = " and ".join(f"'{m.thing.text}'" for m in members[:-1])
        text = " ".join(p.text for p in last.places)
        raise Unclear(f"does '{text}' also hold for {others}? Say it after each of them", text, question=True)
    return [replace(member, places=last.places) for member in out]


def one_of(names: Sequence[str]) -> str:
    """ "a, b or c"."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"
