"""Upright boxes: distances, overlaps, and rays past them."""

from math import dist, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.boxes import Box, boxes_overlap, footprints_overlap, structure_boxes
from sim.sight import Obstacles
from tests.sim.small_home import make_small_home

coordinates = st.floats(-3.0, 3.0)
points = st.tuples(coordinates, coordinates, coordinates)
halves = st.floats(0.05, 1.5)
boxes = st.builds(Box, points, st.tuples(halves, halves, halves), st.floats(-pi, pi))


@given(boxes, points)
def test_the_nearest_point_is_in_the_box_and_as_far_as_the_gap(box, point):
    nearest = box.nearest_point(point)
    assert all(abs(v) <= h + 1e-9 for v, h in zip(box.local(nearest), box.half_m, strict=True))
    assert dist(point, nearest) == pytest.approx(box.gap_m(point), abs=1e-9)
    assert box.floor_gap_m(point) <= box.gap_m(point) + 1e-9


@given(boxes, points)
def test_local_and_site_frames_are_inverse(box, point):
    assert box.site(box.local(point)) == pytest.approx(point, abs=1e-9)


@given(boxes, boxes)
def test_overlap_is_mutual_and_found_when_a_point_is_shared(a, b):
    assert footprints_overlap(a, b) == footprints_overlap(b, a)
    assert boxes_overlap(a, b) == boxes_overlap(b, a)
    middle = a.nearest_point(b.centre_m)
    if all(abs(v) < h - 1e-6 for v, h in zip(b.local(middle), b.half_m, strict=True)):
        assert boxes_overlap(a, b) or b.centre_m == middle


@given(boxes, points, points)
def test_a_ray_is_free_exactly_when_no_point_of_it_lies_in_the_box(box, eye, end):
    free = Obstacles([1], [box]).any_ray_free(eye, [end], ())
    along = [tuple(e + k / 400.0 * (t - e) for e, t in zip(eye, end, strict=True)) for k in range(400)]
    depth = [min(h - abs(v) for v, h in zip(box.local(p), box.half_m, strict=True)) for p in along]
    if max(depth) > 0.02:
        assert not free
    if max(depth) < -0.02:
        assert free


def test_what_is_ignored_hides_nothing():
    box = Box((1.0, 0.0, 0.0), (0.1, 0.5, 0.5), 0.0)
    around = Obstacles([7], [box])
    assert not around.any_ray_free((0.0, 0.0, 0.0), [(2.0, 0.0, 0.0)], ())
    assert around.any_ray_free((0.0, 0.0, 0.0), [(2.0, 0.0, 0.0)], (7,))
    assert around.any_ray_free((0.0, 0.0, 0.0), [(2.0, 0.0, 0.0), (2.0, 2.0, 0.0)], ())


def test_a_doorway_is_open_below_its_lintel():
    structure = structure_boxes(make_small_home())
    in_doorway = [box for box in structure if box.gap_m((5.0, 2.5, 1.0)) == 0.0]
    above = [box for box in structure if box.gap_m((5.0, 2.5, 2.3)) == 0.0]
    assert not in_doorway
    assert len(above) == 1
