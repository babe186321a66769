"""Goals that cannot be true together, and means that a later clause makes superfluous."""

from collections.abc import Sequence

from planners.scripted.syntax import Unclear
from wire.messages.goal import Goal, Selector
from wire.names import called

OPPOSED = {("open", "closed"), ("closed", "open"), ("on", "off"), ("off", "on")}


def agree(goals: Sequence[Goal]) -> tuple[Goal, ...]:
    """The same goals without repetition and superseded means. Raises Unclear on a contradiction."""
    kept = _without_means(goals)
    for index, goal in enumerate(kept):
        for other in kept[index + 1 :]:
            _check_pair(goal, other)
        _check_whole(goal, kept)
    return tuple(kept)


def _check_whole(goal: Goal, goals: Sequence[Goal]) -> None:
    """What has been sliced cannot be carried in one piece: it must be moved first."""
    if goal.predicate not in ("in", "at"):
        return
    for earlier in (goals[i] for i in goal.after):
        if earlier.predicate == "sliced" and _same(earlier.subject, goal.subject):
            what = called(goal.subject.type or "thing")
            reason = f"a sliced {what} cannot be carried: should it be put there first and sliced then?"
            raise Unclear(reason, goal.text, question=True)


def _check_pair(goal: Goal, other: Goal) -> None:
    if goal.forbidden != other.forbidden:
        wish, bar = (other, goal) if goal.forbidden else (goal, other)
        if _overlap(wish.subject, bar.subject) and _barred(wish, bar):
            raise Unclear(f"'{wish.text}' and '{bar.text}' contradict each other", bar.text, final=True)
    elif not goal.forbidden and _same(goal.subject, other.subject):
        what = called(goal.subject.type or "thing")
        if (goal.predicate, other.predicate) in OPPOSED:
            reason = f"the {what} cannot be both {goal.predicate} and {other.predicate} at the end"
            raise Unclear(
                f"{reason}, which is all that a task is about: say which it should be", other.text, final=True
            )
        moved = goal.predicate in ("in", "at") and other.predicate in ("in", "at")
        pinned = goal.subject.id is not None or goal.subject.count is None
        if moved and pinned and _apart(goal, other):
            raise Unclear(f"the {what} cannot end in two places", other.text, final=True)


def _apart(goal: Goal, other: Goal) -> bool:
    """Two destinations that are not one and the same."""
    a, b = goal.object, other.object
    if a is None or b is None or a == b:
        return False
    return goal.predicate == other.predicate or (a.room is not None and b.room is not None and a.room != b.room)


def _barred(wish: Goal, bar: Goal) -> bool:
    if bar.predicate == "touched":
        return wish.predicate not in ("found", "visited", "seen_from_above", "surveyed")
    if bar.predicate == "in" and bar.object is None:
        return wish.predicate in ("in", "at")
    return wish.predicate == bar.predicate and wish.object == bar.object


def _same(a: Selector, b: Selector) -> bool:
    return (a.type, a.id, a.room, a.inside, a.exclude) == (b.type, b.id, b.room, b.inside, b.exclude)


def _overlap(wish: Selector, bar: Selector) -> bool:
    """Everything wished for is barred: then nothing could be done. Part of it is left to the plan."""
    return wish.type == bar.type and all(
        narrow is None or narrow == wide
        for narrow, wide in ((bar.room, wish.room), (bar.inside, wish.inside), (bar.id, wish.id))
    )


def _without_means(goals: Sequence[Goal]) -> list[Goal]:
    """Drop repetitions, and an `open` that a later `closed` undoes when something is done in between."""
    keep: list[int] = []
    for index, goal in enumerate(goals):
        later = goals[index + 1 :]
        closed_again = (
            goal.predicate == "open"
            and not goal.forbidden
            and any(g.predicate == "closed" and _same(g.subject, goal.subject) for g in later)
        )
        used = any(g.predicate in ("in", "at") for g in later)
        repeated = any(_equal(goal, goals[i]) for i in keep)
        if not repeated and not (closed_again and used):
            keep.append(index)
    place = {old: new for new, old in enumerate(keep)}
    return [
        goals[old].model_copy(update={"after": tuple(place[i] for i in goals[old].after if i in place)}) for old in keep
    ]


def _equal(a: Goal, b: Goal) -> bool:
    blank = {"text": "", "after": ()}
    return a.model_copy(update=blank) == b.model_copy(update=blank)
