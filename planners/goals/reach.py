"""Whether any robot that is there can bring a goal about: said before anything is planned, and in one sentence."""

from collections.abc import Sequence

from planners.scripted.syntax import Unclear
from planners.tasks.bans import BRINGS_ABOUT
from wire.messages.goal import Goal
from wire.messages.plan import FROM_ABOVE, PlanRequest

NEEDS: dict[str, tuple[str, ...]] = {
    **{predicate: (action,) for action, predicate in BRINGS_ABOUT.items()},
    **{predicate: (action,) for action, predicate in FROM_ABOVE.items()},
    "in": ("pickup", "put"),
    "at": ("pickup", "put"),
    "found": ("explore", "inspect"),
    "visited": ("explore", "inspect"),
}
"""Predicate -> the skills without which it cannot be made true."""
EITHER = frozenset({"found", "visited"})
"""One of the skills is enough."""


def check_reachable(goals: Sequence[Goal], request: PlanRequest) -> None:
    """Raises Unclear for the first goal that no announced skill serves. With no robots there yet nobody can tell."""
    announced = {skill for robot in request.world.robots for skill in robot.skills} | {c.name for c in request.skills}
    if not announced:
        return
    for goal in goals:
        if goal.forbidden:
            continue
        missing = [skill for skill in NEEDS.get(goal.predicate, ()) if skill not in announced]
        if missing and not (goal.predicate in EITHER and len(missing) == 1):
            raise Unclear(f"no robot here can do that: none announces {missing[0]}", goal.text, final=True)
