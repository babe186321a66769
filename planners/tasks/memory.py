"""What a planner remembers of a task between its plans: what it had opened, looked at and searched again."""

from collections import OrderedDict
from dataclasses import dataclass, field

from wire.messages.world import AreaState

TASKS_KEPT = 16


@dataclass
class Notes:
    """Of one task. All of it only avoids needless work: without it a fridge is looked into once more."""

    opened: set[str] = field(default_factory=set)
    """Closed things that the plans have opened, to be closed again."""
    peeked: set[str] = field(default_factory=set)
    """Closed things that plans have opened to look what is inside."""
    sent_to_look: dict[tuple[str, str], tuple[float, int]] = field(default_factory=dict)
    """(thing, predicate) that plans have sent a robot to look at: mesh time of the first, and how many did."""
    changed: set[tuple[str, str]] = field(default_factory=set)
    """(thing, predicate) that plans have made so."""
    second_search: dict[str, int] = field(default_factory=dict)
    """Rooms sent to once more after everything else was in vain, and how often they had been searched before that."""

    def searched_again(self, area: AreaState) -> bool:
        """Whether the second search was done; one that was cancelled was not."""
        return area.id in self.second_search and area.searches > self.second_search[area.id]


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
