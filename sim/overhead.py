"""The evaluator's eye on what flies: over which rooms and things drones have truly hovered, and how much they covered."""

from collections.abc import Mapping
from math import ceil, hypot

from sim.boxes import body_box
from sim.cameras import GIMBAL_FOCAL_PX, GIMBAL_HEIGHT_PX
from sim.flight.quadrotor import Quadrotor
from sim.scene import Scene, Vec3
from sim.truth import room_of
from wire.outline import inside

LOWEST_M = 0.8
"""Lower than this nobody looks down on anything."""
STILL_MPS = 0.4
CELL_M = 0.5
SURVEYED = 0.8
"""Part of a room's floor that the downward camera has to have shown."""
_HALF_VIEW = GIMBAL_HEIGHT_PX / (2.0 * GIMBAL_FOCAL_PX)
"""Metres to the nearest edge of the downward camera's picture per metre of height."""


class Overhead:
    """`watch` a few times a second."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._cells = {room.id: _cells(room.polygon_m) for room in scene.rooms}
        self._left = {id: set(cells) for id, cells in self._cells.items()}
        self._before: dict[str, tuple[float, Vec3]] = {}
        self.rooms: set[str] = set()
        """Rooms in which a drone has hovered."""
        self.things: set[int] = set()
        """Keys of things that a drone has hovered over."""

    @property
    def surveyed(self) -> set[str]:
        """Rooms most of whose floor has been below a drone's camera."""
        return {id for id, left in self._left.items() if len(left) <= (1.0 - SURVEYED) * len(self._cells[id])}

    def watch(self, drones: Mapping[str, Quadrotor], now_s: float) -> None:
        for id, drone in drones.items():
            here = drone.true_pose()[0]
            then_s, there = self._before.get(id, (now_s, here))
            self._before[id] = (now_s, here)
            room = room_of(self._scene, here[:2])
            if here[2] < LOWEST_M or room is None:
                continue
            reach_m = _HALF_VIEW * here[2]
            self._left[room] = {
                cell for cell in self._left[room] if max(abs(cell[0] - here[0]), abs(cell[1] - here[1])) > reach_m
            }
            if now_s > then_s and hypot(here[0] - there[0], here[1] - there[1]) / (now_s - then_s) < STILL_MPS:
                self.rooms.add(room)
                self.things |= self._below(here, room)

    def _below(self, here: Vec3, room: str) -> set[int]:
        found = set()
        for key, body in self._scene.bodies.items():
            x, y, z = body_box(body).centre_m
            reach_m = _HALF_VIEW * (here[2] - z)
            if (
                not body.gone
                and max(abs(x - here[0]), abs(y - here[1])) < reach_m
                and room_of(self._scene, (x, y)) == room
            ):
                found.add(key)
        return found


def _cells(polygon_m: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
    """Middles of the squares of a room's floor."""
    west, south = (min(p[k] for p in polygon_m) for k in (0, 1))
    east, north = (max(p[k] for p in polygon_m) for k in (0, 1))
    columns, rows = ceil((east - west) / CELL_M), ceil((north - south) / CELL_M)
    middles = [(west + (i + 0.5) * CELL_M, south + (j + 0.5) * CELL_M) for i in range(columns) for j in range(rows)]
    return [middle for middle in middles if inside(middle, polygon_m)]
