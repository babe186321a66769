"""A drone that has nothing to do does not hover until its battery is empty."""

from dataclasses import replace
from math import dist

from devices.drone.airspace import Obstacle
from devices.drone.outlines import Outline
from tests.devices.drone.scripted import STEP_S, Flown
from wire.messages.command import TrafficOrder


def away(**robot: object) -> Flown:
    """Hovering in the other room, its goal done."""
    flown = Flown(**robot)
    flown.do("goto", point_m=(7.0, 3.0))
    return flown


def test_it_flies_home_and_lands_after_a_while() -> None:
    flown = away(idle_home_s=10.0)
    flown.pause(9.0)
    assert flown.craft.position_m[:2] == (7.0, 3.0)
    assert flown.craft.airborne
    flown.pause(40.0)
    assert not flown.craft.airborne
    assert abs(flown.craft.position_m[0] - 1.0) + abs(flown.craft.position_m[1] - 1.0) < 0.5
    orders = len(flown.pilot.orders)
    flown.pause(40.0)
    assert len(flown.pilot.orders) == orders


def test_it_lands_where_it_is_when_there_is_no_way_home() -> None:
    """As when something is wrongly believed to stand in the door."""
    flown = away(idle_home_s=5.0)
    flown.craft.space.obstacles = {"obj-1": Obstacle(Outline((4.0, 2.0), 0.9), 1.9)}
    flown.pause(200.0)
    assert not flown.craft.airborne
    assert dist(flown.craft.position_m[:2], (7.0, 3.0)) < 0.5


def test_it_hovers_on_where_the_site_says_so() -> None:
    flown = away(idle_home_s=0.0)
    flown.pause(100.0)
    assert flown.craft.position_m[:2] == (7.0, 3.0)
    assert flown.craft.airborne


def test_a_goal_that_comes_on_its_way_home_is_done() -> None:
    flown = away(idle_home_s=5.0)
    flown.pause(8.0)
    assert flown.craft.path_m, "it is on its way"
    outcome = flown.do("goto", point_m=(6.0, 1.0))
    assert outcome.code == "ok"
    assert flown.craft.position_m[:2] == (6.0, 1.0)
    flown.pause(4.0)
    assert flown.craft.position_m[:2] == (6.0, 1.0), "idle for a moment only"


def test_the_hubs_absence_and_orders_come_before_going_home() -> None:
    flown = away(idle_home_s=5.0, land_after_s=60.0)
    flown.pause(8.0)
    flown.pause(5.0, hub=True)
    assert flown.craft.path_m == ()
    given = {"robot": "drone-1", "seq": 1, "stamp_s": flown.now_s, "go": False, "step_aside_m": (6.0, 1.0)}
    flown.craft.order = TrafficOrder.model_validate(given)
    for _ in range(round(20.0 / STEP_S)):
        flown.tick()
        flown.worker.idle(flown.now_s)
    assert flown.craft.airborne
    flown.craft.order = None
    flown.pause(60.0)
    assert not flown.craft.airborne


def test_on_the_ground_it_gets_up_for_who_waits_and_comes_down_again() -> None:
    """As when it has landed before the television that a walker must get at."""
    flown = away(idle_home_s=5.0)
    flown.pause(40.0)
    assert not flown.craft.airborne
    home_m = flown.craft.position_m[:2]
    given = {"robot": "drone-1", "seq": 1, "stamp_s": flown.now_s, "go": True, "step_aside_m": (3.0, 3.0)}
    flown.craft.order = TrafficOrder.model_validate(given)
    flown.pause(1.0)
    assert not flown.craft.airborne, "somebody who only passes by is let pass"
    flown.pause(20.0)
    assert flown.craft.airborne
    assert dist(flown.craft.position_m[:2], (3.0, 3.0)) < 0.5
    flown.craft.order = None
    flown.pause(60.0)
    assert not flown.craft.airborne
    assert dist(flown.craft.position_m[:2], home_m) < 0.5


def test_it_does_not_get_up_with_an_empty_battery() -> None:
    flown = away(idle_home_s=5.0)
    flown.pause(40.0)
    flown.pilot.says = replace(flown.pilot.says, battery=0.15)
    given = {"robot": "drone-1", "seq": 1, "stamp_s": flown.now_s, "go": True, "step_aside_m": (3.0, 3.0)}
    flown.craft.order = TrafficOrder.model_validate(given)
    flown.pause(20.0)
    assert not flown.craft.airborne


def test_a_person_who_flies_it_is_not_sent_home() -> None:
    flown = away(idle_home_s=5.0)
    flown.pilot.says = replace(flown.pilot.says, mode="POSCTL")
    orders = len(flown.pilot.orders)
    flown.pause(30.0)
    assert len(flown.pilot.orders) == orders
