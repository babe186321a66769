"""Does a goal hold? One reading of the predicates, on what the hub believes and on what is true."""

from wire.messages.goal import Goal, Selector
from wire.messages.world import ObjectState, WorldState

_PROP = {
    "open": ("isOpen", True),
    "closed": ("isOpen", False),
    "on": ("isToggled", True),
    "off": ("isToggled", False),
    "clean": ("isDirty", False),
    "sliced": ("isSliced", True),
}
ROOM_GOALS = {"visited": "searched", "seen_from_above": "seen_from_above", "surveyed": "surveyed"}
"""Predicate -> the field of a room that says whether it holds of it."""


def of_room(subject: Selector) -> bool:
    """Whether a goal is about a room itself and not about things in it."""
    return subject.room is not None and subject.type is None and subject.id is None


def select(selector: Selector, world: WorldState) -> list[ObjectState]:
    """Objects that a selector means, whatever its count."""
    by_id = {o.id: o for o in world.objects}
    return [o for o in world.objects if _matches(selector, o, by_id)]


def _matches(selector: Selector, obj: ObjectState, by_id: dict[str, ObjectState]) -> bool:
    if selector.id is not None and obj.id != selector.id:
        return False
    if selector.type is not None and obj.type != selector.type:
        return False
    if selector.room is not None and obj.room != selector.room:
        return False
    if selector.inside is not None:
        parent = by_id.get(obj.receptacle or "")
        if parent is None or parent.type != selector.inside:
            return False
    return not any(_matches(other, obj, by_id) for other in selector.exclude)


def holds(goal: Goal, world: WorldState) -> bool:
    """Whether the goal is true of `world`.

    With a count of None every selected object must satisfy it (and none selected satisfies it trivially); with a
    count of n at least n must. A selector that names a room as the place things *start* in is settled by id when a
    plan is made: here the room is read as it is now. A forbidden goal restrains the steps and asks nothing of the end.
    """
    if goal.forbidden:
        return True
    if goal.predicate in ROOM_GOALS and of_room(goal.subject):
        satisfied = any(a.id == goal.subject.room and getattr(a, ROOM_GOALS[goal.predicate]) for a in world.areas)
    elif goal.predicate == "visited":
        satisfied = _looked_at(goal.subject, world)
    else:
        satisfied = _objects_hold(goal, world)
    return satisfied != goal.negated


def _objects_hold(goal: Goal, world: WorldState) -> bool:
    chosen = select(goal.subject, world)
    good = sum(1 for obj in chosen if object_satisfies(goal, obj, world))
    return good == len(chosen) if goal.subject.count is None else good >= goal.subject.count


def object_satisfies(goal: Goal, obj: ObjectState, world: WorldState) -> bool:
    """Whether one object has what the goal's predicate asks (its negation left aside)."""
    if goal.predicate in _PROP:
        name, wanted = _PROP[goal.predicate]
        prop = obj.props.get(name)
        return prop is not None and prop.value == wanted
    if goal.predicate == "found":
        return obj.verified
    if goal.predicate == "seen_from_above":
        return obj.seen_from_above
    if goal.predicate == "at" and goal.object is not None and goal.object.room is not None and goal.object.type is None:
        return obj.room == goal.object.room and not _carried(obj, world)
    if goal.predicate in ("in", "at") and goal.object is not None:
        return any(obj.receptacle == place.id for place in select(goal.object, world))
    return False


def _looked_at(subject: Selector, world: WorldState) -> bool:
    chosen = select(subject, world)
    seen = sum(1 for obj in chosen if obj.verified)
    return seen == len(chosen) if subject.count is None else seen >= subject.count


def _carried(obj: ObjectState, world: WorldState) -> bool:
    return any(robot.id == obj.receptacle for robot in world.robots)
