"""Fixed cameras in corners and on walls, chosen so that together they watch about half of the free floor."""

from dataclasses import replace
from math import atan2, inf, pi
from random import Random

import numpy as np
from numpy.typing import NDArray

from sim.boxes import Box, body_box, structure_boxes
from sim.generator.access import body_area, standing_areas
from sim.generator.areas import Area
from sim.scene import CctvPose, Room, Scene, Vec2, Vec3
from wire.frames import camera_axes

WIDTH_PX, HEIGHT_PX, FOCAL_PX = 640, 480, 320.0
THING_M, THING_PX = 0.25, 12.0
"""Floor counts as watched where a thing of this size would be so large in the picture."""
CELL_M = 0.1
COVERED = (0.45, 0.55)
AIM = (0.46, 0.54)
CAMERAS = (4, 6)
EACH_ROOM, DRAWS = 6, 400
OFF_WALL_M = 0.12
TALL_M = 1.35
"""No camera hangs over anything taller: it would see little else."""

Mask = NDArray[np.bool_]
Floats = NDArray[np.float64]


def place_cameras(scene: Scene, rng: Random) -> tuple[CctvPose, ...] | None:
    """A set of four to six; None when none of those drawn watches the right share."""
    floor = free_floor(scene)
    solids = _solids(scene)
    tall = [body_area(b).grown(0.1) for b in scene.bodies.values() if b.position_m[2] + b.size_m[2] > TALL_M]
    drawn = [pose for room in scene.rooms for pose in _candidates(room, rng)]
    poses = [p for p in drawn if not any(_within(p.position_m, area) for area in tall)]
    seen = [watched(pose, floor, solids) for pose in poses]
    useful = [k for k, mask in enumerate(seen) if mask.mean() > 0.04]
    wanted = min(CAMERAS[1], max(CAMERAS[0], len(scene.rooms) - rng.randint(0, 1)))
    for count in sorted(range(CAMERAS[0], CAMERAS[1] + 1), key=lambda n: abs(n - wanted)):
        chosen = _choose(poses, seen, useful, count, rng)
        if chosen:
            return tuple(replace(poses[k], id=f"cam-{number}") for number, k in enumerate(sorted(chosen), start=1))
    return None


def _choose(poses: list[CctvPose], seen: list[Mask], useful: list[int], count: int, rng: Random) -> list[int]:
    """Of many sets drawn, the one that watches the right share with the least waste; empty when there is none."""
    best: tuple[float, list[int]] = (inf, [])
    for _ in range(DRAWS if len(useful) >= count else 0):
        chosen = rng.sample(useful, count)
        share = float(np.logical_or.reduce([seen[k] for k in chosen]).mean())
        # Cameras in different rooms are worth more than two looking at the same floor.
        same_room = count - len({poses[k].room for k in chosen})
        waste = sum(float(seen[k].mean()) for k in chosen) - share + 0.2 * same_room
        if AIM[0] <= share <= AIM[1] and waste < best[0]:
            best = (waste, chosen)
    return best[1]


def coverage(scene: Scene) -> float:
    """The part of the free floor that the scene's cameras watch."""
    floor, solids = free_floor(scene), _solids(scene)
    return float(np.logical_or.reduce([watched(pose, floor, solids) for pose in scene.cameras]).mean())


def free_floor(scene: Scene) -> Floats:
    """Middles of the cells of floor with nothing on them, (n, 2)."""
    corners = np.array([corner for room in scene.rooms for corner in room.polygon_m])
    low, high = corners.min(axis=0), corners.max(axis=0)
    xs, ys = (np.arange(low[k] + CELL_M / 2.0, high[k], CELL_M) for k in (0, 1))
    points = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    taken = np.zeros(len(points), dtype=bool)
    walls = [_flat(box) for box in structure_boxes(scene) if box.centre_m[2] - box.half_m[2] < 0.1]
    for area in [*standing_areas(scene), *walls]:
        taken |= (
            (points[:, 0] > area.x0) & (points[:, 0] < area.x1) & (points[:, 1] > area.y0) & (points[:, 1] < area.y1)
        )
    return points[~taken]


def _within(point_m: Vec3, area: Area) -> bool:
    return area.x0 <= point_m[0] <= area.x1 and area.y0 <= point_m[1] <= area.y1


def _flat(box: Box) -> Area:
    x, y, _ = box.centre_m
    sideways = abs(np.sin(box.yaw_rad)) > 0.5
    return Area.around((x, y), 2.0 * box.half_m[0], 2.0 * box.half_m[1], bool(sideways))


def watched(pose: CctvPose, floor: Floats, solids: list[Box]) -> Mask:
    """Which points of the floor are in the picture, near enough and not hidden."""
    eye = np.array(pose.position_m)
    rays = np.column_stack([floor, np.zeros(len(floor))]) - eye
    right, down, forward = (rays @ np.array(axis) for axis in camera_axes(pose.yaw_rad, pose.tilt_down_rad))
    depth = np.maximum(forward, 1e-6)
    inside = (forward > 0.1) & (forward * THING_PX <= pose.focal_px * THING_M)
    inside &= np.abs(right) * pose.focal_px <= depth * pose.width_px / 2.0
    inside &= np.abs(down) * pose.focal_px <= depth * pose.height_px / 2.0
    index = np.flatnonzero(inside)
    for box in solids:
        index = index[~_hidden_by(box, eye, rays[index])]
    mask = np.zeros(len(floor), dtype=bool)
    mask[index] = True
    return mask


def _hidden_by(box: Box, eye: Floats, rays: Floats) -> Mask:
    """Whether each ray from the eye enters the box before its end."""
    c, s = np.cos(box.yaw_rad), np.sin(box.yaw_rad)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    start = turn @ (eye - np.array(box.centre_m))
    ways = rays @ turn.T
    ways = np.where(np.abs(ways) < 1e-9, 1e-9, ways)
    half = np.array(box.half_m)
    near, far = (-half - start) / ways, (half - start) / ways
    enter = np.minimum(near, far).max(axis=1)
    leave = np.maximum(near, far).min(axis=1)
    return np.asarray((enter < leave) & (leave > 0.0) & (enter < 0.999))


def _solids(scene: Scene) -> list[Box]:
    standing = [body_box(b) for b in scene.bodies.values() if b.parent is None and b.type != "Painting"]
    return structure_boxes(scene) + standing


def _candidates(room: Room, rng: Random) -> list[CctvPose]:
    """In the corners, and some on walls, looking more or less at the middle of the room."""
    xs, ys = zip(*room.polygon_m, strict=True)
    inset = 0.05 + OFF_WALL_M
    x0, x1, y0, y1 = min(xs) + inset, max(xs) - inset, min(ys) + inset, max(ys) - inset
    middle = ((x0 + x1) / 2.0, (y0 + y1) / 2.0)
    corners: list[Vec2] = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    rng.shuffle(corners)
    walls: list[Vec2] = [(x0, middle[1]), (x1, middle[1]), (middle[0], y0), (middle[0], y1)]
    places = [*corners, *rng.sample(walls, EACH_ROOM - len(corners))]
    poses = []
    for x, y in places:
        yaw = atan2(middle[1] - y, middle[0] - x) + rng.uniform(-0.25, 0.25)
        height, tilt = rng.uniform(2.2, 2.4), rng.uniform(25.0, 40.0) * pi / 180.0
        poses.append(
            CctvPose(
                "cam",
                room.id,
                (round(x, 3), round(y, 3), round(height, 3)),
                round(yaw, 4),
                round(tilt, 4),
                WIDTH_PX,
                HEIGHT_PX,
                FOCAL_PX,
            )
        )
    return poses
