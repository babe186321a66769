"""Where pictures are taken from: fixed cameras high up at walls, and the mast of a robot on free floor."""

from math import atan2, hypot, radians

import numpy as np
from numpy.typing import NDArray

from devices.vision.lens import Lens
from sim.scene import Body, Room, Scene, Vec2
from wire.catalogue import catalogue

MAST_HEIGHT_M = 1.30
MAST_FORWARD_M = 0.20
MAST_SIZE = (480, 360, 240.0)
"""Width, height and focal length of a robot's camera in pixels."""
ROBOT_RADIUS_M = 0.38


def cctv_lens(scene: Scene, rng: np.random.Generator) -> Lens:
    """One of the home's own cameras a little displaced, or a place at a wall of any room looking into it."""
    if scene.cameras and rng.random() < 0.35:
        pose = scene.cameras[rng.integers(len(scene.cameras))]
        x, y, z = (p + rng.normal(0.0, s) for p, s in zip(pose.position_m, (0.02, 0.02, 0.05), strict=True))
        yaw, tilt = pose.yaw_rad + rng.normal(0.0, 0.08), pose.tilt_down_rad + rng.normal(0.0, 0.05)
        return Lens(640, 480, 320.0, (float(x), float(y), float(z)), float(yaw), float(tilt))
    room = any_room(scene, rng)
    corners = np.array(room.polygon_m)
    side = int(rng.integers(len(corners)))
    start, end = corners[side], corners[(side + 1) % len(corners)]
    along = start + (end - start) * rng.uniform(0.02, 0.98)
    inward = corners.mean(axis=0) - along
    place = along + inward / max(0.1, hypot(*inward)) * rng.uniform(0.15, 0.35)
    target = max((point_in(room, rng) - place for _ in range(3)), key=lambda away: hypot(*away))
    yaw = atan2(target[1], target[0])
    tilt = radians(rng.uniform(22.0, 42.0))
    return Lens(640, 480, 320.0, (float(place[0]), float(place[1]), float(rng.uniform(2.1, 2.5))), yaw, tilt)


def mast_lens(scene: Scene, rng: np.random.Generator) -> Lens | None:
    """A robot on free floor, looking at something or nowhere in particular."""
    for _ in range(30):
        place = point_in(any_room(scene, rng), rng)
        if is_free(scene, (float(place[0]), float(place[1])), ROBOT_RADIUS_M):
            break
    else:
        return None
    near = [
        b for b in scene.bodies.values() if 0.6 < hypot(b.position_m[0] - place[0], b.position_m[1] - place[1]) < 3.5
    ]
    yaw, tilt = float(rng.uniform(-np.pi, np.pi)), float(radians(rng.uniform(0.0, 60.0)))
    if near and rng.random() < 0.75:
        body = near[int(rng.integers(len(near)))]
        away = np.array(body.position_m[:2]) - place
        yaw = atan2(away[1], away[0]) + float(rng.normal(0.0, 0.25))
        drop = MAST_HEIGHT_M - body.position_m[2] - body.size_m[2] / 2.0
        aimed = atan2(drop, max(0.2, hypot(*away) - MAST_FORWARD_M)) + float(rng.normal(0.0, 0.15))
        tilt = float(np.clip(aimed, 0.0, radians(60.0)))
    x, y = place[0] + MAST_FORWARD_M * np.cos(yaw), place[1] + MAST_FORWARD_M * np.sin(yaw)
    return Lens(*MAST_SIZE, (float(x), float(y), MAST_HEIGHT_M), yaw, tilt)


def any_room(scene: Scene, rng: np.random.Generator) -> Room:
    """Large rooms more often."""
    areas = np.array([_area_m2(room) for room in scene.rooms]) ** 0.5
    return scene.rooms[int(rng.choice(len(areas), p=areas / areas.sum()))]


def point_in(room: Room, rng: np.random.Generator) -> NDArray[np.float64]:
    """A random point of its floor."""
    corners = np.array(room.polygon_m)
    for _ in range(100):
        point: NDArray[np.float64] = rng.uniform(corners.min(axis=0), corners.max(axis=0))
        if _contains(room.polygon_m, (float(point[0]), float(point[1]))):
            return point
    middle: NDArray[np.float64] = corners.mean(axis=0)
    return middle


def is_free(scene: Scene, point_m: Vec2, radius_m: float) -> bool:
    """No body that stands on the floor is within the radius."""
    return not any(_reaches(body, point_m, radius_m) for body in scene.bodies.values() if body.position_m[2] < 0.5)


def _reaches(body: Body, point_m: Vec2, radius_m: float) -> bool:
    row = catalogue().get(body.type)
    if body.gone or (row is not None and row.kind == "pickup"):
        return False
    c, s = np.cos(body.yaw_rad), np.sin(body.yaw_rad)
    dx, dy = point_m[0] - body.position_m[0], point_m[1] - body.position_m[1]
    forward, left = abs(c * dx + s * dy), abs(-s * dx + c * dy)
    return bool(forward < body.size_m[0] / 2.0 + radius_m and left < body.size_m[1] / 2.0 + radius_m)


def _area_m2(room: Room) -> float:
    corners = room.polygon_m
    pairs = zip(corners, corners[1:] + corners[:1], strict=True)
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs)) / 2.0


def _contains(polygon: tuple[Vec2, ...], point: Vec2) -> bool:
    inside = False
    for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        if (a[1] > point[1]) != (b[1] > point[1]):
            inside ^= point[0] < a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    return inside
