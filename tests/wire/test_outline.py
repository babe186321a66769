"""Outlines on the floor: distances to their pieces, their corners' mean, what lies inside."""

import pytest

from wire.outline import inside, mean_m, segment_distance_m, spans

L_SHAPE = ((0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (2.0, 2.0), (2.0, 5.0), (0.0, 5.0))


@pytest.mark.parametrize(
    ("point_m", "away_m"),
    [((2.0, 3.0), 3.0), ((-3.0, 4.0), 5.0), ((7.0, -4.0), 5.0), ((1.0, 0.0), 0.0), ((2.0, 3.0, 9.0), 3.0)],
    ids=["beside", "before its start", "behind its end", "on it", "whatever the height"],
)
def test_how_far_a_straight_piece_is(point_m, away_m) -> None:
    assert segment_distance_m(point_m, (0.0, 0.0), (4.0, 0.0)) == pytest.approx(away_m)


def test_a_piece_without_length_is_a_point() -> None:
    assert segment_distance_m((3.0, 4.0), (0.0, 0.0), (0.0, 0.0)) == 5.0


def test_a_bay_is_outside() -> None:
    assert inside((1.0, 4.0), L_SHAPE)
    assert not inside((4.0, 4.0), L_SHAPE)
    assert spans(L_SHAPE, 1.0) == [(0.0, 6.0)]
    assert spans(L_SHAPE, 3.0) == [(0.0, 2.0)]


def test_the_mean_of_corners() -> None:
    assert mean_m(((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0))) == (2.0, 1.0)
