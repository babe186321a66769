"""Restraints of the instruction: which actions on which things, and which rooms, are forbidden."""

from collections.abc import Sequence

from wire.goals import select
from wire.messages.goal import Goal
from wire.messages.plan import Action
from wire.messages.world import ObjectState, WorldState

BRINGS_ABOUT: dict[Action, str] = {
    "open": "open",
    "close": "closed",
    "toggle_on": "on",
    "toggle_off": "off",
    "slice": "sliced",
    "clean": "clean",
}
"""Action -> the predicate that it makes true of its object."""
HANDLING = frozenset({"pickup", "put", *BRINGS_ABOUT})


class Bans:
    """The forbidden goals, looked up in one world state."""

    def __init__(self, goals: Sequence[Goal], world: WorldState) -> None:
        self._objects: dict[str, list[tuple[Goal, frozenset[str]]]] = {}
        """Thing -> the goals that restrain it, each with the places it is about."""
        self.rooms: set[str] = set()
        for goal in goals:
            if not goal.forbidden:
                continue
            if goal.predicate == "visited" and goal.subject.room is not None and goal.subject.type is None:
                self.rooms.add(goal.subject.room)
                continue
            places = frozenset(o.id for o in select(goal.object, world)) if goal.object is not None else frozenset()
            for obj in select(goal.subject, world):
                self._objects.setdefault(obj.id, []).append((goal, places))

    def forbids(self, action: Action, obj: ObjectState) -> bool:
        """Whether an action on a thing would break a restraint."""
        if obj.room in self.rooms:
            return True
        return any(
            goal.predicate == BRINGS_ABOUT.get(action)
            or (goal.predicate == "touched" and action in HANDLING and action != "put")
            or (goal.predicate == "in" and goal.object is None and action == "pickup")
            for goal, _ in self._objects.get(obj.id, ())
        )

    def forbids_move(self, item: ObjectState, holder: ObjectState) -> bool:
        """Whether something may not be put there."""
        if holder.room in self.rooms:
            return True
        return any(
            (goal.predicate == "in" and holder.id in places)
            or (goal.predicate == "at" and goal.object is not None and goal.object.room == holder.room)
            for goal, places in self._objects.get(item.id, ())
        )
