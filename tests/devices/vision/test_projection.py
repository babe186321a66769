"""Projection: the inverse of what a camera does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.vision.detector import Detection
from devices.vision.lens import Lens
from devices.vision.projection import locate
from devices.vision.walls import before_walls
from wire.frames import project
from wire.site import Door, Wall

ANGLES = st.floats(-3.1, 3.1)


def lens(yaw_rad: float, tilt_rad: float, height_m: float = 2.3) -> Lens:
    return Lens(640, 480, 320.0, (1.0, -2.0, height_m), yaw_rad, tilt_rad)


def detection(u_px: float, v_px: float, height_m: float = 0.5, behind_m: float = 0.0, height_sd_m: float = 0.05):
    box = (u_px - 6.0, v_px - 6.0, u_px + 6.0, v_px + 6.0)
    return Detection("Mug", 0.9, u_px, v_px, box, height_m, height_sd_m, behind_m)


@given(yaw=ANGLES, tilt=st.floats(0.2, 0.9), u=st.floats(10, 630), v=st.floats(10, 470), z=st.floats(0.0, 1.5))
def test_plane_projection_inverts_the_camera(yaw: float, tilt: float, u: float, v: float, z: float) -> None:
    camera = lens(yaw, tilt)
    for sighting in locate([detection(u, v, z)], camera):
        x, y, height = sighting.position_enu_m
        assert height == pytest.approx(z, abs=1e-6)
        back = project((x, y, height), camera.position_enu_m, yaw, tilt, 640, 480, 320.0)
        assert back is not None
        assert back[:2] == pytest.approx((u, v), abs=1e-6)


@given(yaw=ANGLES, tilt=st.floats(0.0, 0.9), ahead=st.floats(0.8, 5.0), left=st.floats(-0.5, 0.5))
def test_depth_projection_finds_the_point(yaw: float, tilt: float, ahead: float, left: float) -> None:
    camera = lens(yaw, tilt, 1.3)
    right, down, forward = camera.axes
    point = np.array(camera.position_enu_m) + ahead * forward - left * right + 0.1 * down
    seen = project(tuple(point.tolist()), camera.position_enu_m, yaw, tilt, 640, 480, 320.0)
    assert seen is not None
    depth = np.full((480, 640), ahead - 0.05, dtype=np.float32)
    (sighting,) = locate([detection(seen[0], seen[1], behind_m=0.05)], camera, depth)
    assert sighting.position_enu_m == pytest.approx(tuple(point), abs=1e-4)


@given(yaw=ANGLES, tilt=st.floats(0.2, 0.8), u=st.floats(60, 580), v=st.floats(60, 420))
def test_pixels_inverts_rays(yaw: float, tilt: float, u: float, v: float) -> None:
    camera = lens(yaw, tilt)
    point = np.array(camera.position_enu_m) + 2.5 * camera.rays(u, v)[0]
    assert camera.pixels(point)[0] == pytest.approx((u, v, 2.5), abs=1e-6)


def test_an_uncertain_height_stretches_the_covariance_along_the_ray() -> None:
    (sighting,) = locate([detection(320, 240, 0.5, height_sd_m=0.2)], lens(0.0, 0.5))
    xx, _, yy, _ = sighting.covariance_m2
    assert xx > 10.0 * yy


def test_a_level_ray_has_no_place_on_a_plane() -> None:
    assert locate([detection(320, 0.0, 0.5)], lens(0.0, 0.3)) == []


def test_no_depth_measured_falls_back_to_the_plane() -> None:
    one = detection(320, 300, 0.5)
    (plane,) = locate([one], lens(0.0, 0.5))
    (blind,) = locate([one], lens(0.0, 0.5), np.zeros((480, 640), dtype=np.float32))
    assert blind.position_enu_m == plane.position_enu_m


def test_nothing_is_seen_behind_a_wall_but_through_a_door() -> None:
    camera = Lens(640, 480, 320.0, (0.0, 0.0, 2.3), 0.0, 0.5)
    (far,) = locate([detection(320, 200, 0.2)], camera)
    wall = Wall(start_m=(3.0, -2.0), end_m=(3.0, 2.0))
    door = Door(id="d", rooms=("a", "b"), start_m=(3.0, -0.5), end_m=(3.0, 0.5))
    assert far.position_enu_m[0] > 4.0
    (kept,) = before_walls([far], camera, (wall,), ())
    assert kept.position_enu_m[0] == pytest.approx(2.92)
    u, v, _ = camera.pixels(kept.position_enu_m)[0]
    assert (u, v) == pytest.approx((320, 200))
    assert before_walls([far], camera, (wall,), (door,)) == [far]
