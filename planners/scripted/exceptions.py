"""What is left out of a list: as exclusions of its selectors, or as things that must be left as they are."""

from collections.abc import Sequence
from dataclasses import replace

from planners.scripted.resolve import Resolver, one_of
from planners.scripted.syntax import Group, Groups, LeftOut, Place, Thing, Unclear
from wire.messages.goal import Selector
from wire.names import called


def leave_out(
    groups: Groups, heads: Sequence[Group], subjects: Sequence[Selector], predicate: str, resolver: Resolver
) -> tuple[tuple[Selector, ...], tuple[Selector, ...]]:
    """Selectors without what is excepted, and what is named as an exception although it was not in the list.

    `subjects`: what the list's members (`heads`) stand for when `predicate` is to be made true of them.
    """
    kept, restrained = tuple(subjects), []
    for exception in groups.excepted:
        for out in _left_out(exception, heads, predicate, resolver):
            if all(s.type != out.type for s in subjects):
                if len(groups.excepted) > 1 or out.room is not None or out.inside is not None:
                    text = groups.text
                    raise Unclear(f"what should happen to the {called(out.type or '')}?", text, question=True)
                restrained.append(out)
            kept = tuple(less for s in kept if (less := _without(s, out)) is not None)
    if groups.excepted and not kept:
        raise Unclear("the exception leaves nothing to do", groups.text)
    return kept, tuple(restrained)


def _left_out(exception: LeftOut, heads: Sequence[Group], predicate: str, resolver: Resolver) -> tuple[Selector, ...]:
    if isinstance(exception, Place):
        limits = resolver.limits((exception,))
        return tuple(
            Selector(type=name, room=room, inside=inside, count=None)
            for name in dict.fromkeys(t for head in heads for t in head.thing.types) or (None,)
            for room in limits.rooms or (None,)
            for inside in limits.insides or (None,)
        )
    thing = exception.thing
    _check_definite(thing, exception)
    if thing.head != "one":
        return resolver.subjects(_all_of(exception), predicate)
    if len(heads) > 1 and not thing.plural:
        choice = one_of([called(t) for head in heads for t in head.thing.types])
        raise Unclear(f"which is meant by '{exception.text}': {choice}?", exception.text, question=True)
    alike = [s for head in heads for s in resolver.subjects(_all_of(exception), predicate, head.thing)]
    return tuple(dict.fromkeys(alike))


def _all_of(exception: Group) -> Group:
    """However an exception is said, all that it describes is left out."""
    if exception.thing.head in ("noun", "one"):
        return replace(exception, thing=replace(exception.thing, quant="all"))
    return exception


def _check_definite(thing: Thing, exception: Group) -> None:
    """ "Except one" and "except two mugs" do not tell which; nor does a state that may change."""
    pointed = exception.places and (thing.plural or thing.quant != "bare")
    if thing.quant in ("a", "any", "count") or (thing.head == "one" and not (pointed or thing.states)):
        text = exception.text
        raise Unclear(f"which should be left out? 'except {text}' leaves it open", text, question=True)
    if thing.states:
        raise Unclear(f"I cannot choose things by being {thing.states[0]}: '{exception.text}'", exception.text)


def _without(selector: Selector, out: Selector) -> Selector | None:
    """The selector less what is excepted; None where nothing is left of it."""
    if out.type is not None and selector.type != out.type:
        return selector
    if out.id is not None and selector.id == out.id:
        return None
    narrower = any(
        mine is not None and mine != theirs
        for mine, theirs in ((out.room, selector.room), (out.inside, selector.inside), (out.id, selector.id))
    )
    return selector.model_copy(update={"exclude": (*selector.exclude, out)}) if narrower else None
