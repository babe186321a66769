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
    inspected: set[tuple[str, str]] = field(default_factory=set)
    """(thing, predicate) that a robot has been sent to look at: then what is believed is trusted."""
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
