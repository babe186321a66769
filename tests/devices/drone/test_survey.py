"""The sweep covers what it is asked to cover, and stays off the edges."""

from itertools import pairwise
from math import dist, hypot, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.drone.survey import ring, sweep

ROOM = ((0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0))
L_ROOM = ((0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (2.0, 2.0), (2.0, 5.0), (0.0, 5.0))
side = st.floats(1.5, 12.0)


@given(side, side, st.floats(0.3, 3.0), st.floats(0.1, 0.7))
def test_no_place_of_a_rectangle_is_far_from_a_station(width, depth, spacing, margin):
    stations = list(sweep(((0.0, 0.0), (width, 0.0), (width, depth), (0.0, depth)), spacing, margin))
    for x, y in stations:
        assert margin - 1e-6 <= x <= width - margin + 1e-6
        assert margin - 1e-6 <= y <= depth - margin + 1e-6
    reach = hypot(max(spacing / 2.0, margin), max(spacing / 2.0, margin)) + spacing / 2.0
    for i in range(7):
        for j in range(7):
            assert min(dist((width * i / 6, depth * j / 6), station) for station in stations) <= reach


def test_lanes_run_to_and_fro_along_the_longer_side():
    stations = list(sweep(ROOM, 1.0, 0.5))
    assert stations[0] == (0.5, 0.5)
    assert [y for _, y in stations] == sorted(y for _, y in stations)
    assert all(dist(a, b) <= 1.0 + 1e-9 for a, b in pairwise(stations)), "from one station to the next is one step"
    turned = list(sweep([(y, x) for x, y in ROOM], 1.0, 0.5))
    assert turned == [(y, x) for x, y in stations]


def test_bays_are_kept_out_of_what_is_no_room():
    stations = list(sweep(L_ROOM, 0.8, 0.4))
    assert any(y > 3.0 for _, y in stations)
    assert any(x > 5.0 for x, _ in stations)
    assert not any(x > 2.0 and y > 2.0 for x, y in stations)


def test_nothing_is_surveyed_where_there_is_no_room():
    assert list(sweep(((0.0, 0.0), (0.5, 0.0), (0.5, 3.0), (0.0, 3.0)), 1.0, 0.4)) == []
    with pytest.raises(ValueError, match="above 0"):
        list(sweep(ROOM, 0.0, 0.4))


def test_a_ring_goes_around():
    around = ring((1.0, 1.0), 2.0, 0.0, 2.0 * pi, 16)
    assert len(around) == 17
    assert around[0] == (3.0, 1.0)
    assert dist(around[0], around[-1]) < 1e-9
    assert all(abs(dist(p, (1.0, 1.0)) - 2.0) < 1e-9 for p in around)
