"""GridMask: cells to pixels to metres and back, for any camera; and what is drawn."""

from math import atan, isclose, pi, radians, tan

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from devices.vision.gridmask import (
    AXIS,
    LEAST_CELL_PX,
    MOST,
    Grid,
    cell_m,
    cells_of,
    draw,
    flat_place_m,
    fov_rad,
    grid_for,
    ground_width_m,
    place_m,
)
from devices.vision.lens import Lens

DOWN = pi / 2.0
FOV_RAD = 1.2
PAPER = Lens(640, 480, 320.0 / tan(FOV_RAD / 2.0), (0.0, 0.0, 2.5), pi / 2.0, DOWN)
lenses = st.builds(
    Lens,
    width_px=st.sampled_from((160, 320, 640, 644, 1280, 1920)),
    height_px=st.sampled_from((120, 240, 476, 480, 960, 1080)),
    focal_px=st.floats(150.0, 1500.0),
    position_enu_m=st.tuples(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0), st.floats(0.6, 30.0)),
    yaw_rad=st.floats(-pi, pi),
    tilt_down_rad=st.floats(radians(20.0), radians(90.0)),
)
inside = st.floats(-0.99, 0.99)


def test_the_papers_figures() -> None:
    grid = grid_for(PAPER)
    assert (grid.cell_px, grid.divisions) == (80.0, 8.0)
    assert (list(grid.columns()), list(grid.rows())) == ([-4, -3, -2, -1, 0, 1, 2, 3], [-2, -1, 0, 1, 2, 3])
    assert ground_width_m(2.5, FOV_RAD) == pytest.approx(3.42, abs=0.005)
    assert cell_m(2.5, FOV_RAD, 8.0) == pytest.approx(0.4276, abs=0.001)


@given(lenses)
def test_lines_are_those_of_equation_1_and_no_others(lens: Lens) -> None:
    grid = grid_for(lens)
    for numbers, size_px, at in (
        (grid.columns(), lens.width_px, lambda i: grid.pixel(i, 0)[0]),
        (grid.rows(), lens.height_px, lambda j: grid.pixel(0, j)[1]),
    ):
        assert all(-1e-6 <= at(n) < size_px - 1e-6 or isclose(at(n), 0.0, abs_tol=1e-6) for n in numbers)
        beyond = (numbers[0] - 1, numbers[-1] + 1)
        assert not any(1e-6 < at(n) < size_px - 1e-6 for n in beyond)


@given(lenses, inside, inside)
def test_cells_to_pixels_and_back(lens: Lens, x: float, y: float) -> None:
    grid = grid_for(lens)
    at = (x * grid.half_width, y * grid.half_height)
    assert grid.contains(*at)
    assert grid.cells(*grid.pixel(*at)) == pytest.approx(at, abs=1e-9)


@given(lenses, inside, inside, st.floats(0.0, 0.5))
def test_cells_to_the_site_and_back(lens: Lens, x: float, y: float, height_m: float) -> None:
    grid = grid_for(lens)
    at = (x * grid.half_width, y * grid.half_height)
    place = place_m(grid, lens, *at, height_m)
    assume(place is not None)
    assert place is not None
    assert place[2] == pytest.approx(height_m, abs=1e-6 * max(1.0, *map(abs, place)))
    assert cells_of(grid, lens, place) == pytest.approx(at, abs=1e-5)


@given(lenses, inside, inside)
def test_for_a_level_camera_and_flat_things_the_correction_is_none(lens: Lens, x: float, y: float) -> None:
    grid = grid_for(lens)
    level = Lens(lens.width_px, lens.height_px, lens.focal_px, lens.position_enu_m, lens.yaw_rad, DOWN)
    at = (x * grid.half_width, y * grid.half_height)
    place = place_m(grid, level, *at)
    assert place is not None
    assert place[:2] == pytest.approx(flat_place_m(grid, level, *at), abs=1e-6 * (1.0 + lens.position_enu_m[2]))


def test_a_tilt_of_two_degrees_costs_nine_centimetres_without_the_correction() -> None:
    tilted = Lens(640, 480, PAPER.focal_px, PAPER.position_enu_m, PAPER.yaw_rad, DOWN - radians(2.0))
    at = cells_of(grid_for(tilted), tilted, (0.3, 0.2, 0.0))
    assert at is not None
    corrected = place_m(grid_for(tilted), tilted, *at)
    assert corrected == pytest.approx((0.3, 0.2, 0.0), abs=1e-9)
    flat = flat_place_m(grid_for(tilted), tilted, *at)
    assert 0.07 < np.hypot(flat[0] - 0.3, flat[1] - 0.2) < 0.11


def test_height_is_taken_out() -> None:
    top = (0.9, 0.6, 0.25)
    at = cells_of(grid_for(PAPER), PAPER, top)
    assert at is not None
    assert place_m(grid_for(PAPER), PAPER, *at, 0.25) == pytest.approx(top, abs=1e-9)
    flat = flat_place_m(grid_for(PAPER), PAPER, *at)
    assert np.hypot(flat[0] - 0.9, flat[1] - 0.6) > 0.1


@given(lenses)
def test_the_grid_adapts_within_its_bounds(lens: Lens) -> None:
    grid = grid_for(lens)
    assert 4 <= grid.divisions <= MOST
    assert grid.cell_px >= LEAST_CELL_PX or grid.divisions == 4


@pytest.mark.parametrize(("height_m", "divisions"), [(0.8, 4), (2.5, 8), (5.0, 8), (9.0, 16), (25.0, 16)])
def test_who_flies_higher_gets_a_denser_grid(height_m: float, divisions: int) -> None:
    lens = Lens(640, 480, 320.0 / tan(FOV_RAD / 2.0), (0.0, 0.0, height_m), 0.0, DOWN)
    assert grid_for(lens).divisions == divisions


def test_a_wider_field_of_view_needs_more_cells_for_the_same_metres() -> None:
    narrow = Lens(640, 480, 900.0, (0.0, 0.0, 6.0), 0.0, DOWN)
    wide = Lens(640, 480, 250.0, (0.0, 0.0, 6.0), 0.0, DOWN)
    assert grid_for(wide).divisions > grid_for(narrow).divisions
    assert fov_rad(wide) == pytest.approx(2.0 * atan(320.0 / 250.0))


def test_what_is_drawn_is_where_the_equations_say() -> None:
    picture = np.full((480, 640, 3), 90, np.uint8)
    drawn = draw(picture, Grid(640, 480, 80.0))
    assert (picture == 90).all(), "the picture itself is left alone"
    assert tuple(drawn[50, 320]) == AXIS
    assert tuple(drawn[240, 50]) == AXIS
    changed = (drawn != 90).any(axis=2)
    assert changed[:, 80].all()
    assert changed[160, :].all()
    assert changed.mean() < 0.25
    assert not changed[70, 110:150].any(), "between lines and labels the picture shows"
