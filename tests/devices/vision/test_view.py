"""The floor that a camera is said to watch."""

from math import atan2, hypot, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.vision.lens import Lens
from devices.vision.view import floor_view
from wire.site import Door, Wall

WALL = Wall(start_m=(3.0, -4.0), end_m=(3.0, 4.0))


def area_m2(polygon) -> float:
    pairs = zip(polygon, polygon[1:] + polygon[:1], strict=True)
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs)) / 2.0


@given(yaw=st.floats(-3.0, 3.0), tilt=st.floats(0.4, 0.7))
def test_every_corner_is_in_the_picture(yaw: float, tilt: float) -> None:
    lens = Lens(640, 480, 320.0, (0.0, 0.0, 2.3), yaw, tilt)
    view = floor_view(lens, ())
    assert 4 <= len(view.polygon_m) <= 64
    for x, y in view.polygon_m:
        u, v, depth_m = lens.pixels((x, y, 0.0))[0]
        assert depth_m > 0.0
        assert -1.0 <= u <= 641.0
        assert -1.0 <= v <= 481.0
        assert hypot(x, y) <= view.range_m + 1e-6


def test_a_wall_ends_the_view() -> None:
    view = floor_view(Lens(640, 480, 320.0, (0.0, 0.0, 2.3), 0.0, 0.5), (WALL,))
    assert max(x for x, _ in view.polygon_m) == pytest.approx(3.0, abs=1e-6)


def test_a_door_lets_the_view_through() -> None:
    door = Door(id="d", rooms=("a", "b"), start_m=(3.0, -0.5), end_m=(3.0, 0.5))
    view = floor_view(Lens(640, 480, 320.0, (0.0, 0.0, 2.3), 0.0, 0.5), (WALL,), (door,))
    beyond = [(x, y) for x, y in view.polygon_m if x > 3.01]
    assert beyond
    assert all(abs(atan2(y, x)) <= atan2(0.5, 3.0) + 1e-6 for x, y in beyond)


def test_looking_up_shows_no_floor() -> None:
    assert floor_view(Lens(640, 480, 320.0, (0.0, 0.0, 2.3), 0.0, -1.0), ()).polygon_m == ()


def test_the_polygon_has_the_area_of_the_visible_floor() -> None:
    lens = Lens(640, 480, 320.0, (0.0, 0.0, 2.3), pi / 4, 0.6)
    view = floor_view(lens, ())
    points = np.random.default_rng(1).uniform(-6.0, 6.0, (20000, 2))
    u, v, depth_m = lens.pixels(np.c_[points, np.zeros(len(points))]).T
    visible = (depth_m > 0.0) & (u > 0) & (u < 640) & (v > 0) & (v < 480) & (np.hypot(*points.T) < view.range_m)
    assert area_m2(view.polygon_m) == pytest.approx(144.0 * visible.mean(), rel=0.05)
