"""What a planner remembers of a task between its plans: what it had opened, looked at and searched again."""

from collections import OrderedDict
from dataclasses import dataclass, field

TASKS_KEPT = 16


@dataclass
class Notes:
    """Of one task. All of it only avoids needless work: without it a fridge is looked into once more."""

    opened: set[str] = field(default_factory=set)
    """Closed things that the plans have opened, to be closed again."""
    peeked: set[str] = field(default_factory=set)
    """Closed things opened to look what is inside."""
    sent_to_look: dict[tuple[str, str], tuple[float, int]] = field(default_factory=dict)
    """(thing, predicate) that plans have sent a robot to look at: mesh time of the first, and how many did."""
    changed: set[tuple[str, str]] = field(default_factory=set)
    """(thing, predicate) that plans have made so."""
    searched_twice: set[str] = field(default_factory=set)
    """Rooms searched once more after everything else was in vain."""


class Memory:
    """Notes of the last tasks."""

    def __init__(self) -> None:
        self._notes: OrderedDict[str, Notes] = OrderedDict()

    def of(self, task: str) -> Notes:
        notes = self._notes.setdefault(task, Notes())
        self._notes.move_to_end(task)
        while len(self._notes) > TASKS_KEPT:
            self._notes.popitem(last=False)
        return notes
