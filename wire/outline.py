"""What lies inside of an outline on the floor."""

from wire.model import Vec2


def inside(point_m: Vec2, polygon_m: tuple[Vec2, ...]) -> bool:
    """Whether a point lies in a polygon (even-odd rule)."""
    x, y = point_m
    result = False
    x1, y1 = polygon_m[-1]
    for x2, y2 in polygon_m:
        if (y1 > y) != (y2 > y) and x < (x2 - x1) * (y - y1) / (y2 - y1) + x1:
            result = not result
        x1, y1 = x2, y2
    return result
