"""Clamped cubic B-splines in space: they begin and end at their first and last control point, with the legs' direction.

A curve stays within the convex hull of its control points, of each four that follow each other at a time, and its
velocity has no jumps. Piegl and Tiller, The NURBS Book, algorithms A2.1, A3.1, A3.3 and A9.1.
"""

from bisect import bisect_right
from collections.abc import Sequence

from wire.model import Vec3

DEGREE = 3


class Spline:
    """Over u in [0, 1]. Fewer than four control points make a curve of a lower degree."""

    def __init__(self, control_m: Sequence[Vec3]) -> None:
        if len(control_m) < 2:
            raise ValueError("a curve needs two control points or more")
        self.control_m = tuple(control_m)
        self._degree = min(DEGREE, len(control_m) - 1)
        self._knots = clamped_knots(len(control_m), self._degree)
        p, t, c = self._degree, self._knots, self.control_m
        self._hodograph = tuple(
            _scaled(p / (t[i + p + 1] - t[i + 1]), _minus(c[i + 1], c[i])) for i in range(len(c) - 1)
        )

    def at(self, u: float) -> Vec3:
        return _de_boor(self.control_m, self._knots, self._degree, u)

    def velocity(self, u: float) -> Vec3:
        """The derivative by u."""
        return _de_boor(self._hodograph, self._knots[1:-1], self._degree - 1, u)


def through(points_m: Sequence[Vec3]) -> Spline:
    """The curve that goes through all the points, in their order, each at its control point's own parameter."""
    count = len(points_m)
    if count < 3:
        return Spline(points_m)
    degree = min(DEGREE, count - 1)
    knots = clamped_knots(count, degree)
    rows = [_weights(knots, degree, sum(knots[i + 1 : i + degree + 1]) / degree, count) for i in range(count)]
    return Spline(_solve(rows, points_m))


def clamped_knots(count: int, degree: int) -> tuple[float, ...]:
    """Of `count` control points: evenly spaced, the first and the last knot degree + 1 times."""
    spans = count - degree
    return (0.0,) * degree + tuple(i / spans for i in range(spans + 1)) + (1.0,) * degree


def _span(knots: Sequence[float], degree: int, u: float) -> int:
    return min(max(bisect_right(knots, u) - 1, degree), len(knots) - degree - 2)


def _de_boor(points: Sequence[Vec3], knots: Sequence[float], degree: int, u: float) -> Vec3:
    u = min(1.0, max(0.0, u))
    span = _span(knots, degree, u)
    near = [points[span - degree + j] for j in range(degree + 1)]
    for r in range(1, degree + 1):
        for j in range(degree, r - 1, -1):
            low, high = knots[span - degree + j], knots[span + 1 + j - r]
            share = (u - low) / (high - low)
            near[j] = _between(near[j - 1], near[j], share)
    return near[degree]


def _weights(knots: Sequence[float], degree: int, u: float, count: int) -> list[float]:
    """How much each control point counts at u."""
    span = _span(knots, degree, u)
    weights = [1.0]
    for r in range(1, degree + 1):
        following = [0.0] * (r + 1)
        for j, weight in enumerate(weights):
            low, high = knots[span - r + 1 + j], knots[span + 1 + j]
            share = (u - low) / (high - low)
            following[j] += (1.0 - share) * weight
            following[j + 1] += share * weight
        weights = following
    return [0.0] * (span - degree) + weights + [0.0] * (count - span - 1)


def _solve(rows: list[list[float]], right: Sequence[Vec3]) -> list[Vec3]:
    """Gauss without pivoting, which the weights of B-splines at these parameters allow (they are totally positive)."""
    count, known = len(rows), [list(point) for point in right]
    for i in range(count):
        for k in range(i + 1, min(count, i + DEGREE + 1)):
            factor = rows[k][i] / rows[i][i]
            if factor:
                rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i], strict=True)]
                known[k] = [a - factor * b for a, b in zip(known[k], known[i], strict=True)]
    for i in reversed(range(count)):
        for k in range(i + 1, count):
            known[i] = [a - rows[i][k] * b for a, b in zip(known[i], known[k], strict=True)]
        known[i] = [a / rows[i][i] for a in known[i]]
    return [(x, y, z) for x, y, z in known]


def _minus(a: Vec3, b: Vec3) -> Vec3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _scaled(factor: float, a: Vec3) -> Vec3:
    return (factor * a[0], factor * a[1], factor * a[2])


def _between(a: Vec3, b: Vec3, share: float) -> Vec3:
    return (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]))
