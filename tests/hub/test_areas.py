"""What has been looked at."""

from hub.areas import Areas
from tests.hub.scenes import batch, flat, view
from wire.messages.observation import View


def _all(source: str, stamp_s: float = 1.0):
    whole = View(
        origin_enu_m=(0.0, 0.0, 2.0),
        polygon_m=((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)),
        yaw_rad=0.0,
        hfov_rad=1.6,
        range_m=6.0,
    )
    return batch(source, stamp_s, view=whole)


def test_half_of_a_room() -> None:
    areas = Areas(flat().room)
    areas.take(batch("cam-1", 1.0, view=view(0.0, 2.0, 1.0)))
    kitchen = areas.states()[0]
    assert abs(kitchen.seen_fraction - 0.25) < 0.02
    assert kitchen.camera_fraction == kitchen.seen_fraction
    assert not kitchen.searched


def test_a_robot_that_saw_all_has_searched_and_a_camera_has_not() -> None:
    areas = Areas(flat().room)
    areas.take(_all("cam-1"))
    assert areas.states()[0].seen_fraction == 1.0
    assert not areas.states()[0].searched
    areas.take(_all("dog-1"))
    assert areas.states()[0].searched
    assert not areas.states()[1].searched


def test_searches_count_from_the_beginning_of_the_task() -> None:
    areas = Areas(flat().room)
    areas.take(_all("dog-1"))
    areas.begin_task()
    assert not areas.states()[0].searched
    areas.search_done("kitchen", "dog-1", 5.0)
    assert areas.states()[0].searched


def test_only_changes_are_told() -> None:
    areas = Areas(flat().room)
    assert len(areas.changes()) == 3
    areas.take(_all("cam-1"))
    assert [a.id for a in areas.changes()] == ["kitchen"]
    areas.take(_all("cam-1", 1.5))
    assert areas.changes() == ()
