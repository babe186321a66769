"""What each goal of one clause is called: the clause, and in brackets what tells its goals apart."""

from collections.abc import Mapping, Sequence

from wire.messages.goal import Goal, Selector
from wire.names import called

TEXT_LIMIT = 300


def told_apart(goals: Sequence[Goal], rooms: Mapping[str, str]) -> tuple[Goal, ...]:
    """The same goals, no two of them with the same text where anything tells them apart. `rooms`: names by id."""
    return tuple(_labelled(goal, [g for g in goals if g.text == goal.text], rooms) for goal in goals)


def _labelled(goal: Goal, alike: Sequence[Goal], rooms: Mapping[str, str]) -> Goal:
    rows = [_marks(other, rooms) for other in alike]
    telling = (mine for mine, *column in zip(_marks(goal, rooms), *rows, strict=True) if len(set(column)) > 1)
    label = ", ".join(filter(None, telling))
    if not label:
        return goal
    return goal.model_copy(update={"text": f"{goal.text[: TEXT_LIMIT - len(label) - 3]} ({label})"})


def _marks(goal: Goal, rooms: Mapping[str, str]) -> tuple[str, ...]:
    return (*_names(goal.subject, rooms), *_names(goal.object, rooms))


def _names(selector: Selector | None, rooms: Mapping[str, str]) -> tuple[str, str, str, str]:
    if selector is None:
        return "", "", "", ""
    return (
        called(selector.type) if selector.type else "",
        selector.id or "",
        rooms.get(selector.room or "", selector.room or ""),
        called(selector.inside) if selector.inside else "",
    )
