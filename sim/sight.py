"""Lines of sight among upright boxes: from a camera to a thing, past everything that could be in between."""

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from sim.boxes import Box, body_box
from sim.scene import Body, Scene, Vec3
from wire.catalogue import catalogue

FACE_SHARE = 0.9
"""How far towards its faces a thing's sample points lie."""
NARROW_SHARE = {"FloorLamp": 0.3, "HousePlant": 0.6, "DeskLamp": 0.4, "Chair": 0.8}
"""Of their box, the part across that really hides what is behind."""

Array = NDArray[np.float64]


def hides_contents(body: Body) -> bool:
    """A closed thing whose inside can neither be seen nor reached."""
    return catalogue()[body.type].must_open and not body.props.get("isOpen", False)


def ancestors(scene: Scene, key: int) -> list[int]:
    """The receptacles around a thing, innermost first."""
    found: list[int] = []
    parent = scene.bodies[key].parent
    while parent is not None and parent not in found:
        found.append(parent)
        parent = scene.bodies[parent].parent
    return found


def contents(scene: Scene, key: int) -> set[int]:
    """Keys of all that rests in or on a thing, directly or not."""
    inside = {key}
    while True:
        more = {k for k, body in scene.bodies.items() if body.parent in inside} - inside
        if not more:
            return inside - {key}
        inside |= more


def closed_around(scene: Scene, key: int) -> Body | None:
    """The innermost closed receptacle that a thing is shut up in."""
    return next((scene.bodies[k] for k in ancestors(scene, key) if hides_contents(scene.bodies[k])), None)


class Obstacles:
    """What may be in the way, as arrays."""

    def __init__(self, owners: Sequence[int], boxes: Sequence[Box]) -> None:
        self._owner = np.array(owners, dtype=np.int64)
        self._centre = np.array([b.centre_m for b in boxes], dtype=np.float64).reshape(-1, 3)
        self._half = np.array([b.half_m for b in boxes], dtype=np.float64).reshape(-1, 3)
        yaw = np.array([b.yaw_rad for b in boxes], dtype=np.float64)
        self._cos, self._sin = np.cos(yaw), np.sin(yaw)

    def any_ray_free(self, eye_m: Vec3, points_m: Sequence[Vec3], ignored: Collection[int]) -> bool:
        """Whether at least one of the segments from the eye meets no box of anything that is not ignored."""
        keep = ~np.isin(self._owner, list(ignored))
        start = self._into(np.array(eye_m)[None, :], keep)
        span = self._into(np.array(points_m), keep) - start
        half = self._half[keep][None, :, :]
        with np.errstate(divide="ignore", invalid="ignore"):
            low, high = (-half - start) / span, (half - start) / span
        flat = np.abs(span) < 1e-12
        outside = flat & (np.abs(start) > half)
        enter = np.where(flat, -np.inf, np.minimum(low, high)).max(axis=2)
        leave = np.where(flat, np.inf, np.maximum(low, high)).min(axis=2)
        hit = (enter < leave) & (leave > 0.0) & (enter < 1.0 - 1e-6) & ~outside.any(axis=2)
        return bool((~hit.any(axis=1)).any())

    def _into(self, points: Array, keep: NDArray[np.bool_]) -> Array:
        """Points (n, 3) in every kept box's own frame: (n, boxes, 3)."""
        delta = points[:, None, :] - self._centre[keep][None, :, :]
        c, s = self._cos[keep], self._sin[keep]
        x, y = c * delta[..., 0] + s * delta[..., 1], -s * delta[..., 0] + c * delta[..., 1]
        return np.stack((x, y, delta[..., 2]), axis=-1)


def obstacles_around(
    scene: Scene, structure: Sequence[Box], robots: Sequence[Box], eye_m: Vec3, within_m: float
) -> Obstacles:
    """Everything solid near the eye as it stands now. Structure has owner -1, robots have -2; bodies have their keys."""
    bodies = [
        b
        for b in scene.bodies.values()
        if abs(b.position_m[0] - eye_m[0]) <= within_m + b.size_m[0] + b.size_m[1]
        and abs(b.position_m[1] - eye_m[1]) <= within_m + b.size_m[0] + b.size_m[1]
        and b.held_by is None
        and not b.gone
    ]
    walls = [box for box in structure if box.floor_gap_m(eye_m) <= within_m]
    owners = [-1] * len(walls) + [-2] * len(robots) + [b.key for b in bodies]
    return Obstacles(owners, [*walls, *robots, *map(_opaque_box, bodies)])


def _opaque_box(body: Body) -> Box:
    box, share = body_box(body), NARROW_SHARE.get(body.type, 1.0)
    return Box(box.centre_m, (share * box.half_m[0], share * box.half_m[1], box.half_m[2]), box.yaw_rad)


def is_visible(scene: Scene, around: Obstacles, eye_m: Vec3, key: int) -> bool:
    """Whether some part of a thing can be seen from the eye; what it rests on or in does not hide it unless closed."""
    if closed_around(scene, key) is not None:
        return False
    ignored = {key, *ancestors(scene, key), *contents(scene, key)}
    return around.any_ray_free(eye_m, sample_points(body_box(scene.bodies[key]), eye_m), ignored)


def sample_points(box: Box, eye_m: Vec3) -> list[Vec3]:
    """The middle, a point near each face, and the point nearest to the eye."""
    x, y, z = (FACE_SHARE * half for half in box.half_m)
    local = [(0.0, 0.0, 0.0), (x, 0.0, 0.0), (-x, 0.0, 0.0), (0.0, y, 0.0), (0.0, -y, 0.0), (0.0, 0.0, z)]
    return [box.site(point) for point in local] + [box.nearest_point(eye_m)]
