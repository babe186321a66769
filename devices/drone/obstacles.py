"""What of the hub's world stands so high that a drone must go around it."""

from collections.abc import Iterable

from devices.drone.airspace import LEAST_HEIGHT_M, Obstacle
from wire.catalogue import catalogue
from wire.messages.world import ObjectState, WorldDelta, WorldState

BELIEVED = 0.4
"""Less sure than this, nothing is gone around for it."""


class Obstacles:
    """`by_id` is kept up to date in place."""

    def __init__(self) -> None:
        self.by_id: dict[str, Obstacle] = {}

    def take(self, world: WorldState | WorldDelta) -> None:
        if isinstance(world, WorldState):
            self.by_id.clear()
        else:
            self._forget(world.removed)
        for thing in world.objects:
            obstacle = obstacle_of(thing)
            if obstacle is not None:
                self.by_id[thing.id] = obstacle
            else:
                self._forget((thing.id,))

    def _forget(self, ids: Iterable[str]) -> None:
        for id in ids:
            self.by_id.pop(id, None)


def obstacle_of(thing: ObjectState) -> Obstacle | None:
    """As wide and high as things of its type commonly are; None for what is low, carried, or part of the building."""
    row = catalogue().get(thing.type)
    if row is None or row.kind not in ("static", "moveable") or thing.confidence < BELIEVED:
        return None
    x, y, z = thing.position_enu_m
    top_m = z + row.size_m[2] / 2.0
    if top_m < LEAST_HEIGHT_M:
        return None
    return Obstacle((x, y), max(row.size_m[0], row.size_m[1]) / 2.0, top_m)
