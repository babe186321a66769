"""What of the hub's world stands so high that a drone must go around it."""

from collections.abc import Iterable, Sequence
from math import sqrt

from devices.drone.airspace import LEAST_HEIGHT_M, Obstacle
from devices.drone.outlines import outline_of
from wire.catalogue import catalogue
from wire.messages.world import ObjectState, WorldDelta, WorldState
from wire.site import Wall

BELIEVED = 0.4
"""Less sure than this, nothing is gone around for it."""


class Obstacles:
    """`by_id` is kept up to date in place."""

    def __init__(self, walls: Sequence[Wall]) -> None:
        self._walls = walls
        self.by_id: dict[str, Obstacle] = {}

    def take(self, world: WorldState | WorldDelta) -> None:
        if isinstance(world, WorldState):
            self.by_id.clear()
        else:
            self._forget(world.removed)
        for thing in world.objects:
            obstacle = obstacle_of(thing, self._walls)
            if obstacle is not None:
                self.by_id[thing.id] = obstacle
            else:
                self._forget((thing.id,))

    def _forget(self, ids: Iterable[str]) -> None:
        for id in ids:
            self.by_id.pop(id, None)


def obstacle_of(thing: ObjectState, walls: Sequence[Wall]) -> Obstacle | None:
    """As big as things of its type commonly are; None for what is low, carried, or part of the building.

    Nobody reports how a thing is turned. Where it stands close to a wall, it stands along it.
    """
    row = catalogue().get(thing.type)
    if row is None or row.kind not in ("static", "moveable") or thing.confidence < BELIEVED:
        return None
    x, y, z = thing.position_enu_m
    top_m = z + row.size_m[2] / 2.0
    if top_m < LEAST_HEIGHT_M:
        return None
    unsure_m = sqrt(max(thing.covariance_m2[0], thing.covariance_m2[2]))
    return Obstacle(outline_of((x, y), (row.size_m[0], row.size_m[1]), unsure_m, walls), top_m)
