"""Goals made definite: which very thing is meant, once it is known.

"The apple on the table" is another apple after somebody moved it, so a goal that says where its things *start*, or
where those are that it leaves alone, is bound to ids when they are found. The same selector in several goals ("wash the
mug and bring it ...") is one thing.
"""

from collections.abc import Sequence

from planners.tasks.belief import Belief
from wire.messages.goal import Goal, Selector
from wire.messages.world import ObjectState

MOVES = ("in", "at")
OPPOSITE = {"on": "off", "off": "on", "open": "closed", "closed": "open"}


def settle(goals: Sequence[Goal], belief: Belief) -> tuple[Goal, ...]:
    """Goals bound as far as the world is known; ids of things that are gone are let go."""
    current = [_positive(_unbound(goal, belief)) for goal in goals]
    for selector in dict.fromkeys(g.subject for g in current if _is_loose(g.subject)):
        users = [i for i, g in enumerate(current) if g.subject == selector and not g.forbidden]
        moved = [i for i in users if current[i].predicate in MOVES]
        starts = any(s.room is not None or s.inside is not None for s in (selector, *selector.exclude))
        if moved and starts and selector.count is None:
            current += _all_bound(current, moved, belief)
        elif (moved and starts) or (len(users) > 1 and len(moved) <= 1):
            _bind(current, users, selector, belief)
    return tuple(current)


def _is_loose(selector: Selector) -> bool:
    return selector.type is not None and selector.id is None


def _positive(goal: Goal) -> Goal:
    """ "not open" is "closed"."""
    if goal.negated and goal.predicate in OPPOSITE and not goal.forbidden:
        return goal.model_copy(update={"predicate": OPPOSITE[goal.predicate], "negated": False})
    return goal


def _unbound(goal: Goal, belief: Belief) -> Goal:
    """A goal about a thing that turned out not to be there is about any thing of the type again."""
    subject = goal.subject
    if subject.id is None or subject.type is None or subject.id in belief.objects or goal.forbidden:
        return goal
    if subject.id in goal.text:
        return goal
    return goal.model_copy(update={"subject": subject.model_copy(update={"id": None})})


def _bind(goals: list[Goal], users: list[int], selector: Selector, belief: Belief) -> None:
    count = selector.count or 1
    things = sorted(belief.matching(selector), key=lambda o: _fitness(goals, users, o, belief))
    if len(things) < count or any(goals[i].after and count > 1 for i in users):
        return
    for i in users:
        bound = [goals[i].model_copy(update={"subject": _only(thing)}) for thing in things[:count]]
        goals[i] = bound[0]
        goals.extend(bound[1:])


def _fitness(goals: list[Goal], users: list[int], obj: ObjectState, belief: Belief) -> tuple[float, float, str]:
    """The thing of which most already holds, then the nearest."""
    open_goals = sum(not belief.satisfies(goals[i], obj) for i in users)
    failed = belief.failures.count("pickup", obj.id)
    return (open_goals + failed, belief.nearest_m(belief.point_m(obj)) + belief.doubt_m(obj), obj.id)


def _all_bound(goals: list[Goal], moved: list[int], belief: Belief) -> list[Goal]:
    """One more goal for each known thing of "everything on the table"; the general goal stays for what is unknown."""
    found = []
    for i in moved:
        for thing in belief.matching(goals[i].subject):
            bound = goals[i].model_copy(update={"subject": _only(thing)})
            if bound not in goals and belief.held_by(thing) is None:
                found.append(bound)
    return found


def _only(obj: ObjectState) -> Selector:
    return Selector(type=obj.type, id=obj.id)
