"""Paths as polylines: how near, how far along. The geometry under the traffic rules."""

from collections.abc import Sequence
from itertools import pairwise
from math import hypot

from wire.model import Vec2
from wire.outline import segment_distance_m


def cut(path_m: Sequence[Vec2], length_m: float) -> list[Vec2]:
    """The first `length_m` of a polyline."""
    result = [path_m[0]]
    left = length_m
    for a, b in pairwise(path_m):
        step = hypot(b[0] - a[0], b[1] - a[1])
        if step >= left:
            share = left / step if step else 0.0
            result.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
            return result
        result.append(b)
        left -= step
    return result


def point_to_path_m(point_m: Vec2, path_m: Sequence[Vec2]) -> float:
    """Distance from a point to the nearest piece of a polyline."""
    if len(path_m) == 1:
        return hypot(point_m[0] - path_m[0][0], point_m[1] - path_m[0][1])
    return min(segment_distance_m(point_m, a, b) for a, b in pairwise(path_m))


def path_to_path_m(a: Sequence[Vec2], b: Sequence[Vec2]) -> float:
    """Distance between two polylines."""
    if _cross(a, b):
        return 0.0
    return min(min(point_to_path_m(p, b) for p in a), min(point_to_path_m(p, a) for p in b))


def _cross(a: Sequence[Vec2], b: Sequence[Vec2]) -> bool:
    return any(
        _turns(p, q, r) * _turns(p, q, s) < 0 and _turns(r, s, p) * _turns(r, s, q) < 0
        for p, q in pairwise(a)
        for r, s in pairwise(b)
    )


def _turns(a: Vec2, b: Vec2, c: Vec2) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
