"""Where robots can begin: four side by side in the largest room, then places spread over the whole home."""

from math import atan2, hypot
from random import Random

import numpy as np

from sim.generator.areas import Area
from sim.generator.floor import CELL_M, Floor, Mask
from sim.scene import Room, Scene, Vec2

TOGETHER, SPREAD = 4, 6
APART_M = 1.0
START_CLEAR_M = 0.52
OFF_DOOR_M = 0.7
Start = tuple[Vec2, float]


def draw_starts(scene: Scene, floor: Floor, walkable: Mask, rng: Random) -> tuple[Start, ...] | None:
    """None when the largest room has no place for them."""
    free = walkable & (floor.clearance_m >= START_CLEAR_M)
    for door in scene.doors:
        (x0, y0), (x1, y1) = door.start_m, door.end_m
        free &= floor.distance_m(Area(x0, y0, x1, y1)) >= OFF_DOOR_M
    points = [(float(x), float(y)) for x, y in zip(floor.x[free], floor.y[free], strict=True)]
    largest = max(scene.rooms, key=lambda room: _floor_m2(room.polygon_m))
    together = _together([p for p in points if _inside(p, largest)], rng)
    if together is None:
        return None
    chosen = list(together)
    for _ in range(SPREAD):
        array = np.array(points)
        gaps = np.min([np.hypot(array[:, 0] - x, array[:, 1] - y) for x, y in chosen], axis=0)
        chosen.append(points[int(np.argmax(gaps))])
    middle = _middle(largest)
    return tuple(
        ((round(x, 3), round(y, 3)), round(atan2(middle[1] - y, middle[0] - x), 4) if (x, y) != middle else 0.0)
        for x, y in chosen
    )


def _together(points: list[Vec2], rng: Random) -> list[Vec2] | None:
    """Neighbours about a metre apart, around a place drawn by chance."""
    for _ in range(20):
        if not points:
            return None
        x0, y0 = rng.choice(points)
        chosen: list[Vec2] = []
        for x, y in sorted(points, key=lambda p: (hypot(p[0] - x0, p[1] - y0), p)):
            if all(hypot(x - a, y - b) >= APART_M for a, b in chosen):
                chosen.append((x, y))
            if len(chosen) == TOGETHER:
                return chosen
    return None


def _inside(point: Vec2, room: Room) -> bool:
    xs, ys = [x for x, _ in room.polygon_m], [y for _, y in room.polygon_m]
    return min(xs) + CELL_M < point[0] < max(xs) - CELL_M and min(ys) + CELL_M < point[1] < max(ys) - CELL_M


def _floor_m2(polygon: tuple[Vec2, ...]) -> float:
    xs, ys = [x for x, _ in polygon], [y for _, y in polygon]
    return (max(xs) - min(xs)) * (max(ys) - min(ys))


def _middle(room: Room) -> Vec2:
    xs, ys = [x for x, _ in room.polygon_m], [y for _, y in room.polygon_m]
    return ((min(xs) + max(xs)) / 2.0, (min(ys) + max(ys)) / 2.0)
