"""Outlines on the floor: what lies inside of them (even-odd rule), how far off their edges are. Site frame, metres."""

from collections.abc import Sequence
from math import hypot

from wire.model import Vec2, Vec3


def inside(point_m: Vec2, polygon_m: Sequence[Vec2]) -> bool:
    """Whether a point lies in a polygon."""
    x, y = point_m
    result = False
    x1, y1 = polygon_m[-1]
    for x2, y2 in polygon_m:
        if (y1 > y) != (y2 > y) and x < (x2 - x1) * (y - y1) / (y2 - y1) + x1:
            result = not result
        x1, y1 = x2, y2
    return result


def spans(polygon_m: Sequence[Vec2], y_m: float) -> list[tuple[float, float]]:
    """From where to where, in x, the line at `y_m` lies in a polygon, from west to east."""
    crossings = []
    x1, y1 = polygon_m[-1]
    for x2, y2 in polygon_m:
        if (y1 > y_m) != (y2 > y_m):
            crossings.append((x2 - x1) * (y_m - y1) / (y2 - y1) + x1)
        x1, y1 = x2, y2
    crossings.sort()
    return list(zip(crossings[::2], crossings[1::2], strict=True))


def segment_distance_m(point_m: Vec2 | Vec3, start_m: Vec2, end_m: Vec2) -> float:
    """From a point to a straight piece, over the floor."""
    dx, dy = end_m[0] - start_m[0], end_m[1] - start_m[1]
    length_2 = dx * dx + dy * dy
    along = ((point_m[0] - start_m[0]) * dx + (point_m[1] - start_m[1]) * dy) / length_2 if length_2 else 0.0
    along = min(max(along, 0.0), 1.0)
    return hypot(point_m[0] - start_m[0] - along * dx, point_m[1] - start_m[1] - along * dy)


def mean_m(corners_m: Sequence[Vec2]) -> Vec2:
    """The mean of an outline's corners."""
    count = len(corners_m)
    return (sum(x for x, _ in corners_m) / count, sum(y for _, y in corners_m) / count)
