"""Which rooms a camera can see into: its view, narrowed by each door it looks through."""

from math import atan2, pi

import numpy as np

from sim.render.building import RoomFinder
from sim.render.picture import Camera
from sim.render.rows import EVERYWHERE
from sim.scene import Door, Scene, Vec2
from wire.frames import pixel_ray

Wedge = tuple[Vec2, Vec2] | None
"""Directions of the right and left edge of what is in view; None is all round."""

NEAR_DOOR_M = 0.5
"""This close to a door the view through it is not narrowed: walls are thick and robots stand in doorways."""


class Portals:
    """Doors of the building as openings between rooms."""

    def __init__(self, scene: Scene, finder: RoomFinder) -> None:
        self._finder = finder
        self._openings: dict[int, list[tuple[int, Door]]] = {i: [] for i in range(len(scene.rooms))}
        for door in scene.doors:
            one, other = (finder.index[room] for room in door.rooms)
            self._openings[one].append((other, door))
            self._openings[other].append((one, door))

    def visible(self, camera: Camera) -> np.uint64:
        """One bit for each room that may be in the picture; all of them from outside the rooms."""
        here = (camera.position_m[0], camera.position_m[1])
        room = self._finder.find(here)
        if room is None:
            return EVERYWHERE
        return np.uint64(self._look(here, room, view_wedge(camera), 1 << room))

    def _look(self, here: Vec2, room: int, wedge: Wedge, seen: int) -> int:
        """Rooms in view from one of them on; `seen` are those on the way."""
        found = 1 << room
        for beyond, door in self._openings[room]:
            if seen >> beyond & 1:
                continue
            for narrowed in _through(here, door, wedge):
                found |= self._look(here, beyond, narrowed, seen | 1 << beyond)
        return found


def view_wedge(camera: Camera) -> Wedge:
    """The horizontal directions in a picture."""
    width, height, focal = camera.width_px, camera.height_px, camera.focal_px
    widest = 0.0
    for v_px in (0.0, float(height)):
        x, y, _ = pixel_ray(float(width), v_px, width, height, focal, 0.0, camera.tilt_down_rad)
        widest = max(widest, abs(atan2(y, x)))
    # Beyond this the picture holds the point right below, and with it every direction.
    if widest > 0.45 * pi:
        return None
    edges = (camera.yaw_rad - widest, camera.yaw_rad + widest)
    right, left = ((float(np.cos(a)), float(np.sin(a))) for a in edges)
    return right, left


def _cross(a: Vec2, b: Vec2) -> float:
    return a[0] * b[1] - a[1] * b[0]


def _through(here: Vec2, door: Door, wedge: Wedge) -> list[Wedge]:
    """What is in view through a door, if anything."""
    a, b = ((p[0] - here[0], p[1] - here[1]) for p in (door.start_m, door.end_m))
    if _segment_distance(a, b) < NEAR_DOOR_M:
        return [wedge]
    right, left = (a, b) if _cross(a, b) > 0.0 else (b, a)
    if wedge is None:
        return [(right, left)]
    clipped = _clip(right, left, wedge)
    return [] if clipped is None else [clipped]


def _clip(right: Vec2, left: Vec2, wedge: tuple[Vec2, Vec2]) -> tuple[Vec2, Vec2] | None:
    """The part of a segment, seen from the origin, between the edges of a wedge narrower than a half turn."""
    low, high = 0.0, 1.0
    step = (left[0] - right[0], left[1] - right[1])
    for edge, sign in ((wedge[0], 1.0), (wedge[1], -1.0)):
        start, slope = sign * _cross(edge, right), sign * _cross(edge, step)
        if abs(slope) < 1e-12:
            if start < 0.0:
                return None
        elif slope > 0.0:
            low = max(low, -start / slope)
        else:
            high = min(high, -start / slope)
    if low >= high:
        return None
    at = [(right[0] + k * step[0], right[1] + k * step[1]) for k in (low, high)]
    return at[0], at[1]


def _segment_distance(a: Vec2, b: Vec2) -> float:
    """From the origin to a segment."""
    step = (b[0] - a[0], b[1] - a[1])
    along = -(a[0] * step[0] + a[1] * step[1]) / max(step[0] ** 2 + step[1] ** 2, 1e-12)
    along = min(max(along, 0.0), 1.0)
    return float(np.hypot(a[0] + along * step[0], a[1] + along * step[1]))
