"""One object is one object: names over many pictures, and when something is said to have gone."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from devices.vision.lens import Lens
from devices.vision.tracking import Tracked, Tracker

from .sightings import LENS, seen, sighting

APPLE = ("Apple", 3.0, 0.5, 0.8)
MUG = ("Mug", 3.0, -0.5, 0.8)


def show(tracker: Tracker, pictures: int, *things, start_s: float = 0.0, **kwargs) -> list[Tracked]:
    return [tracker.update(seen(start_s + 0.5 * i, *(sighting(t, **kwargs) for t in things))) for i in range(pictures)]


def test_a_thing_is_told_of_from_its_second_sighting_on() -> None:
    first, second = show(Tracker(), 2, APPLE)
    assert first.objects == ()
    assert [o.type for o in second.objects] == ["Apple"]
    assert [c.what for c in second.changes] == ["appeared"]


@given(seed=st.integers(0, 10_000))
def test_jitter_keeps_one_name_for_one_thing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    tracker = Tracker()
    names = set()
    for i in range(12):
        things = [(n, x + rng.normal(0, 0.05), y + rng.normal(0, 0.05), z) for n, x, y, z in (APPLE, MUG)]
        result = tracker.update(seen(0.5 * i, *(sighting(t) for t in things)))
        names |= {(o.type, o.track) for o in result.objects}
    assert len(names) == 2


def test_two_alike_that_stand_apart_keep_their_names() -> None:
    tracker = Tracker()
    left, right = ("Apple", 3.0, 0.4, 0.8), ("Apple", 3.0, -0.4, 0.8)
    before = show(tracker, 3, left, right)[-1]
    after = show(tracker, 1, right, left, start_s=2.0)[-1]
    places = [{o.track: round(o.position_enu_m[1], 1) for o in r.objects} for r in (before, after)]
    assert places[0] == places[1]


def test_votes_outweigh_one_wrong_name() -> None:
    tracker = Tracker()
    show(tracker, 4, APPLE)
    (mistaken,) = show(tracker, 1, ("Tomato", *APPLE[1:]), start_s=2.0, sure=0.6)
    assert [(o.type, o.track) for o in mistaken.objects] == [("Apple", "t1")]


def test_what_should_be_seen_and_is_not_has_gone() -> None:
    tracker = Tracker()
    show(tracker, 4, APPLE, MUG)
    results = show(tracker, 6, MUG, start_s=2.0)
    gone = [a for r in results for a in r.gone]
    assert [a.type for a in gone] == ["Apple"]
    assert gone[0].confidence > 0.95
    assert [c.what for r in results for c in r.changes] == ["gone"]


def test_one_miss_is_no_absence() -> None:
    tracker = Tracker()
    show(tracker, 4, APPLE)
    assert all(r.gone == () for r in show(tracker, 2, start_s=2.0))
    assert show(tracker, 1, APPLE, start_s=3.0)[0].objects[0].track == "t1"


def test_behind_a_robot_nothing_goes() -> None:
    tracker = Tracker()
    show(tracker, 4, APPLE)
    robot = ("Robot", 1.6, 0.28, 1.3)
    results = show(tracker, 8, robot, start_s=2.0)
    assert all(r.gone == () for r in results)
    assert all(o.type != "Robot" for r in results for o in r.objects)


def test_out_of_the_picture_nothing_goes() -> None:
    tracker = Tracker()
    show(tracker, 4, APPLE)
    away = Lens(640, 480, 320.0, (0.0, 0.0, 2.3), 2.5, 0.5)
    results = [tracker.update(seen(2.0 + 0.5 * i, lens=away)) for i in range(8)]
    assert all(r.gone == () for r in results)
    assert show(tracker, 1, APPLE, start_s=10.0)[0].objects[0].track == "t1"


def test_behind_something_near_in_the_depth_picture_nothing_goes() -> None:
    tracker = Tracker()
    near, clear = np.full((480, 640), 1.0, np.float32), np.full((480, 640), 6.0, np.float32)
    for i in range(4):
        tracker.update(seen(0.5 * i, sighting(APPLE), depth_m=clear))
    hidden = [tracker.update(seen(2.0 + 0.5 * i, depth_m=near)) for i in range(5)]
    assert all(r.gone == () for r in hidden)
    open_ = [tracker.update(seen(5.0 + 0.5 * i, depth_m=clear)) for i in range(6)]
    assert [a.type for r in open_ for a in r.gone] == ["Apple"]


def test_a_flickering_thing_needs_more_misses() -> None:
    steady, flickering = Tracker(), Tracker()
    show(steady, 9, APPLE)
    for i in range(9):
        flickering.update(seen(0.5 * i, *([sighting(APPLE)] if i % 2 == 0 else [])))
    counts = []
    for tracker in (steady, flickering):
        results = show(tracker, 12, start_s=5.0)
        counts.append(next(i for i, r in enumerate(results) if r.gone))
    assert counts[0] < counts[1]


def test_a_state_is_smoothed_and_its_change_is_noted() -> None:
    tracker = Tracker()
    tv = ("Television", 3.0, 0.0, 0.8)
    show(tracker, 4, tv, props={"isToggled": 0.1})
    (blip,) = show(tracker, 1, tv, start_s=2.0, props={"isToggled": 0.7})
    assert blip.changes == ()
    results = show(tracker, 4, tv, start_s=2.5, props={"isToggled": 0.95})
    assert [(c.what, c.value) for r in results for c in r.changes] == [("isToggled", True)]
    assert results[-1].objects[0].props["isToggled"] > 0.9


def test_a_carried_thing_is_followed() -> None:
    tracker = Tracker()
    for i in range(10):
        result = tracker.update(seen(0.5 * i, sighting(("Apple", 3.0, 0.5 - 0.2 * i, 0.8))))
    assert [o.track for o in result.objects] == ["t1"]
    assert result.objects[0].position_enu_m[1] == pytest.approx(-1.3, abs=0.25)


def test_the_lens_of_these_tests_sees_its_things() -> None:
    for thing in (APPLE, MUG):
        u, v, _ = LENS.pixels(thing[1:])[0]
        assert 20 < u < 620
        assert 20 < v < 460
