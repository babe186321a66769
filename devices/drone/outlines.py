"""The outline of a thing on the floor: a rectangle as it stands, or a circle where nobody knows how it is turned."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import atan2, cos, hypot, sin

from wire.model import Vec2
from wire.outline import segment_distance_m
from wire.site import Wall

ALONG_M = 0.2
"""What is nearer to a wall than half its depth and so much stands along it: turned otherwise it would not fit."""


@dataclass(frozen=True, slots=True)
class Outline:
    """A rectangle of half sides along its own axes, grown by a radius all around; without sides it is a circle."""

    middle_m: Vec2
    radius_m: float
    half_m: Vec2 = (0.0, 0.0)
    yaw_rad: float = 0.0

    @property
    def reach_m(self) -> float:
        """Nothing of it is farther from its middle."""
        return hypot(*self.half_m) + self.radius_m

    def distance_m(self, point_m: Vec2) -> float:
        """From a point outside; negative, or nought, inside."""
        x, y = self._own(point_m)
        return hypot(max(0.0, abs(x) - self.half_m[0]), max(0.0, abs(y) - self.half_m[1])) - self.radius_m

    def way_distance_m(self, a_m: Vec2, b_m: Vec2) -> float:
        """From a straight way."""
        a, b, (half_x, half_y) = self._own(a_m), self._own(b_m), self.half_m
        if _crosses(a, b, self.half_m):
            return -self.radius_m
        corners = [(x, y) for x in (-half_x, half_x) for y in (-half_y, half_y)]
        from_corners = min(segment_distance_m(corner, a, b) for corner in corners)
        return min(from_corners - self.radius_m, self.distance_m(a_m), self.distance_m(b_m))

    def _own(self, point_m: Vec2) -> Vec2:
        """In its own axes."""
        dx, dy = point_m[0] - self.middle_m[0], point_m[1] - self.middle_m[1]
        c, s = cos(self.yaw_rad), sin(self.yaw_rad)
        return (c * dx + s * dy, c * dy - s * dx)


def _crosses(a: Vec2, b: Vec2, half_m: Vec2) -> bool:
    """Whether a straight piece touches the rectangle around the origin (Liang and Barsky 1984)."""
    begins, ends = 0.0, 1.0
    for start, end, half in zip(a, b, half_m, strict=True):
        step = end - start
        if step == 0.0:
            if abs(start) > half:
                return False
            continue
        one, other = sorted(((-half - start) / step, (half - start) / step))
        begins, ends = max(begins, one), min(ends, other)
    return begins <= ends


def outline_of(middle_m: Vec2, size_m: Vec2, unsure_m: float, walls: Iterable[Wall]) -> Outline:
    """Of a thing of which nobody has said how it is turned: along a wall that leaves it no other way to stand."""
    short, long = sorted(size_m)
    wall = min((w for w in walls if _beside(middle_m, w, long)), key=lambda w: _gap_m(middle_m, w), default=None)
    if wall is None or _gap_m(middle_m, wall) + unsure_m > short / 2.0 + ALONG_M:
        return Outline(middle_m, long / 2.0)
    yaw_rad = atan2(wall.end_m[1] - wall.start_m[1], wall.end_m[0] - wall.start_m[0])
    return Outline(middle_m, 0.0, (long / 2.0, short / 2.0), yaw_rad)


def _gap_m(middle_m: Vec2, wall: Wall) -> float:
    """From a thing's middle to the face of a wall."""
    return segment_distance_m(middle_m, wall.start_m, wall.end_m) - wall.thickness_m / 2.0


def _beside(middle_m: Vec2, wall: Wall, long_m: float) -> bool:
    """Whether the wall goes on for a quarter of the thing's length, to both sides of its middle."""
    dx, dy = wall.end_m[0] - wall.start_m[0], wall.end_m[1] - wall.start_m[1]
    length_m = hypot(dx, dy)
    if length_m == 0.0:
        return False
    along_m = ((middle_m[0] - wall.start_m[0]) * dx + (middle_m[1] - wall.start_m[1]) * dy) / length_m
    return long_m / 4.0 <= along_m <= length_m - long_m / 4.0
