"""Halted or led aside on its way up, a drone climbs on; a way aside is flown where nobody walks."""

import pytest

from tests.devices.drone.scripted import STEP_S, Flown, kinds
from wire.messages.command import TrafficOrder


def climbing() -> Flown:
    """Some way up from the floor, on the way to somewhere else."""
    flown = Flown()
    flown.pilot.climbs_mps = 0.5
    flown.begin("goto", point_m=(3.0, 3.0))
    flown.work(1.5)
    assert 0.3 < flown.craft.position_m[2] < 1.0
    return flown


def order(flown: Flown, **fields: object) -> None:
    given = {"robot": "drone-1", "seq": 1, "stamp_s": flown.now_s, "go": True, **fields}
    flown.craft.order = TrafficOrder.model_validate(given)


@pytest.mark.parametrize("seconds", [0.3, 6.0])
def test_led_aside_while_it_climbs_it_gets_there_all_the_same(seconds: float) -> None:
    flown = climbing()
    order(flown, go=False, step_aside_m=(1.5, 1.0))
    flown.work(seconds)
    order(flown)
    outcome = flown.work(60.0)
    assert outcome is not None
    assert (outcome.code, kinds(flown).count("TakeOff")) == ("ok", 1)


def test_a_way_aside_is_flown_at_the_height_of_travel() -> None:
    flown = climbing()
    order(flown, go=True, step_aside_m=(2.5, 1.0))
    flown.work(10.0)
    assert flown.craft.position_m == pytest.approx((2.5, 1.0, 1.5), abs=0.3)


def test_one_that_is_held_up_low_in_the_air_takes_off_to_its_full_height() -> None:
    flown = Flown()
    flown.pilot.climbs_mps = 0.5
    flown.begin("take_off")
    flown.work(1.5)
    for _ in range(round(1.0 / STEP_S)):
        flown.tick()
        flown.worker.halt()
    outcome = flown.work(30.0)
    assert outcome is not None
    assert outcome.code == "ok"
    assert flown.craft.position_m[2] == pytest.approx(1.5, abs=0.25)
