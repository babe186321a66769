"""A vision model beside the detector: the same thing becomes surer and stays one, and each eye misses only its own."""

import json

import pytest

from devices.vision.gridmask import cells_of, grid_for
from devices.vision.look import Seen
from devices.vision.model_eyes import seen_by_model
from devices.vision.prompt import room_duty
from devices.vision.reply import read
from devices.vision.tracking import Tracked, Tracker

from .sightings import LENS, seen, sighting

APPLE, MUG, SOFA = ("Apple", 3.0, 0.5, 0.8), ("Mug", 3.0, -0.7, 0.8), ("Sofa", 4.2, 0.0, 0.4)
Place = tuple[str, float, float, float]


def model(
    stamp_s: float, *things: Place, slip_cells: tuple[float, float] = (0.0, 0.0), state: str | None = None
) -> Seen:
    """What a model says of these things, wrong by so many cells, through the whole of its reply."""
    grid = grid_for(LENS)
    objects = []
    for name, x, y, z in things:
        at = cells_of(grid, LENS, (x, y, z))
        assert at is not None
        objects.append({"name": name, "x": at[0] + slip_cells[0], "y": at[1] + slip_cells[1], "state": state})
    report = read(json.dumps({"objects": objects, "events": [], "texts": []}), room_duty(), grid)
    assert report.doubts == ()
    return seen_by_model(report, LENS, stamp_s)


def watched(*things: Place, sure: float = 0.5, pictures: int = 4) -> Tracker:
    tracker = Tracker()
    for i in range(pictures):
        tracker.update(seen(0.5 * i, *(sighting(t, sure=sure) for t in things)))
    return tracker


def names(tracked: Tracked) -> list[str]:
    return [o.type for o in tracked.objects]


@pytest.mark.parametrize("slip", [(0.0, 0.0), (0.4, -0.3), (-0.9, 0.8)])
def test_the_same_thing_becomes_surer_and_stays_one_where_it_is(slip: tuple[float, float]) -> None:
    tracker = watched(APPLE, MUG)
    before = tracker.update(seen(2.0, sighting(APPLE, sure=0.5), sighting(MUG, sure=0.5)))
    told = tracker.take_opinion(model(1.5, APPLE, MUG, slip_cells=slip))
    assert told.objects == ()
    assert len(tracker.tracks) == 2
    after = tracker.update(seen(2.5, sighting(APPLE, sure=0.5), sighting(MUG, sure=0.5)))
    for old, new in zip(before.objects, after.objects, strict=True):
        assert (new.track, new.type) == (old.track, old.type)
        assert new.confidence > old.confidence + 0.05
        assert new.position_enu_m == pytest.approx(old.position_enu_m, abs=1e-6)


def test_the_model_can_settle_what_it_is() -> None:
    tracker = watched(("Tomato", *APPLE[1:]), sure=0.3)
    for _ in range(3):
        tracker.take_opinion(model(2.0, APPLE))
    after = tracker.update(seen(2.5, sighting(("Tomato", *APPLE[1:]), sure=0.3)))
    assert names(after) == ["Apple"]
    assert len(tracker.tracks) == 1


def test_a_thing_on_another_is_not_taken_for_it() -> None:
    table: Place = ("DiningTable", 3.0, 0.5, 0.7)
    tracker = watched(APPLE)
    tracker.take_opinion(model(2.0, table))
    assert sorted(t.type for t in tracker.tracks) == ["Apple", "DiningTable"]


def test_what_only_the_model_sees_is_told_at_its_second_look() -> None:
    tracker = watched(MUG)
    towel: Place = ("Towel", 3.0, 0.8, 0.8)
    assert names(tracker.take_opinion(model(2.0, towel, MUG))) == []
    told = tracker.take_opinion(model(12.0, towel, MUG))
    assert names(told) == ["Towel"], "a type that the detector does not know"
    assert [c.what for c in told.changes] == ["appeared"]


def test_a_thing_that_the_model_names_twice_is_not_two() -> None:
    tracker = watched(MUG)
    double = ("Mug", MUG[1], MUG[2] + 0.15, MUG[3])
    tracker.take_opinion(model(2.0, MUG, double))
    assert len(tracker.tracks) == 1


def test_the_detectors_pictures_say_nothing_of_what_only_the_model_sees() -> None:
    tracker = Tracker()
    tracker.take_opinion(model(0.0, APPLE))
    tracker.take_opinion(model(10.0, APPLE))
    for i in range(20):
        assert tracker.update(seen(10.5 + 0.5 * i)).gone == ()
    assert [t.type for t in tracker.tracks] == ["Apple"]


def test_what_the_model_misses_again_and_again_is_gone() -> None:
    tracker = Tracker()
    for i in range(3):
        tracker.take_opinion(model(10.0 * i, APPLE, MUG))
    gone = [a.type for i in range(12) for a in tracker.take_opinion(model(30.0 + 10.0 * i, MUG)).gone]
    assert gone == ["Apple"]


def test_a_model_that_misses_what_the_detector_sees_changes_nothing() -> None:
    tracker = watched(APPLE, MUG)
    before = [t.confidence for t in tracker.tracks]
    for i in range(10):
        assert tracker.take_opinion(model(2.0 + i)).gone == ()
    assert [t.confidence for t in tracker.tracks] == before


def test_a_thing_that_the_detector_sees_later_is_its_own_from_then_on() -> None:
    tracker = Tracker()
    tracker.take_opinion(model(0.0, APPLE))
    tracker.take_opinion(model(10.0, APPLE))
    assert tracker.tracks[0].position_enu_m != pytest.approx(APPLE[1:], abs=1e-3)
    told = tracker.update(seen(10.5, sighting(APPLE)))
    assert names(told) == ["Apple"]
    assert told.objects[0].position_enu_m == pytest.approx(APPLE[1:], abs=1e-9), "where it is the detector knows better"
    assert len(tracker.tracks) == 1
    assert tracker.take_opinion(model(20.0, APPLE)).objects == ()


def test_a_state_that_the_model_sees_counts() -> None:
    tracker = watched(("Fridge", 4.0, 0.0, 0.9))
    tracker.take_opinion(model(2.0, ("Fridge", 4.0, 0.0, 0.9), state="open"))
    told = tracker.update(seen(2.5, sighting(("Fridge", 4.0, 0.0, 0.9))))
    assert told.objects[0].props["isOpen"] > 0.6


def test_large_things_may_be_pointed_at_anywhere() -> None:
    tracker = watched(SOFA)
    tracker.take_opinion(model(2.0, SOFA, slip_cells=(0.9, 0.3)))
    assert len(tracker.tracks) == 1
