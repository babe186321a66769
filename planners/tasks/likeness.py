"""What was looked for everywhere and found nowhere is there all the same, taken for something else: the likeliest of those.

An instruction that speaks of the sofa says that there is one. When every room has been gone through and nothing is
believed to be one, the thing that most looks took for one is it; the hand's own look will tell.
"""

from collections.abc import Iterator, Sequence

from wire.messages.goal import Goal, Selector
from wire.messages.world import ObjectState, WorldState


def taken_for(goals: Sequence[Goal], world: WorldState) -> dict[str, str]:
    """Object id -> the type to take it for."""
    wanted = list(_wanted(goals))
    asked = {selector.type for selector in wanted}
    chosen: dict[str, str] = {}
    for selector in wanted:
        assert selector.type is not None
        if not _searched(selector, world) or any(
            _suits(o, selector) and o.type == selector.type for o in world.objects
        ):
            continue
        alike = [o for o in world.objects if _suits(o, selector) and selector.type in o.maybe and o.type not in asked]
        free = [o for o in alike if o.id not in chosen]
        if free and selector.type not in chosen.values():
            chosen[max(free, key=lambda o: (o.maybe[selector.type or ""], o.id)).id] = selector.type
    return chosen


def as_taken(world: WorldState, taken: dict[str, str]) -> WorldState:
    """The world with these types."""
    if not taken:
        return world
    objects = tuple(o.model_copy(update={"type": taken.get(o.id, o.type)}) for o in world.objects)
    return world.model_copy(update={"objects": objects})


def _wanted(goals: Sequence[Goal]) -> Iterator[Selector]:
    for goal in goals:
        for selector in (goal.subject, goal.object):
            if selector is not None and selector.type is not None and selector.id is None and not goal.forbidden:
                yield selector


def _searched(selector: Selector, world: WorldState) -> bool:
    return all(area.searched for area in world.areas if selector.room in (None, area.id))


def _suits(obj: ObjectState, selector: Selector) -> bool:
    return selector.room in (None, obj.room)
