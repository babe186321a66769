"""The autopilot's north, east and down in the site's axes: a test for each axis, and there and back."""

from math import dist, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.drone.frame import LocalFrame, frame_of
from tests.devices.drone.flat import flat

number = st.floats(-50.0, 50.0)
vector = st.tuples(number, number, number)
angle = st.floats(-3.1, 3.1)


def test_north_east_and_down():
    frame = LocalFrame()
    assert frame.point((1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0)), "north is the site's y"
    assert frame.point((0.0, 1.0, 0.0)) == pytest.approx((1.0, 0.0, 0.0)), "east is the site's x"
    assert frame.point((0.0, 0.0, -1.5)) == pytest.approx((0.0, 0.0, 1.5)), "down is against the site's z"
    assert frame.yaw_rad(0.0) == pytest.approx(pi / 2.0)
    assert frame.yaw_rad(90.0) == pytest.approx(0.0)
    assert frame.heading_deg(0.0) == pytest.approx(90.0)


def test_a_frame_whose_north_lies_along_the_sites_x():
    frame = frame_of(flat(origin_enu_m=(2.0, 3.0, 0.5), north_deg=0.0).robot[0])
    assert frame.point((1.0, 0.0, 0.0)) == pytest.approx((3.0, 3.0, 0.5))
    assert frame.point((0.0, 1.0, 0.0)) == pytest.approx((2.0, 2.0, 0.5))
    assert frame.vector((1.0, 0.0, 0.0)) == pytest.approx((1.0, 0.0, 0.0))
    assert frame.yaw_rad(0.0) == pytest.approx(0.0)
    assert frame.heading_deg(pi / 2.0) == pytest.approx(-90.0)


@given(vector, angle, vector)
def test_there_and_back(origin, north_rad, point):
    frame = LocalFrame(origin, north_rad)
    assert dist(frame.point(frame.local(point)), point) < 1e-6
    assert dist(frame.vector(frame.local_vector(point)), point) < 1e-6


@given(angle, angle)
def test_headings_there_and_back(north_rad, yaw_rad):
    frame = LocalFrame(north_rad=north_rad)
    assert frame.yaw_rad(frame.heading_deg(yaw_rad)) == pytest.approx(yaw_rad, abs=1e-9)
