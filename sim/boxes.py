"""Upright boxes turned about z: what physics, lines of sight and the gripper make of everything in the building."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import atan2, cos, hypot, sin

from sim.scene import Body, Door, Scene, Vec2, Vec3, Wall

LINTEL_THICKNESS_M = 0.1


@dataclass(frozen=True)
class Box:
    """`centre_m` is the middle of the volume; `half_m` its half extents along its own x, y, z."""

    centre_m: Vec3
    half_m: Vec3
    yaw_rad: float

    def local(self, point_m: Vec3) -> Vec3:
        """A site point in the box's own frame."""
        dx, dy = point_m[0] - self.centre_m[0], point_m[1] - self.centre_m[1]
        c, s = cos(self.yaw_rad), sin(self.yaw_rad)
        return (c * dx + s * dy, -s * dx + c * dy, point_m[2] - self.centre_m[2])

    def site(self, local_m: Vec3) -> Vec3:
        """A point of the box's own frame in the site frame."""
        c, s = cos(self.yaw_rad), sin(self.yaw_rad)
        x, y, z = local_m
        return (self.centre_m[0] + c * x - s * y, self.centre_m[1] + s * x + c * y, self.centre_m[2] + z)

    def nearest_point(self, point_m: Vec3) -> Vec3:
        """The point of the solid box that is nearest to `point_m`."""
        x, y, z = (max(-h, min(h, v)) for v, h in zip(self.local(point_m), self.half_m, strict=True))
        return self.site((x, y, z))

    def gap_m(self, point_m: Vec3) -> float:
        """Distance from the point to the solid box; 0 inside it."""
        dx, dy, dz = (max(0.0, abs(v) - h) for v, h in zip(self.local(point_m), self.half_m, strict=True))
        return hypot(dx, dy, dz)

    def floor_gap_m(self, point_m: Vec2 | Vec3) -> float:
        """The same in the floor plane."""
        x, y, _ = self.local((point_m[0], point_m[1], 0.0))
        return hypot(max(0.0, abs(x) - self.half_m[0]), max(0.0, abs(y) - self.half_m[1]))

    def grown(self, margin_m: float) -> "Box":
        """The same box with its footprint larger by a margin on every side."""
        return Box(self.centre_m, (self.half_m[0] + margin_m, self.half_m[1] + margin_m, self.half_m[2]), self.yaw_rad)


def footprints_overlap(a: Box, b: Box) -> bool:
    """Whether two boxes overlap seen from above (separating axes)."""
    return not any(_separated(one, other) for one, other in ((a, b), (b, a)))


def boxes_overlap(a: Box, b: Box) -> bool:
    """Whether two boxes share volume."""
    return abs(a.centre_m[2] - b.centre_m[2]) < a.half_m[2] + b.half_m[2] and footprints_overlap(a, b)


def _separated(frame: Box, other: Box) -> bool:
    x, y, _ = frame.local(other.centre_m)
    turn = other.yaw_rad - frame.yaw_rad
    c, s = abs(cos(turn)), abs(sin(turn))
    reach_x = other.half_m[0] * c + other.half_m[1] * s
    reach_y = other.half_m[0] * s + other.half_m[1] * c
    return abs(x) >= frame.half_m[0] + reach_x or abs(y) >= frame.half_m[1] + reach_y


def body_box(body: Body) -> Box:
    x, y, z = body.position_m
    depth, width, height = body.size_m
    return Box((x, y, z + height / 2.0), (depth / 2.0, width / 2.0, height / 2.0), body.yaw_rad)


def wall_box(wall: Wall) -> Box:
    return _between(wall.start_m, wall.end_m, wall.thickness_m, 0.0, wall.height_m)


def structure_boxes(scene: Scene) -> list[Box]:
    """Walls, and the pieces of wall above doors."""
    top_m = max((wall.height_m for wall in scene.walls), default=0.0)
    return [wall_box(wall) for wall in scene.walls] + list(_lintels(scene.doors, top_m))


def _lintels(doors: Iterable[Door], top_m: float) -> Iterable[Box]:
    for door in doors:
        if door.height_m < top_m:
            yield _between(door.start_m, door.end_m, LINTEL_THICKNESS_M, door.height_m, top_m)


def _between(start_m: Vec2, end_m: Vec2, thickness_m: float, bottom_m: float, top_m: float) -> Box:
    dx, dy = end_m[0] - start_m[0], end_m[1] - start_m[1]
    middle = ((start_m[0] + end_m[0]) / 2.0, (start_m[1] + end_m[1]) / 2.0, (bottom_m + top_m) / 2.0)
    return Box(middle, (hypot(dx, dy) / 2.0, thickness_m / 2.0, (top_m - bottom_m) / 2.0), atan2(dy, dx))
