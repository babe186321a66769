"""What the hub's traffic may tell a drone: a level, to stay down or up, and where else to land."""

from dataclasses import replace
from itertools import pairwise
from math import dist, pi

import pytest

from devices.drone.flight import face
from devices.drone.pilot import Land, TakeOff
from tests.devices.drone.scripted import Flown
from wire.messages.command import TrafficOrder


def order(**fields: object) -> TrafficOrder:
    return TrafficOrder.model_validate({"robot": "drone-1", "seq": 1, "stamp_s": 100.0, "go": True, **fields})


def ended(flown: Flown) -> str:
    """How the goal at hand ended: its code."""
    outcome = flown.work(200.0)
    return outcome.code if outcome is not None else "not within 200 s"


def test_it_travels_at_the_level_that_it_is_given() -> None:
    flown = Flown()
    flown.craft.order = order(height_m=2.0)
    flown.begin("goto", point_m=(3.0, 3.0), params={"height_m": 1.2})
    assert ended(flown) == "ok"
    assert max(s.position_enu_m[2] for s in flown.pilot.setpoints) > 1.95
    assert abs(flown.craft.position_m[2] - 1.2) < 0.2


def test_a_door_that_is_too_low_for_its_level_is_flown_through_below_the_lintel() -> None:
    flown = Flown()
    flown.craft.order = order(height_m=2.1)
    assert flown.do("goto", room="east").code == "ok"
    in_door = [s.position_enu_m[2] for s in flown.pilot.setpoints if abs(s.position_enu_m[0] - 4.0) < 0.2]
    assert in_door
    assert max(in_door) <= 1.7 + 1e-6


def test_what_is_left_of_its_way_is_told_with_its_heights() -> None:
    flown = Flown()
    flown.begin("inspect_from_above", room="east")
    told = []
    for _ in range(4000):
        if flown.work(0.05) is not None:
            break
        pose = flown.worker.pose
        assert pose is not None
        assert len(pose.path_m) == len(pose.path_heights_m)
        told += pose.path_heights_m
    assert told
    assert max(told) > 1.9


def test_it_takes_off_only_when_nobody_is_over_it() -> None:
    flown = Flown()
    flown.craft.order = order(column_taken=True)
    flown.begin("take_off")
    assert flown.work(5.0) is None
    assert not any(isinstance(asked, TakeOff) for asked in flown.pilot.orders)
    pose = flown.worker.pose
    assert pose is not None
    assert pose.held_up  # the time is not counted
    flown.craft.order = order()
    assert ended(flown) == "ok"
    assert flown.craft.airborne


def test_it_lands_only_when_nobody_passes_below() -> None:
    flown = Flown()
    flown.do("take_off")
    flown.craft.order = order(column_taken=True)
    flown.begin("land")
    assert flown.work(5.0) is None
    assert flown.craft.airborne
    flown.craft.order = order()
    assert ended(flown) == "ok"
    assert not flown.craft.airborne


@pytest.mark.parametrize("battery", [0.9, 0.15])
def test_where_somebody_stands_below_it_lands_beside(battery: float) -> None:
    flown = Flown()
    flown.do("take_off")
    flown.pilot.says = replace(flown.pilot.says, battery=battery)
    flown.craft.order = order(column_taken=True, land_at_m=(2.5, 2.5))
    flown.begin("land")
    for _ in range(2000):
        if dist(flown.craft.position_m[:2], (2.5, 2.5)) < 0.25:
            flown.craft.order = order()
        if (outcome := flown.work(0.05)) is not None:
            break
    assert outcome is not None
    assert outcome.status == "done"
    assert dist(flown.craft.position_m[:2], (2.5, 2.5)) < 0.4
    assert any(isinstance(asked, Land) for asked in flown.pilot.orders)


def test_on_its_last_charge_it_still_makes_way() -> None:
    flown = Flown()
    flown.do("take_off")
    flown.pilot.says = replace(flown.pilot.says, battery=0.15)
    flown.craft.order = order(step_aside_m=(1.0, 3.0))
    flown.pause(8.0)
    assert dist(flown.craft.position_m[:2], (1.0, 3.0)) < 0.4


def test_led_away_while_it_turns_it_flies_back_before_it_looks() -> None:
    flown = Flown()
    flown.begin("goto", point_m=(3.0, 1.0), params={"yaw_deg": 180.0})
    while dist(flown.craft.position_m, (3.0, 1.0, 1.5)) > 0.01 or abs(flown.craft.yaw_rad) < 0.3:
        assert flown.work(0.05) is None
    flown.craft.order = order(step_aside_m=(1.0, 3.0))
    assert flown.work(8.0) is None
    assert dist(flown.craft.position_m[:2], (1.0, 3.0)) < 0.4
    flown.craft.order = order()
    aside_m, sent = flown.craft.position_m, len(flown.pilot.setpoints)
    assert ended(flown) == "ok"
    back_m = [aside_m, *(s.position_enu_m for s in flown.pilot.setpoints[sent:])]
    assert max(dist(a, b) for a, b in pairwise(back_m)) < 0.06, "no jump"
    assert dist(back_m[-1], (3.0, 1.0, 1.5)) < 0.01
    assert abs(abs(flown.craft.yaw_rad) - pi) < 0.1


def test_it_turns_to_what_lies_due_east() -> None:
    flown = Flown()
    flown.do("take_off")
    flown.pilot.says = replace(flown.pilot.says, yaw_rad=2.0)
    flown.tick()
    for _ in face(flown.craft, (3.0, 1.0)):
        flown.tick()
    assert abs(flown.craft.yaw_rad) < 0.1
