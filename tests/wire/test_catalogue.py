"""The catalogue agrees with itself."""

import pytest

from wire.catalogue import PROP_FLAG, PROPS, ObjectType, catalogue, modelled_types

ROWS = list(catalogue().values())


def test_what_can_appear_in_pictures() -> None:
    assert len(modelled_types()) == 51
    assert list(modelled_types()) == sorted(modelled_types())
    assert set(PROPS) == set(PROP_FLAG)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_row(row: ObjectType) -> None:
    sizes = zip(row.size_p10_m, row.size_m, row.size_p90_m, strict=True)
    assert all(0.0 < low <= middle <= high < 5.0 for low, middle, high in sizes)
    assert {*row.allowed_in, *row.holds} <= {*catalogue(), "Floor"}
    assert all(0.0 <= share <= 1.0 for share in row.holds.values())
    assert all(weight >= 0.0 for weight in row.room_weights.values())
    if row.must_open:
        assert row.receptacle_mode == "enclosed"
        assert row.can("openable")


def test_every_property_belongs_to_something_that_is_seen() -> None:
    for flag in PROP_FLAG.values():
        assert any(row.modelled and row.can(flag) for row in ROWS), flag


def test_everything_carried_can_rest_somewhere() -> None:
    for row in ROWS:
        if row.modelled and row.kind == "pickup":
            assert any(catalogue()[name].modelled for name in row.allowed_in), row.name
