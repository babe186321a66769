"""Clamped B-splines: in the hull of their control points, at their ends, and their velocity is their derivative."""

from math import dist

import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.drone.spline import DEGREE, Spline, clamped_knots, through

coordinate = st.floats(-20.0, 20.0)
point = st.tuples(coordinate, coordinate, coordinate)
points = st.lists(point, min_size=2, max_size=12)
share = st.floats(0.0, 1.0)


@given(points)
def test_it_begins_and_ends_at_its_first_and_last_control_point(control):
    curve = Spline(control)
    assert dist(curve.at(0.0), control[0]) < 1e-9
    assert dist(curve.at(1.0), control[-1]) < 1e-9
    assert curve.at(-1.0) == curve.at(0.0)
    assert curve.at(2.0) == curve.at(1.0)


@given(points, share, point)
def test_it_stays_in_the_hull_of_its_control_points(control, u, direction):
    """In every direction no further out than the control point that is furthest out."""

    def out(p):
        return sum(a * b for a, b in zip(p, direction, strict=True))

    curve = Spline(control)
    slack = 1e-6
    assert min(map(out, control)) - slack <= out(curve.at(u)) <= max(map(out, control)) + slack
    spans = len(control) - min(DEGREE, len(control) - 1)
    first = min(int(u * spans), spans - 1)
    near = control[first : first + DEGREE + 1]
    assert min(map(out, near)) - slack <= out(curve.at(u)) <= max(map(out, near)) + slack


@given(points, st.floats(0.001, 0.999))
def test_its_velocity_is_its_derivative(control, u):
    curve, step = Spline(control), 1e-5
    for knot in clamped_knots(len(control), min(DEGREE, len(control) - 1)):
        if abs(knot - u) < 2.0 * step:
            u = knot + 3.0 * step  # across a knot the second derivative jumps
    before, after = curve.at(u - step), curve.at(u + step)
    measured = [(b - a) / (2.0 * step) for a, b in zip(before, after, strict=True)]
    assert dist(measured, curve.velocity(u)) < 1e-3 * (1.0 + dist(curve.velocity(u), (0, 0, 0)))


@given(st.lists(point, min_size=2, max_size=20))
def test_a_curve_through_points_goes_through_each_of_them(places):
    curve = through(places)
    degree = min(DEGREE, len(places) - 1)
    knots = clamped_knots(len(places), degree)
    for i, place in enumerate(places):
        u = sum(knots[i + 1 : i + degree + 1]) / degree
        assert dist(curve.at(u), place) < 1e-6


def test_one_point_is_no_curve():
    with pytest.raises(ValueError, match="two control points"):
        Spline([(0.0, 0.0, 0.0)])
