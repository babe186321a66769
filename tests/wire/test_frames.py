"""A test per axis: where east, north, up, forward, left and down end up."""

from math import cos, pi, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wire import frames

EAST, NORTH, UP = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
FORWARD, LEFT = EAST, NORTH
ORIGIN = (0.0, 0.0, 0.0)
angles = st.floats(-20.0, 20.0)
metres = st.floats(-100.0, 100.0)
points = st.tuples(metres, metres, metres)


def near(point: object) -> object:
    return pytest.approx(point, abs=1e-6)


@pytest.mark.parametrize(("enu", "ned"), [(EAST, (0, 1, 0)), (NORTH, (1, 0, 0)), (UP, (0, 0, -1))])
def test_each_axis_of_ned(enu: frames.Vec3, ned: frames.Vec3) -> None:
    assert frames.enu_to_ned(enu) == ned
    assert frames.ned_to_enu(ned) == enu


@pytest.mark.parametrize(("yaw_deg", "heading_deg"), [(0, 90), (90, 0), (180, -90), (-90, -180), (45, 45)])
def test_yaw_from_east_and_heading_from_north(yaw_deg: float, heading_deg: float) -> None:
    assert frames.yaw_to_heading_rad(radians(yaw_deg)) == near(radians(heading_deg))
    assert frames.heading_to_yaw_rad(radians(heading_deg)) == near(frames.wrap_rad(radians(yaw_deg)))


@pytest.mark.parametrize(
    ("body", "yaw_rad", "enu"),
    [
        (FORWARD, 0.0, EAST),
        (LEFT, 0.0, NORTH),
        (UP, 0.0, UP),
        (FORWARD, pi / 2, NORTH),
        (LEFT, pi / 2, (-1.0, 0.0, 0.0)),
        (UP, 1.0, UP),
    ],
)
def test_each_axis_of_the_body(body: frames.Vec3, yaw_rad: float, enu: frames.Vec3) -> None:
    assert frames.body_to_enu(body, ORIGIN, yaw_rad) == near(enu)


@pytest.mark.parametrize("yaw_rad", [0.0, 1.0, pi / 2, -2.5])
def test_each_axis_of_a_level_camera(yaw_rad: float) -> None:
    right, down, forward = frames.camera_axes(yaw_rad, 0.0)
    assert forward == near((cos(yaw_rad), sin(yaw_rad), 0.0))
    assert right == near((sin(yaw_rad), -cos(yaw_rad), 0.0))
    assert down == near((0.0, 0.0, -1.0))


def test_tilt_is_downwards() -> None:
    right, down, forward = frames.camera_axes(0.0, pi / 2)
    assert (right, down, forward) == (near((0, -1, 0)), near((-1, 0, 0)), near((0, 0, -1)))


@pytest.mark.parametrize(
    ("point", "pixel"),
    [
        ((10.0, 0.0, 2.0), (320.0, 240.0)),  # straight ahead: the centre
        ((10.0, -5.0, 2.0), (480.0, 240.0)),  # south of a camera that looks east is to its right: larger u
        ((10.0, 0.0, 1.0), (320.0, 272.0)),  # below: larger v
    ],
)
def test_each_axis_of_the_picture(point: frames.Vec3, pixel: tuple[float, float]) -> None:
    seen = frames.project(point, (0.0, 0.0, 2.0), 0.0, 0.0, 640, 480, 320.0)
    assert seen == near((*pixel, 10.0))


def test_what_is_behind_is_not_seen() -> None:
    assert frames.project((-1.0, 0.0, 2.0), (0.0, 0.0, 2.0), 0.0, 0.0, 640, 480, 320.0) is None


@given(points, points, angles)
def test_body_and_back(point: frames.Vec3, origin: frames.Vec3, yaw_rad: float) -> None:
    there = frames.body_to_enu(point, origin, yaw_rad)
    assert frames.enu_to_body(there, origin, yaw_rad) == near(point)


@given(points)
def test_ned_and_back(point: frames.Vec3) -> None:
    assert frames.ned_to_enu(frames.enu_to_ned(point)) == point


@given(angles)
def test_wrap_and_degrees_stay_in_their_ranges(angle_rad: float) -> None:
    assert -pi <= frames.wrap_rad(angle_rad) < pi
    assert 0.0 <= frames.yaw_deg(angle_rad) < 360.0
    assert cos(radians(frames.yaw_deg(angle_rad))) == near(cos(angle_rad))
    back_rad = frames.heading_to_yaw_rad(frames.yaw_to_heading_rad(angle_rad))
    assert (cos(back_rad), sin(back_rad)) == near((cos(angle_rad), sin(angle_rad)))


@given(st.floats(0, 640), st.floats(0, 480), angles, st.floats(-1.5, 1.5), st.floats(0.1, 50))
def test_a_pixels_ray_projects_back_to_it(u: float, v: float, yaw_rad: float, tilt_rad: float, depth_m: float) -> None:
    ray = frames.pixel_ray(u, v, 640, 480, 320.0, yaw_rad, tilt_rad)
    point = tuple(1.0 + depth_m * part for part in ray)
    seen = frames.project(point, (1.0, 1.0, 1.0), yaw_rad, tilt_rad, 640, 480, 320.0)  # type: ignore[arg-type]
    assert seen == pytest.approx((u, v, depth_m), abs=1e-4)


@pytest.mark.parametrize(("target", "yaw_rad"), [((1.0, 0.0), 0.0), ((0.0, 2.0), pi / 2), ((-1.0, -1.0), -3 * pi / 4)])
def test_bearing(target: frames.Vec2, yaw_rad: float) -> None:
    assert frames.bearing_rad((0.0, 0.0), target) == near(yaw_rad)
    assert frames.distance_m((0.0, 0.0, 5.0), (3.0, 4.0, 1.0)) == 5.0
