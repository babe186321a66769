"""Where things go: which places after a noun tell the thing, and which one is the destination."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from planners.scripted.exceptions import leave_out
from planners.scripted.resolve import Resolver, named, one_of, share
from planners.scripted.syntax import Act, Body, Group, Groups, Place, Rooms, Thing, Unclear
from wire.catalogue import type_row
from wire.messages.goal import Selector
from wire.names import called


@dataclass(frozen=True)
class Move:
    """Subjects, and the receptacle or room they go to; without one, the next clause must say it."""

    subjects: tuple[Selector, ...]
    to: Selector | None
    text: str
    restrained: tuple[Selector, ...] = ()
    """What is named as an exception although it was not in the list: it must not go there."""


@dataclass(frozen=True)
class _Split:
    """A member's places told apart: those of the thing, the destination, and those of the destination."""

    own: tuple[Place, ...]
    to: Place | None = None
    of_to: tuple[Place, ...] = ()


def read_transport(act: Act, resolver: Resolver, continued: bool) -> list[Move]:
    """The moves of a `put` or `take` clause. `continued`: the next clause says where "it" goes."""
    assert act.groups is not None
    loose = act.verb == "take"
    if act.away:
        if act.verb == "put" and act.word not in ("throw", "toss") and not act.word.startswith(DISCARDING):
            raise Unclear(f"where should '{act.groups.text}' go?", act.text, question=True)
        return [_bound_for(Selector(type="GarbageCan"), act.groups, resolver, act.text)]
    groups = _with_destination(act.groups, loose)
    moves: list[Move] = []
    waiting: list[Group] = []
    for member in groups.members:
        split = _split(member, loose, continued, resolver)
        waiting.append(replace(member, places=split.own))
        if split.to is not None:
            excepted = groups.excepted if member is groups.members[-1] else ()
            moves.append(_move(replace(groups, members=tuple(waiting), excepted=excepted), split, resolver, act.text))
            waiting = []
    if moves and (waiting or (groups.excepted and len(moves) > 1)):
        raise _ask_for_each(waiting, groups)
    if waiting:
        moves.append(_bound_for(None, replace(groups, members=tuple(waiting)), resolver, act.text))
    return moves


def _ask_for_each(waiting: Sequence[Group], groups: Groups) -> Unclear:
    if waiting:
        text = waiting[0].thing.text
        return Unclear(f"where should '{text}' go?", text, question=True)
    text = " and ".join(exception.text for exception in groups.excepted)
    return Unclear(
        f"for which of the places does 'except {text}' hold? Say each in a clause of its own", text, question=True
    )


MOST_NAMED = 5
ONTO = ("on ", "onto ", "upon ")
DISCARDING = ("throw", "discard", "dispose", "get rid")


def _with_destination(groups: Groups, loose: bool) -> Groups:
    """The destination after an exception ("all food except the apple in the fridge") given to the list itself."""
    last = groups.excepted[-1] if groups.excepted else None
    if not isinstance(last, Group):
        return groups
    member, places = groups.members[-1], last.places
    origin = next((p.text for p in places if p.preposition == "FROM" and not p.related), None)
    if origin is not None and last.thing.head != "one":
        asked = f"does '{origin}' hold for '{last.thing.text}' alone? Say it before 'except', or say 'that is in ...'"
        raise Unclear(asked, origin, question=True)
    bound = [i for i, place in enumerate(places) if place.preposition in ("TO", "INTO")]
    if not bound:
        free = _free(places)
        if loose or (last.thing.head == "one" and len(free) == 1) or not free:
            return groups
        if any(place.preposition in ("TO", "INTO") for place in member.places):
            return groups
        if _free(member.places):
            text = places[free[-1]].text
            asked = f"is '{text}' where '{last.thing.text}' is, or where the rest should go? Say 'that is' or 'into'"
            raise Unclear(asked, text, question=True)
        holders = [i for i in free if isinstance(places[i].what, Thing)]
        bound = [holders[-1] if holders else free[-1]]
    at = bound[0]
    members = (*groups.members[:-1], replace(member, places=member.places + places[at:]))
    excepted = (*groups.excepted[:-1], replace(last, places=places[:at]))
    return replace(groups, members=members, excepted=excepted)


def _free(places: Sequence[Place]) -> list[int]:
    """Which places may be a destination although they could tell where something is."""
    return [
        i
        for i, place in enumerate(places)
        if place.preposition in ("IN", "ON") and place.what != "anywhere" and not place.related
    ]


def _move(groups: Groups, split: _Split, resolver: Resolver, text: str) -> Move:
    assert split.to is not None
    move = _bound_for(None, groups, resolver, text)
    to = destination(split.to, split.of_to, resolver)
    subjects = move.subjects
    if any(member.thing.head == "everything" for member in groups.members):
        subjects = tuple(s for s in subjects if s.type != to.type)
    for subject in subjects:
        _check_fit(subject, to, text)
    return replace(move, subjects=subjects, to=to)


def _bound_for(to: Selector | None, groups: Groups, resolver: Resolver, text: str) -> Move:
    heads = share(groups.members)
    subjects = [s for member in heads for s in resolver.subjects(member, "in")]
    kept, restrained = leave_out(groups, heads, subjects, "in", resolver)
    return Move(kept, to, text, restrained)


def _split(member: Group, loose: bool, continued: bool, resolver: Resolver) -> _Split:
    """Tell the places of one member apart by their prepositions and by what can hold what."""
    places = member.places
    for index, place in enumerate(places):
        if place.preposition in ("TO", "INTO"):
            return _Split(places[:index], place, places[index + 1 :])
    if loose and continued:
        return _Split(places)
    free = _free(places)
    if not free:
        return _Split(places)
    if loose:
        last = places[free[-1]].text
        asked = f"is '{last}' where '{member.thing.text}' is, or where it should go? Say 'from' or 'to'"
        raise Unclear(asked, last, question=True)
    holders = [i for i in free if isinstance(places[i].what, Thing)]
    at = holders[-1] if holders else free[-1]
    before = [i for i in holders if i < at]
    if before and _could_hold(places[at], places[before[-1]], resolver):
        first, second = places[before[-1]].text, places[at].text
        asked = f"is '{first}' where '{member.thing.text}' is, or where it should go? Say 'from' or 'into'"
        raise Unclear(asked, f"{first} {second}", question=True)
    return _Split(places[:at], places[at], places[at + 1 :])


def _could_hold(outer: Place, inner: Place, resolver: Resolver) -> bool:
    """Whether the second place may tell which of the first is meant ("in the bowl on the table")."""
    if not isinstance(outer.what, Thing) or not isinstance(inner.what, Thing):
        return False
    return any(set(type_row(t).allowed_in) & set(outer.what.types) for t in inner.what.types)


def destination(place: Place, of_place: Sequence[Place], resolver: Resolver) -> Selector:
    """The receptacle or the room at which something should end."""
    if place.what == "there":
        return Selector(room=resolver.there(place))
    if isinstance(place.what, Rooms):
        rooms = resolver.rooms(place.what)
        if len(rooms) > 1 or of_place:
            text = " ".join((place.text, *(p.text for p in of_place)))
            raise Unclear(f"only one place can be the destination: '{text}'", text, question=True)
        return Selector(room=rooms[0])
    if not isinstance(place.what, Thing):
        raise Unclear(f"where exactly is '{place.text}'?", place.text, question=True)
    thing = place.what
    if thing.quant in ("all", "both", "count"):
        raise Unclear(f"things can go to one place only: '{thing.text}'", thing.text, question=True)
    found = resolver.subjects(Group(thing.text, replace(thing, plural=False)), "holder")
    if len(found) != 1:
        raise Unclear(f"which one is meant by '{thing.text}'?", thing.text, question=True)
    if place.text.lower().startswith(ONTO) and enclosed(found[0].type or ""):
        raise Unclear(f"things go into {named(found[0].type or '')}, not on top of it", place.text, final=True)
    return resolver.narrow(found[0].model_copy(update={"count": 1}), of_place)


def enclosed(type_name: str) -> bool:
    """Whether nothing is put on top of such a thing, only into it."""
    return type_row(type_name).receptacle_mode == "enclosed"


def placed(body: Body, resolver: Resolver) -> Move:
    """The move that makes "X is in Y" true."""
    *own, to = body.places
    of_to: tuple[Place, ...] = ()
    if own and isinstance(to.what, Rooms) and isinstance(own[-1].what, Thing):
        of_to, to = (to,), own.pop()
    if own:
        raise Unclear(f"I do not understand '{own[0].text}' at this place", own[0].text)
    return _move(body.groups, _Split((), to, of_to), resolver, body.text)


def _check_fit(subject: Selector, to: Selector, text: str) -> None:
    """Refuse what is plainly too large: the smallest usual item in the largest usual receptacle."""
    if subject.type is None or to.type is None:
        return
    if subject.type == to.type and subject.id == to.id:
        raise Unclear(f"{named(subject.type)} cannot be put in or on itself", text)
    item = sorted(type_row(subject.type).size_p10_m)[:2]
    room = sorted(type_row(to.type).size_p90_m[:2])
    if type_row(to.type).receptacle_mode != "on" and any(a > b for a, b in zip(item, room, strict=True)):
        raise Unclear(f"{named(subject.type)} does not fit in {named(to.type)}", text)


def ask_where(move: Move) -> Unclear:
    """What to say of a thing taken and put nowhere."""
    names = sorted({called(s.type or "") for s in move.subjects})
    what = f"the {one_of(names)}" if len(names) <= MOST_NAMED else "they"
    return Unclear(f"where should {what} go? '{move.text}' leaves it in a robot's hand", move.text, question=True)
