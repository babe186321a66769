"""A grid over the floor: where a robot fits, whether it gets from door to door and up to every thing."""

import cv2
import numpy as np
from numpy.typing import NDArray

from sim.generator.areas import Area
from sim.scene import Vec2

CELL_M = 0.05
CLEAR_M = 0.47
"""From a robot's middle to anything, inside a room: its radius, its planner's margin and half a cell of its map."""
WITHIN_M = 0.95
"""A standing place must be so near to a thing: within reach of a robot, with some to spare."""

Grid = NDArray[np.float64]
Mask = NDArray[np.bool_]


class Floor:
    """The floor of one room, or of a whole home: a rectangle with things on it."""

    def __init__(self, inner: Area, must_reach_m: tuple[Vec2, ...] = ()) -> None:
        """`inner`: between the walls' surfaces. `must_reach_m`: points that have to stay connected (doors)."""
        self.inner = inner
        self.must_reach_m = must_reach_m
        xs = np.arange(inner.x0 + CELL_M / 2.0, inner.x1, CELL_M)
        ys = np.arange(inner.y0 + CELL_M / 2.0, inner.y1, CELL_M)
        self.x, self.y = np.meshgrid(xs, ys)
        self.clearance_m: Grid = np.minimum(
            np.minimum(self.x - inner.x0, inner.x1 - self.x), np.minimum(self.y - inner.y0, inner.y1 - self.y)
        )

    def distance_m(self, area: Area) -> Grid:
        """From every cell to the nearest point of an area."""
        dx = np.maximum(np.maximum(area.x0 - self.x, self.x - area.x1), 0.0)
        dy = np.maximum(np.maximum(area.y0 - self.y, self.y - area.y1), 0.0)
        gap: Grid = np.hypot(dx, dy)
        return gap

    def put(self, area: Area) -> None:
        """Something stands there from now on."""
        self.clearance_m = np.minimum(self.clearance_m, self.distance_m(area))

    def walkable(self, clearance_m: Grid | None = None, needed_m: float = CLEAR_M) -> Mask | None:
        """Where a robot can be and get to from every point that must be reached; None when some are cut off."""
        free = (self.clearance_m if clearance_m is None else clearance_m) >= needed_m
        label = np.asarray(cv2.connectedComponents(free.astype(np.uint8), connectivity=4)[1], np.int32)
        if not self.must_reach_m:
            largest = int(np.argmax(np.bincount(label[free]))) if free.any() else 0
            return np.asarray(label == largest) if largest else None
        found = {self._label_near(point, label) for point in self.must_reach_m}
        if len(found) != 1 or 0 in found:
            return None
        return np.asarray(label == found.pop())

    def _label_near(self, point_m: Vec2, label: NDArray[np.int32]) -> int:
        column = int((point_m[0] - self.inner.x0) / CELL_M)
        row = int((point_m[1] - self.inner.y0) / CELL_M)
        rows, columns = label.shape
        return int(label[min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)])

    def near(self, walkable: Mask, point_m: Vec2) -> float:
        """Distance from a point to the nearest place a robot can stand."""
        gap = np.hypot(self.x - point_m[0], self.y - point_m[1])[walkable]
        return float(gap.min()) if gap.size else float("inf")
