"""How much of a room has been looked at, and from where more of it would be seen."""

from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from devices.quadruped.grid import CELL_M
from devices.quadruped.look import CLEAR_VIEW, FAR_M, Look
from devices.quadruped.map import FloorMap
from devices.quadruped.path import NEEDED_M, prices, reachable
from wire.model import Vec2

SEEN, GLANCED = 3.0, 1.0
"""A measured surface settles a place at once; being in view without one, in three pictures."""
NEAR_M = 0.5
RAY_GAP_RAD = 0.03
LATTICE_M = 0.5
WALK_PRICE_PER_M = 0.04
"""Walking a metre must show this share of the room more."""
WALL_M = 0.05
SAMPLE_M = 0.2
"""The depth picture is sampled: a measured point stands for what is this near to it."""
_AROUND_M = np.stack(np.meshgrid(*[np.linspace(-SAMPLE_M, SAMPLE_M, 5)] * 2), axis=-1).reshape(-1, 2)

Cells = NDArray[np.bool_]
"""One truth for every cell of the floor map."""


class Coverage:
    """Of one room, since this was made."""

    def __init__(self, floor: FloorMap, polygon_m: tuple[Vec2, ...], far_m: float = FAR_M) -> None:
        self._floor, self._far_m = floor, far_m
        self._open: Cells = np.array(floor.walls_m) > WALL_M
        self._room: Cells = np.frombuffer(floor.inside(polygon_m), np.bool_) & self._open
        self._score = np.zeros(floor.size, np.float32)
        self._cells = max(1, int(self._room.sum()))

    @property
    def area_m2(self) -> float:
        """Of the whole room."""
        return self._cells * CELL_M**2

    @property
    def left(self) -> float:
        """Share of the room that nobody has looked at."""
        return float((self._room & (self._score < SEEN)).sum()) / self._cells

    def take(self, look: Look) -> None:
        """One picture more."""
        self._score[self._in_view(look.camera_m, look.yaw_rad, CLEAR_VIEW * look.hfov_rad)] += GLANCED
        away = look.surface_m[:, :2] - np.array(look.camera_m, np.float32)
        off_rad = np.arctan2(away[:, 1], away[:, 0]) - look.yaw_rad
        off_rad = (off_rad + np.pi) % (2.0 * np.pi) - np.pi
        clear = (np.abs(off_rad) < CLEAR_VIEW * look.hfov_rad / 2.0) & (np.hypot(away[:, 0], away[:, 1]) < self._far_m)
        clear_m = look.surface_m[clear, :2]
        if len(clear_m):
            around = (clear_m[:, None] + _AROUND_M).reshape(-1, 2)
            self._score[self._cells_of(around)] = SEEN

    def gain(self, camera_m: Vec2, yaw_rad: float, hfov_rad: float = 2.0 * np.pi) -> float:
        """Share of the room that a look would show for the first time."""
        seen = self._in_view(camera_m, yaw_rad, hfov_rad) & self._room & (self._score < SEEN)
        return float(seen.sum()) / self._cells

    def best_place(self, here_m: Vec2, not_at_m: list[Vec2]) -> tuple[Vec2, float] | None:
        """Where to look around next, and what that would show; None when no way leads to any place in the room."""
        best: tuple[float, Vec2, float] | None = None
        for place_m in self._lattice(here_m, not_at_m):
            gain = self.gain(place_m, 0.0)
            away = float(np.hypot(place_m[0] - here_m[0], place_m[1] - here_m[1]))
            worth = gain - WALK_PRICE_PER_M * away
            if best is None or worth > best[0] + 1e-9:
                best = (worth, place_m, gain)
        return None if best is None else (best[1], best[2])

    def _lattice(self, here_m: Vec2, not_at_m: list[Vec2]) -> list[Vec2]:
        floor = self._floor
        free = self._room & (np.array(floor.clearance_m) >= NEEDED_M)
        free &= np.frombuffer(reachable(floor, prices(floor, here_m), here_m), np.bool_)
        for tried_m in not_at_m:
            free &= np.array(floor.distance_m(tried_m)) > LATTICE_M
        every = ceil(LATTICE_M / CELL_M)
        cells = np.flatnonzero(free)
        rows, columns = np.divmod(cells, floor.columns)
        chosen = (rows % every == 0) & (columns % every == 0)
        if not chosen.any():
            chosen = np.ones(len(cells), np.bool_)
        return [floor.centre_m(cell) for cell in cells[chosen].tolist()]

    def _cells_of(self, points_m: NDArray[np.floating[Any]]) -> NDArray[np.int64]:
        """The cells of many points; points outside get the nearest."""
        floor = self._floor
        columns, rows = np.floor((points_m - (floor.west_m, floor.south_m)) / CELL_M).astype(np.int64).T
        cells: NDArray[np.int64] = np.clip(rows, 0, floor.rows - 1) * floor.columns + np.clip(
            columns, 0, floor.columns - 1
        )
        return cells

    def _in_view(self, camera_m: Vec2, yaw_rad: float, hfov_rad: float) -> Cells:
        """Cells between which and the camera no wall stands."""
        count = max(8, ceil(hfov_rad / RAY_GAP_RAD))
        bearings = yaw_rad + np.linspace(-hfov_rad / 2.0, hfov_rad / 2.0, count)
        ranges = np.arange(CELL_M, self._far_m, CELL_M)
        points = np.stack([np.cos(bearings), np.sin(bearings)], axis=1)[:, None, :] * ranges[None, :, None]
        cells = self._cells_of((points + np.array(camera_m)).reshape(-1, 2))
        open_ = self._open[cells].reshape(count, len(ranges))
        visible = np.logical_and.accumulate(open_, axis=1) & (ranges > NEAR_M)
        result = np.zeros(self._room.shape, np.bool_)
        result[cells[visible.ravel()]] = True
        return result
