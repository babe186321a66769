"""The lamp of each room: where it hangs and how warm its light is."""

import numpy as np
from numpy.typing import NDArray

from sim.scene import Scene

PLACES = 65
"""Rooms a building can have in pictures, and one more for what is in none."""
WIDE_M = 1e4
WARMTH = {"Kitchen": 0.25, "LivingRoom": 0.85, "Bedroom": 1.0, "Bathroom": 0.05}


def lamp_table(scene: Scene) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Position and warmth of each room's lamp, bounds of each room, and the height of the ceilings."""
    ceiling_m = max((wall.height_m for wall in scene.walls), default=2.5)
    lamps, extents = np.zeros((PLACES, 4)), np.zeros((PLACES, 4))
    everything = np.array([corner for room in scene.rooms for corner in room.polygon_m] or [(0.0, 0.0)])
    low, high = everything.min(axis=0), everything.max(axis=0)
    lamps[:] = (*(low + high) / 2.0, 2.0 * ceiling_m, 0.3)
    extents[:] = (-WIDE_M, -WIDE_M, WIDE_M, WIDE_M)
    for i, room in enumerate(scene.rooms):
        corners = np.array(room.polygon_m)
        low, high = corners.min(axis=0), corners.max(axis=0)
        lamps[i] = (*(low + high) / 2.0, ceiling_m - 0.15, WARMTH.get(room.kind, 0.3))
        extents[i] = (*low, *high)
    return lamps, extents, ceiling_m
