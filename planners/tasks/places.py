"""Where to put something: the receptacle that suits a goal, is near, is not crowded and has not failed before."""

from collections.abc import Iterable

from planners.tasks.belief import Belief
from wire.catalogue import catalogue, type_row
from wire.messages.goal import Goal, Selector
from wire.messages.world import ObjectState

CROWD_M = 1.0
"""Every thing already there is worth so much walking."""
CLOSED_M = 6.0
UNUSUAL_M = 15.0
"""A receptacle that usually does not hold such things."""
FAILED_M = 30.0
SMALLEST_AREA_M2 = 0.05


def suitable(item: ObjectState, belief: Belief, goal: Goal) -> list[ObjectState]:
    """Receptacles that would make the goal true, the best first."""
    assert goal.object is not None
    wanted = goal.object
    if wanted.type is None and wanted.id is None:
        found: Iterable[ObjectState] = (
            o for o in belief.world.objects if o.room == wanted.room and _furniture(o) and fits(item, o)
        )
    else:
        found = belief.matching(wanted)
    return rank(item, found, belief)


def rank(item: ObjectState, holders: Iterable[ObjectState], belief: Belief) -> list[ObjectState]:
    """The usable ones of some receptacles, the best first."""
    good = [h for h in holders if not unusable(item, h, belief)]
    return sorted(good, key=lambda h: (_cost_m(item, h, belief), h.id))


def unusable(item: ObjectState, holder: ObjectState, belief: Belief) -> str:
    """Why something cannot be put there; empty when it can."""
    if holder.id == item.id or any(h.id == item.id for h in belief.around(holder)):
        return f"{item.id} cannot be put into itself"
    if not type_row(holder.type).can("receptacle"):
        return f"nothing can be put in or on {holder.id}"
    if belief.held_by(holder) is not None:
        return f"{holder.id} is in a robot's hand"
    if belief.bans.forbids("put", holder) or belief.bans.forbids_move(item, holder):
        return f"it is forbidden to put {item.id} there ({holder.id})"
    if belief.shut(holder) and belief.bans.forbids("open", holder):
        return f"{holder.id} is closed and it is forbidden to open {holder.id}"
    if belief.shut(holder) and belief.failures.spent("open", holder.id):
        return belief.failures.last(holder.id)
    return belief.failures.last(holder.id) if belief.failures.spent("put", holder.id) else ""


def _cost_m(item: ObjectState, holder: ObjectState, belief: Belief) -> float:
    row = type_row(holder.type)
    cost = belief.travel.metres(belief.point_m(item), belief.point_m(holder))
    cost += CROWD_M * belief.crowd(holder.id) / max(row.size_m[0] * row.size_m[1], SMALLEST_AREA_M2) * 0.3
    cost += CLOSED_M * belief.shut(holder)
    cost += UNUSUAL_M * (holder.type not in type_row(item.type).allowed_in)
    return cost + FAILED_M * belief.failures.count("put", holder.id)


def _furniture(obj: ObjectState) -> bool:
    row = type_row(obj.type)
    return row.kind != "pickup" and row.receptacle_mode is not None


def fits(item: ObjectState, holder: ObjectState) -> bool:
    """The item is smaller than what should hold it, both ways round in the floor plane."""
    small = sorted(type_row(item.type).size_p10_m[:2])
    large = sorted(type_row(holder.type).size_m[:2])
    return all(a <= b for a, b in zip(small, large, strict=True))


def holder_types(item_type: str, wanted: Selector | None) -> tuple[str, ...]:
    """Types to look for when no receptacle is known."""
    if wanted is not None and wanted.type is not None:
        return (wanted.type,)
    rows = (catalogue().get(name) for name in type_row(item_type).allowed_in)
    return tuple(r.name for r in rows if r is not None and r.modelled and r.kind != "pickup" and not r.must_open)
