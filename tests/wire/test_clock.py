"""Who is waited for, and how fast time may go."""

import random

import pytest

from wire.clock import Pace, Roll, WallClock


def test_time_waits_for_who_is_there() -> None:
    roll = Roll({"hub": "hub", "dog-1": "robot", "dog-2": "robot"})
    assert roll.deserted
    roll.presence("hub", True)
    roll.presence("dog-1", True)
    roll.presence("console-1", True)
    assert roll.absent == ["dog-2"]
    roll.begin(7)
    assert roll.waiting == ["dog-1", "hub"]
    roll.done("hub", 7)
    roll.done("dog-1", 6)
    assert roll.waiting == ["dog-1"]
    roll.presence("dog-2", True)
    assert roll.waiting == ["dog-1"], "who comes joins with the next tick"
    roll.presence("dog-1", False)
    assert roll.waiting == []
    roll.begin(8)
    assert roll.waiting == ["dog-2", "hub"]


def test_without_followers_time_goes_on_alone() -> None:
    roll = Roll({})
    roll.begin(0)
    assert roll.waiting == []
    assert not roll.deserted


def test_any_order_of_answers_ends_the_wait() -> None:
    rng = random.Random(5)
    for _ in range(50):
        names = [f"dog-{i}" for i in range(6)]
        roll = Roll(dict.fromkeys(names, "robot"))
        for name in names:
            roll.presence(name, True)
        roll.begin(3)
        rng.shuffle(names)
        for count, name in enumerate(names):
            assert len(roll.waiting) == 6 - count
            roll.done(name, 3)
        assert roll.waiting == []


def test_pace() -> None:
    pace = Pace(speed=2.0)
    assert pace.ahead_s(10.0, 100.0) == 0.0
    assert pace.ahead_s(11.0, 100.1) == pytest.approx(0.4)
    assert pace.ahead_s(12.0, 105.0) == 0.0
    assert pace.ahead_s(13.0, 105.0) == pytest.approx(0.5), "after a stop the pace is taken up anew"
    assert Pace(speed=0.0).ahead_s(1e6, 0.0) == 0.0


def test_the_wall_clock_never_goes_back() -> None:
    clock = WallClock()
    times = [clock.now_s() for _ in range(1000)]
    assert times == sorted(times)
