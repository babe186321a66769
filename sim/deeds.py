"""What robots have done to things, and whether a goal forbade it."""

from collections.abc import Iterable, Set
from dataclasses import dataclass

from sim.truth import true_id
from wire.goals import select
from wire.messages.driver import GripperAction
from wire.messages.goal import Goal
from wire.messages.world import WorldState

_BREAKS: dict[str, tuple[GripperAction, ...]] = {
    "open": ("open",),
    "closed": ("close",),
    "on": ("toggle_on",),
    "off": ("toggle_off",),
    "sliced": ("slice",),
    "clean": ("clean",),
}


@dataclass(frozen=True)
class Deed:
    """An action that succeeded, on which thing, with what in the hand."""

    action: GripperAction
    target: int
    item: int | None


def breach(goal: Goal, deeds: Iterable[Deed], visited: Set[str], world: WorldState) -> str:
    """Which deed a forbidden goal has been broken by, in words; empty when none."""
    if goal.predicate == "visited":
        room = goal.subject.room
        return f"a robot has been in {room}" if room in visited else ""
    subjects = {thing.id: thing.type for thing in select(goal.subject, world)}
    places = None if goal.object is None else {thing.id for thing in select(goal.object, world)}
    for deed in deeds:
        touched = _touched(goal, deed, places)
        if touched in subjects:
            return f"{deed.action} was done with the {subjects[touched]}"
    return ""


def _touched(goal: Goal, deed: Deed, places: set[str] | None) -> str:
    """Id of the thing to which the deed does what the goal forbids; empty when it is no such deed."""
    target, item = true_id(deed.target), "" if deed.item is None else true_id(deed.item)
    if goal.predicate == "touched":
        return target
    if goal.predicate in ("in", "at"):
        if places is None:
            return target if deed.action == "pickup" else ""
        return item if deed.action == "put" and target in places else ""
    return target if deed.action in _BREAKS.get(goal.predicate, ()) else ""
