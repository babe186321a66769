"""Rectangles and circles that drones go around: distances against brute force, and how a thing stands by its wall."""

from itertools import pairwise
from math import cos, dist, hypot, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from devices.drone.airspace import NEEDED_M, Airspace, Obstacle
from devices.drone.outlines import Outline, outline_of
from sim.generator.home import make_home
from tests.devices.drone.flat import flat
from tests.devices.drone.test_route import find_way
from wire.site import Wall

METRES = st.floats(-3.0, 3.0)
POINTS = st.tuples(METRES, METRES)
SIDES = st.tuples(st.floats(0.05, 1.5), st.floats(0.05, 1.5))
OUTLINES = st.builds(Outline, POINTS, st.sampled_from([0.0, 0.3]), SIDES, st.floats(-pi, pi))


def placed(outline: Outline, x: float, y: float) -> tuple[float, float]:
    """A point of its own axes, in the room's."""
    c, s = cos(outline.yaw_rad), sin(outline.yaw_rad)
    return (outline.middle_m[0] + c * x - s * y, outline.middle_m[1] + s * x + c * y)


def edge(outline: Outline, count: int = 60) -> list[tuple[float, float]]:
    hx, hy = outline.half_m
    shares = [-1.0 + 2.0 * k / count for k in range(count + 1)]
    sides = [(s * hx, t * hy) for s in shares for t in (-1.0, 1.0)] + [
        (t * hx, s * hy) for s in shares for t in (-1, 1)
    ]
    return [placed(outline, x, y) for x, y in sides]


@given(outline=OUTLINES, point=POINTS)
def test_the_distance_is_that_to_the_nearest_point_of_the_edge(outline: Outline, point: tuple[float, float]) -> None:
    nearest = min(dist(point, at) for at in edge(outline)) - outline.radius_m
    if outline.distance_m(point) > 0.0:
        assert outline.distance_m(point) == pytest.approx(nearest, abs=0.03)
    else:
        assert dist(point, outline.middle_m) <= outline.reach_m + 1e-9


@given(outline=OUTLINES, a=POINTS, b=POINTS)
def test_a_way_is_as_near_as_its_nearest_point(
    outline: Outline, a: tuple[float, float], b: tuple[float, float]
) -> None:
    points = [(a[0] + k / 200 * (b[0] - a[0]), a[1] + k / 200 * (b[1] - a[1])) for k in range(201)]
    nearest = min(outline.distance_m(point) for point in points)
    assert outline.way_distance_m(a, b) <= nearest + 1e-9
    assert outline.way_distance_m(a, b) >= nearest - dist(a, b) / 200


@settings(max_examples=25, deadline=None)
@given(
    middle=st.tuples(st.floats(1.6, 2.4), st.floats(1.4, 2.6)),
    half=st.tuples(st.floats(0.1, 0.9), st.floats(0.1, 0.4)),
    yaw_rad=st.floats(-pi, pi),
)
def test_no_way_comes_nearer_than_it_may(middle, half, yaw_rad) -> None:
    space, outline = Airspace(flat()), Outline(middle, 0.0, half, yaw_rad)
    space.obstacles = {"shelf-1": Obstacle(outline, 1.9)}
    start, goal = (0.7, 2.0, 1.5), (3.3, 2.0, 1.5)
    if min(outline.distance_m(start[:2]), outline.distance_m(goal[:2])) < NEEDED_M + 0.3:
        return
    way = find_way(space, start, goal, 1.5)
    for a, b in pairwise(way or []):
        assert outline.way_distance_m(a[:2], b[:2]) > NEEDED_M - 0.08, "squares are 0.1 m wide"


@pytest.mark.parametrize("seed", range(8))
def test_what_is_taken_to_stand_along_its_wall_does_so(seed: int) -> None:
    """In generated homes: the rectangle covers what is there; and most of what is long is known so."""
    scene = make_home(seed)
    walls = [Wall(start_m=wall.start_m, end_m=wall.end_m, thickness_m=wall.thickness_m) for wall in scene.walls]
    known = long = 0
    for body in scene.bodies.values():
        depth, width, height = body.size_m
        if body.position_m[2] > 0.05 or height < 0.4 or abs(depth - width) < 0.3:
            continue
        outline = outline_of(body.position_m[:2], (depth, width), 0.05, walls)
        long += 1
        if not any(outline.half_m):
            continue
        known += 1
        c, s = cos(body.yaw_rad), sin(body.yaw_rad)
        for x, y in ((x * depth / 2, y * width / 2) for x in (-1, 1) for y in (-1, 1)):
            corner = (body.position_m[0] + c * x - s * y, body.position_m[1] + s * x + c * y)
            assert outline.distance_m(corner) < 0.1, (body.type, body.position_m)
    assert long == 0 or known >= long / 2, (known, long)


@given(st.floats(0.0, 2.0 * pi), st.floats(-0.1, 0.15), st.floats(0.05, 0.5))
def test_a_sofa_along_any_wall_and_one_in_the_middle(turned: float, off: float, unsure: float) -> None:
    """Walls in any direction; what stands free or is not well known stays a circle."""
    along, across = (cos(turned), sin(turned)), (-sin(turned), cos(turned))
    wall = Wall(start_m=(-3 * along[0], -3 * along[1]), end_m=(3 * along[0], 3 * along[1]))
    away = 0.45 + 0.05 + off
    sofa = outline_of((away * across[0], away * across[1]), (0.9, 2.0), 0.04, (wall,))
    assert sofa.half_m == (1.0, 0.45)
    front = (1.1 * across[0], 1.1 * across[1])
    assert sofa.distance_m(front) == pytest.approx(1.1 - away - 0.45, abs=1e-6)
    free = outline_of((1.2 * across[0], 1.2 * across[1]), (0.9, 2.0), 0.04, (wall,))
    assert (free.half_m, free.radius_m) == ((0.0, 0.0), 1.0)
    if off + unsure > 0.2 + 1e-9:
        unknown = outline_of((away * across[0], away * across[1]), (0.9, 2.0), unsure, (wall,))
        assert unknown.half_m == (0.0, 0.0)
    beyond = outline_of((4 * along[0] + away * across[0], 4 * along[1] + away * across[1]), (0.9, 2.0), 0.0, (wall,))
    assert hypot(*beyond.half_m) == 0.0, "past the wall's end"
