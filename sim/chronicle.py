"""What was true when: the evaluator's memory of the world's changes, and which goals came true out of order."""

from collections import deque
from collections.abc import Hashable, Sequence

from wire.goals import holds
from wire.messages.goal import Goal
from wire.messages.world import WorldState

MOST_CHANGES = 20_000
"""So many changed worlds are remembered; older ones are forgotten, and order is not judged in them."""
LASTING = ("found", "visited", "seen_from_above", "surveyed")
"""What stays true once a robot has looked, so that a second look leaves no mark of its own."""


class Chronicle:
    """Worlds in the order of time, one for each change that a goal can speak of."""

    def __init__(self) -> None:
        self._worlds: deque[WorldState] = deque(maxlen=MOST_CHANGES)
        self._last: Hashable = None

    def note(self, world: WorldState) -> None:
        """Remember a world unless it says the same of every goal as the one before it."""
        facts = _facts(world)
        if facts != self._last:
            self._last = facts
            self._worlds.append(world)

    def disorder(self, goals: Sequence[Goal], index: int, since_s: float) -> str:
        """Which goal this one should have come after and did not, in words; empty when the order was kept.

        Judged from `since_s` on. What was true then already was not brought about out of order, and what was undone
        may be made true again: the time at which it last came true counts. Half a second is the finest that is told
        apart.
        """
        goal = goals[index]
        if goal.forbidden or not goal.after:
            return ""
        before = [w for w in self._worlds if w.stamp_s <= since_s]
        worlds = [*before[-1:], *(w for w in self._worlds if w.stamp_s > since_s)]
        reached_s = _last_rise_s(goal, worlds)
        if reached_s is None:
            return ""
        for earlier in (goals[i] for i in goal.after):
            first_s = next((w.stamp_s for w in worlds if holds(earlier, w)), None)
            if first_s is None or reached_s < first_s:
                return f"it came true before '{earlier.text or earlier.predicate}', which should come first"
        return ""


def _last_rise_s(goal: Goal, worlds: Sequence[WorldState]) -> float | None:
    """When the goal last came true; None when it did not come true, or held from the start."""
    if goal.predicate in LASTING:
        return _last_presence_s(goal, worlds)
    truths = [holds(goal, world) for world in worlds]
    if not truths or truths[0] or not truths[-1]:
        return None
    rise = max(i for i in range(1, len(truths)) if truths[i] and not truths[i - 1])
    return worlds[rise].stamp_s


def _last_presence_s(goal: Goal, worlds: Sequence[WorldState]) -> float | None:
    """When a robot was last in the room to be visited; None for a look at things: only the first one is known."""
    if goal.subject.type is not None or goal.subject.id is not None or not worlds or holds(goal, worlds[0]):
        return None
    left_s = [
        later.stamp_s
        for world, later in zip(worlds, (*worlds[1:], worlds[-1]), strict=True)
        if any(robot.room == goal.subject.room for robot in world.robots)
    ]
    return left_s[-1] if left_s else None


def _facts(world: WorldState) -> Hashable:
    """What goals can speak of: places, properties and looks of things, and which rooms robots are and were in."""
    return (
        tuple(
            (
                o.id,
                o.receptacle,
                o.room,
                o.verified,
                o.seen_from_above,
                tuple((name, p.value) for name, p in o.props.items()),
            )
            for o in world.objects
        ),
        tuple((robot.id, robot.room) for robot in world.robots),
        tuple((area.searched, area.seen_from_above, area.surveyed) for area in world.areas),
    )
