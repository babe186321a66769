"""How probable it is that a type of thing is in a room or in a closed receptacle, before anybody has looked there.

From the catalogue's room weights, from the furniture known to stand there (what it commonly holds), and from what has
been seen: a look that would have shown the thing makes its being there less probable, never impossible.
"""

from collections.abc import Sequence

from planners.tasks.belief import Belief
from wire.catalogue import type_row
from wire.messages.world import AreaState, ObjectState

CAMERA_RECALL = 0.6
"""A fixed camera notices a thing in the part of the room that it watches with about this probability."""
ROBOT_RECALL = 0.9
SEARCHED_RECALL = 0.95
ANYWHERE = 0.15
"""Weight of a room where a thing is not usual."""
UNKNOWN_KIND = 0.5
SOME_CHANCE = 0.02


def room_prior(type_name: str, area: AreaState, furniture: Sequence[ObjectState]) -> float:
    """Unnormalised probability that a thing of the type is in the room."""
    row = type_row(type_name)
    weights: dict[str, float] = {str(kind): weight for kind, weight in row.room_weights.items()}
    prior = weights.get(area.kind, 0.0) if weights else UNKNOWN_KIND
    prior += sum(type_row(o.type).holds.get(type_name, 0.0) for o in furniture)
    return (prior + ANYWHERE) * _unseen(area)


def _unseen(area: AreaState) -> float:
    if area.searched:
        return 1.0 - SEARCHED_RECALL
    robots = max(area.seen_fraction - area.camera_fraction, 0.0)
    return (1.0 - CAMERA_RECALL * area.camera_fraction) * (1.0 - ROBOT_RECALL * robots)


def normalised(type_name: str, rooms: Sequence[AreaState], belief: Belief) -> dict[str, float]:
    """Probability of each room, given that the thing is in one of them."""
    furniture: dict[str, list[ObjectState]] = {}
    for obj in belief.world.objects:
        if obj.room is not None:
            furniture.setdefault(obj.room, []).append(obj)
    weights = {area.id: room_prior(type_name, area, furniture.get(area.id, ())) for area in rooms}
    total = sum(weights.values())
    return {id: weight / total for id, weight in weights.items()}


def inside_prior(type_name: str, holder: ObjectState) -> float:
    """Probability that a closed receptacle holds a thing of the type."""
    row = type_row(holder.type)
    known = row.holds.get(type_name, 0.0)
    usual = holder.type in type_row(type_name).allowed_in
    return max(known, SOME_CHANCE if usual else 0.0)
