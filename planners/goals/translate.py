"""A model's reply as goals of the wire: names become types, ids and rooms, steps become an order."""

from collections.abc import Sequence

from planners.goals.offered import EVERYTHING, Offered
from planners.goals.reply import Wish
from planners.scripted.resolve import FLAG
from planners.scripted.texts import TEXT_LIMIT
from planners.scripted.vocabulary import tables
from wire.catalogue import modelled_types, type_row
from wire.messages.goal import Goal, Predicate, Selector
from wire.messages.world import WorldState

MOVES = ("in", "at")
OF_ROOMS = ("visited", "seen_from_above", "surveyed")


class Untranslatable(Exception):
    """A wish that no goal says; the text is a sentence for the model."""


def goals_of(goals: Sequence[Wish], keep: Sequence[Wish], offered: Offered, world: WorldState) -> tuple[Goal, ...]:
    """The goals in the order of the reply, restraints last. Raises Untranslatable."""
    made: list[Goal] = []
    steps: list[int | None] = []
    for wish in goals:
        new = _goals(wish, offered, world, forbidden=False)
        made += new
        steps += [wish.step] * len(new)
    ordered = [goal.model_copy(update={"after": _earlier(steps, i)}) for i, goal in enumerate(made)]
    return (*ordered, *(goal for wish in keep for goal in _goals(wish, offered, world, forbidden=True)))


def _earlier(steps: Sequence[int | None], index: int) -> tuple[int, ...]:
    """The goals of the last step before a goal's own."""
    own = steps[index]
    before = [step for step in steps if step is not None and own is not None and step < own]
    return tuple(i for i, step in enumerate(steps) if before and step == max(before))


def _goals(wish: Wish, offered: Offered, world: WorldState, *, forbidden: bool) -> list[Goal]:
    subjects = _subjects(wish, offered, world, forbidden)
    target = _target(wish, offered, forbidden)
    predicate = wish.p
    if predicate in MOVES and target is not None:
        predicate = "at" if target.type is None else "in"
    return [
        Goal(predicate=_predicate(predicate), subject=s, object=target, forbidden=forbidden, text=wish.of[:TEXT_LIMIT])
        for s in subjects
    ]


def _predicate(word: str) -> Predicate:
    return Goal.model_validate({"predicate": word, "subject": {}}).predicate


def _subjects(wish: Wish, offered: Offered, world: WorldState, forbidden: bool) -> list[Selector]:
    if wish.a in offered.rooms:
        if wish.p not in OF_ROOMS:
            raise Untranslatable(f"'{wish.a}' is a room: a of {wish.p} must be a type or a thing")
        return [Selector(room=wish.a)]
    if wish.p == "surveyed":
        raise Untranslatable(f"only rooms are surveyed: a cannot be {wish.a}")
    thing = offered.things.get(wish.a)
    if thing is not None:
        return [Selector(type=thing.type, id=thing.id)]
    room = wish.a_in if wish.a_in in offered.rooms else None
    inside = offered.type_of(wish.a_in) if wish.a_in is not None and room is None else None
    count = None if wish.all or forbidden else wish.n or 1
    types = _everything(wish.p, world) if wish.a == EVERYTHING else (wish.a,)
    if wish.a == EVERYTHING and wish.n is None:
        count = None
    out = [_left_out(name, offered) for name in wish.out]
    return [
        Selector(type=name, room=room, inside=inside, count=count, exclude=_excluded(name, out))
        for name in types
        if not any(o.type == name and o.id is None and o.room is None and o.inside is None for o in out)
    ]


def _left_out(name: str, offered: Offered) -> Selector:
    if name in offered.rooms:
        return Selector(room=name, count=None)
    thing = offered.things.get(name)
    return Selector(type=thing.type, id=thing.id) if thing is not None else Selector(type=name, count=None)


def _excluded(type_name: str, out: Sequence[Selector]) -> tuple[Selector, ...]:
    """Exceptions as they bear on one type: a room, one thing, or a receptacle that some of them are in."""
    found = []
    for selector in out:
        if selector.room is not None:
            found.append(selector.model_copy(update={"type": type_name}))
        elif selector.id is not None:
            found.append(selector)
        elif selector.type is not None and type_row(selector.type).can("receptacle"):
            found.append(Selector(type=type_name, inside=selector.type, count=None))
    return tuple(found)


def _everything(predicate: str, world: WorldState) -> tuple[str, ...]:
    """As the grammar has it: what can be recognised and affords it; what is switched is there, or in every home."""
    flag = FLAG.get("in" if predicate in MOVES else predicate)
    types = tuple(t for t in modelled_types() if flag is None or type_row(t).can(flag[0]))
    if predicate not in ("on", "off"):
        return types
    present = {obj.type for obj in world.objects}
    return tuple(t for t in types if t in present or t in tables()["switched"]["types"])


def _target(wish: Wish, offered: Offered, forbidden: bool) -> Selector | None:
    if wish.p not in MOVES:
        return None
    if wish.b is None:
        if forbidden:
            return None
        raise Untranslatable(f"{wish.p} needs a b: where {wish.a} should be at the end")
    if wish.b in offered.rooms:
        return Selector(room=wish.b)
    thing = offered.things.get(wish.b)
    if thing is not None:
        return Selector(type=thing.type, id=thing.id)
    return Selector(type=wish.b, room=wish.b_in)
