"""A free spot in or on a receptacle for a thing in hand: the nearest to a point, found the same way every time."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import dist, pi

from sim.boxes import Box, body_box, boxes_overlap
from sim.models.surfaces import Surface, surfaces
from sim.scene import Body, Scene, Vec2, Vec3

GRID_M = 0.04
MARGIN_M = 0.01
SINK_M = 0.003
"""Things on the same surface need not be told apart in height more finely than this."""


@dataclass(frozen=True)
class Spot:
    """Where the base of a thing comes to rest."""

    position_m: Vec3
    yaw_rad: float


def find_spot(
    scene: Scene, receptacle: Body, item: Body, near_m: Vec3, reach_from_m: Vec2, reach_m: float
) -> Spot | None:
    """The free spot nearest to `near_m` that an arm at `reach_from_m` can reach; None when there is none."""
    others = [body_box(b) for b in scene.bodies.values() if b.parent == receptacle.key and not b.gone]
    candidates = sorted(
        _candidates(receptacle, item), key=lambda s: (dist(s.position_m, near_m), s.position_m, s.yaw_rad)
    )
    for spot in candidates:
        box = _box_at(item, spot)
        if box.floor_gap_m(reach_from_m) <= reach_m and not any(boxes_overlap(box.grown(MARGIN_M), o) for o in others):
            return spot
    return None


def _candidates(receptacle: Body, item: Body) -> Iterator[Spot]:
    origin = Box(receptacle.position_m, (0.0, 0.0, 0.0), receptacle.yaw_rad)
    for surface in surfaces(receptacle):
        if item.size_m[2] > surface.room_above_m:
            continue
        for turn_rad in (0.0, pi / 2.0):
            for x, y in _grid(surface, item, turned=turn_rad > 0.0):
                yield Spot(origin.site((x, y, surface.height_m + SINK_M)), receptacle.yaw_rad + turn_rad)


def _grid(surface: Surface, item: Body, turned: bool) -> Iterator[Vec2]:
    """Centres at which the thing lies wholly on the surface."""
    depth, width, _ = item.size_m
    if turned:
        depth, width = width, depth
    for x in _steps((surface.size_m[0] - depth) / 2.0):
        for y in _steps((surface.size_m[1] - width) / 2.0):
            yield (surface.centre_m[0] + x, surface.centre_m[1] + y)


def _steps(slack_m: float) -> list[float]:
    """From -slack to slack, symmetric about 0; empty when the slack is negative."""
    if slack_m < 0.0:
        return []
    count = int(slack_m / GRID_M)
    return [k * slack_m / max(1, count) for k in range(-count, count + 1)]


def _box_at(item: Body, spot: Spot) -> Box:
    depth, width, height = item.size_m
    x, y, z = spot.position_m
    return Box((x, y, z + height / 2.0), (depth / 2.0, width / 2.0, height / 2.0), spot.yaw_rad)
