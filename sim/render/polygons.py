"""Simple polygons of the floor plan: inside or not, and cut into triangles."""

from sim.scene import Vec2

Polygon = tuple[Vec2, ...]


def contains(polygon: Polygon, point: Vec2) -> bool:
    """By the crossings of a ray to the east."""
    x, y = point
    inside = False
    for (ax, ay), (bx, by) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            inside = not inside
    return inside


def area(polygon: Polygon) -> float:
    """Positive when counter-clockwise."""
    pairs = zip(polygon, polygon[1:] + polygon[:1], strict=True)
    return sum(ax * by - bx * ay for (ax, ay), (bx, by) in pairs) / 2.0


def triangles(polygon: Polygon) -> list[Polygon]:
    """Counter-clockwise triangles that cover a simple polygon, by cutting ears."""
    corners = list(polygon if area(polygon) > 0.0 else polygon[::-1])
    found: list[Polygon] = []
    while len(corners) > 3:
        cut = next((i for i in range(len(corners)) if _is_ear(corners, i)), 0)
        ear = (corners[cut - 1], corners[cut], corners[(cut + 1) % len(corners)])
        if area(ear) > 1e-9:
            found.append(ear)
        del corners[cut]
    return [*found, (corners[0], corners[1], corners[2])]


def _is_ear(corners: list[Vec2], index: int) -> bool:
    before, corner, after = corners[index - 1], corners[index], corners[(index + 1) % len(corners)]
    ear = (before, corner, after)
    if area(ear) < 0.0:
        return False
    return not any(_covers(ear, other) for other in corners if other not in ear)


def _covers(triangle: Polygon, point: Vec2) -> bool:
    """Inside or on the edge of a counter-clockwise triangle."""
    pairs = zip(triangle, triangle[1:] + triangle[:1], strict=True)
    return all((bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax) >= 0.0 for (ax, ay), (bx, by) in pairs)
