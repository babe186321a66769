"""Unit shapes as triangles, one metre across and centred, each in three degrees of roundness.

SHADOW is the top of a box: soft darkness below a thing that stands on the floor, only drawn where it can be soft.
"""

from functools import lru_cache
from itertools import pairwise
from math import pi

import numpy as np
from numpy.typing import NDArray

BOX, CYLINDER, SPHERE, CONE, TRIANGLE, SHADOW = range(6)
SHAPE_CODE = {"box": BOX, "cylinder": CYLINDER, "sphere": SPHERE, "cone": CONE}
SHAPES = 6
DETAILS = 3
SEGMENTS = (7, 12, 24)
"""Sides of a round shape, coarsest first."""

Vertices = NDArray[np.float32]
"""Rows of position (3), normal (3), uv (2), along_u (3), along_v (3): `along_u . size` metres of surface span u 0..1.

Both `along` are zero where the surface is mapped by its place on the floor plan.
"""


@lru_cache(maxsize=16)
def vertices(shape: int, detail: int) -> Vertices:
    """Triangles of a unit shape, counter-clockwise seen from outside."""
    if shape == BOX:
        rows = _box()
    elif shape == TRIANGLE:
        rows = _triangle()
    elif shape == SHADOW:
        rows = [row for row in _box() if row[5] > 0.0]
    else:
        rows = _turned(_profile(shape, SEGMENTS[detail]), SEGMENTS[detail])
    return np.asarray(rows, dtype=np.float32).reshape(-1, 14)


def _triangle() -> list[list[float]]:
    """Half of the unit square in its own corner; two edges are the instance's x and y axes."""
    return [[x, y, 0.0, 0.0, 0.0, 1.0, x, y, *[0.0] * 6] for x, y in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))]


def _box() -> list[list[float]]:
    """Pictures stand upright on the sides; on top and bottom their lower edge is at the front."""
    rows: list[list[float]] = []
    faces = (
        ((1, 0, 0), (0, 1, 0), (0, 0, -1)),
        ((-1, 0, 0), (0, -1, 0), (0, 0, -1)),
        ((0, 1, 0), (-1, 0, 0), (0, 0, -1)),
        ((0, -1, 0), (1, 0, 0), (0, 0, -1)),
        ((0, 0, 1), (0, 1, 0), (1, 0, 0)),
        ((0, 0, -1), (0, -1, 0), (1, 0, 0)),
    )
    for normal, right, down in (np.array(face, dtype=float) for face in faces):
        for u, v in ((0, 1), (1, 1), (1, 0), (0, 1), (1, 0), (0, 0)):
            position = 0.5 * normal + (u - 0.5) * right + (v - 0.5) * down
            rows.append([*position, *normal, u, v, *np.abs(right), *np.abs(down)])
    return rows


def _profile(shape: int, segments: int) -> list[tuple[float, float, float, float]]:
    """Half outline from top to bottom as edges' ends (radius, height, normal outwards, normal up)."""
    if shape == CYLINDER:
        top, side = [(0, 0.5, 0, 1), (0.5, 0.5, 0, 1)], [(0.5, 0.5, 1, 0), (0.5, -0.5, 1, 0)]
        return [*top, *side, (0.5, -0.5, 0, -1), (0, -0.5, 0, -1)]
    if shape == CONE:
        slope = (2 / 5**0.5, 1 / 5**0.5)
        return [(0, 0.5, *slope), (0.5, -0.5, *slope), (0.5, -0.5, 0, -1), (0, -0.5, 0, -1)]
    rings = max(segments // 2, 4)
    angles = np.linspace(0.0, pi, rings + 1)
    ends = [(float(np.sin(a)), float(np.cos(a))) for a in angles]
    return [(s / 2, c / 2, s, c) for a, b in pairwise(ends) for s, c in (a, b)]


def _turned(profile: list[tuple[float, float, float, float]], segments: int) -> list[list[float]]:
    """The outline turned about z."""
    turn = np.linspace(0.0, 2.0 * pi, segments + 1)
    rows: list[list[float]] = []
    for upper, lower in zip(profile[::2], profile[1::2], strict=True):
        for a, b in pairwise(turn):
            lower_a, lower_b, upper_a, upper_b = (_turn(end, angle) for end in (lower, upper) for angle in (a, b))
            if lower[0] > 1e-9:
                rows += [lower_a, lower_b, upper_b]
            if upper[0] > 1e-9:
                rows += [lower_a, upper_b, upper_a]
    return rows


def _turn(end: tuple[float, float, float, float], angle: float) -> list[float]:
    radius, height, out, up = end
    c, s = float(np.cos(angle)), float(np.sin(angle))
    position, normal = [radius * c, radius * s, height], [out * c, out * s, up]
    if out == 0.0:
        return [*position, *normal, radius * s + 0.5, radius * c + 0.5, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]
    return [*position, *normal, angle / (2.0 * pi), 0.5 - height, pi / 2.0, pi / 2.0, 0.0, 0.0, 0.0, 1.0]
