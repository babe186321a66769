"""What walls say about sight: how far a bearing reaches, and that nothing seen lies behind the wall it is seen against."""

from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import numpy as np
from numpy.typing import NDArray

from devices.vision.lens import Floats, Lens
from devices.vision.projection import Sighting
from wire.site import Door, Wall

DOOR_SLACK_M = 0.1
CLEARANCE_M = 0.08
"""The centre of a thing is at least this far before the middle of the wall."""


def before_walls(
    sightings: Sequence[Sighting], lens: Lens, walls: Sequence[Wall], doors: Sequence[Door]
) -> list[Sighting]:
    """Sightings that came out behind a wall, moved along their rays to before it."""
    if not sightings or not walls:
        return list(sightings)
    origin = np.array(lens.position_enu_m)
    away = np.array([s.position_enu_m for s in sightings]) - origin
    reached = np.hypot(away[:, 0], away[:, 1])
    limit = wall_ranges_m(origin[:2], np.arctan2(away[:, 1], away[:, 0]), walls, doors) - CLEARANCE_M
    shares = np.clip(limit / np.maximum(reached, 1e-6), 0.05, 1.0)
    return [_moved(s, origin, a, float(share)) for s, a, share in zip(sightings, away, shares, strict=True)]


def _moved(sighting: Sighting, origin: Floats, away: Floats, share: float) -> Sighting:
    if share >= 1.0:
        return sighting
    x, y, z = (origin + share * away).tolist()
    return replace(sighting, position_enu_m=(x, y, z), depth_m=share * sighting.depth_m)


def wall_ranges_m(origin: Floats, bearings: Floats, walls: Sequence[Wall], doors: Sequence[Door]) -> Floats:
    """Distance to the first wall along every bearing; a wall is open between the jambs of a door."""
    ranges = np.full(len(bearings), np.inf)
    if not walls:
        return ranges
    start = np.array([w.start_m for w in walls])
    along = np.array([w.end_m for w in walls]) - start
    directions = np.stack([np.cos(bearings), np.sin(bearings)], axis=1)
    across = directions[:, None, 0] * along[None, :, 1] - directions[:, None, 1] * along[None, :, 0]
    across = np.where(np.abs(across) < 1e-9, 1e-9, across)
    gap = start - origin
    distance = (gap[:, 0] * along[:, 1] - gap[:, 1] * along[:, 0])[None, :] / across
    fraction = (gap[None, :, 0] * directions[:, None, 1] - gap[None, :, 1] * directions[:, None, 0]) / across
    hit = (distance > 0.0) & (fraction >= 0.0) & (fraction <= 1.0)
    points = origin + directions[:, None, :] * np.where(hit, distance, 0.0)[:, :, None]
    for door in doors:
        hit &= ~_in_door(points, door)
    result: Floats = np.where(hit, distance, np.inf).min(axis=1)
    return result


def _in_door(points: Floats, door: Door) -> NDArray[np.bool_]:
    """Whether points lie in the opening."""
    start, end = np.array(door.start_m), np.array(door.end_m)
    width = max(1e-6, hypot(*(end - start)))
    unit = (end - start) / width
    away = points - start
    along = away @ unit
    beside = np.abs(away[..., 0] * unit[1] - away[..., 1] * unit[0])
    inside: NDArray[np.bool_] = (along > 0.0) & (along < width) & (beside < DOOR_SLACK_M)
    return inside
