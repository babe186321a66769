"""The survey sweep: lanes to and fro over a polygon, with stations on them at which a picture is taken."""

from collections.abc import Iterator, Sequence
from math import ceil, cos, sin

from wire.model import Vec2
from wire.outline import spans


def sweep(polygon_m: Sequence[Vec2], spacing_m: float, margin_m: float) -> Iterator[Vec2]:
    """Stations in the order in which they are flown over, at most `spacing_m` apart along a lane and from lane to lane.

    Lanes run along the polygon's longer side as its bounding box has it, `margin_m` from its edges; a polygon with
    bays has several pieces in one lane. None when nothing of it is that far from its edges.
    """
    if spacing_m <= 0.0:
        raise ValueError(f"stations {spacing_m} m apart: give a distance above 0")
    xs, ys = [p[0] for p in polygon_m], [p[1] for p in polygon_m]
    upright = max(ys) - min(ys) > max(xs) - min(xs)
    turned = [(y, x) if upright else (x, y) for x, y in polygon_m]
    low, high = min(p[1] for p in turned) + margin_m, max(p[1] for p in turned) - margin_m
    for number, y in enumerate(_spread(low, high, spacing_m)):
        lane = [(x, y) for piece in _pieces(turned, y, margin_m) for x in _spread(*piece, spacing_m)]
        for x, _ in lane if number % 2 == 0 else lane[::-1]:
            yield (y, x) if upright else (x, y)


def ring(centre_m: Vec2, radius_m: float, from_rad: float, turn_rad: float, count: int) -> list[Vec2]:
    """Points on a circle, from one bearing through an angle (counter-clockwise when positive), `count` + 1 of them."""
    angles = [from_rad + turn_rad * i / count for i in range(count + 1)]
    return [(centre_m[0] + radius_m * cos(a), centre_m[1] + radius_m * sin(a)) for a in angles]


def _spread(low: float, high: float, spacing_m: float) -> list[float]:
    """Evenly from one end to the other; one where they are the same place."""
    if high < low:
        return []
    gaps = ceil((high - low) / spacing_m - 1e-9)
    if gaps < 1:
        return [(low + high) / 2.0]
    return [low + (high - low) * i / gaps for i in range(gaps + 1)]


def _pieces(polygon_m: Sequence[Vec2], y: float, margin_m: float) -> list[tuple[float, float]]:
    """Where a level line is inside a polygon and `margin_m` from where it leaves it."""
    return [(a + margin_m, b - margin_m) for a, b in spans(polygon_m, y) if b - a >= 2.0 * margin_m]
