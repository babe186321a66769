"""What lies inside of an outline on the floor (even-odd rule). Site frame, metres."""

from collections.abc import Sequence

from wire.model import Vec2


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
