"""What the hub's traffic may tell a drone: a level, to stay down or up, and where else to land."""

from math import dist

from devices.drone.pilot import Land, TakeOff
from tests.devices.drone.scripted import Flown
from wire.messages.command import TrafficOrder


def order(**fields: object) -> TrafficOrder:
    return TrafficOrder.model_validate({"robot": "drone-1", "seq": 1, "stamp_s": 100.0, "go": True, **fields})


def test_it_travels_at_the_level_that_it_is_given() -> None:
    flown = Flown()
    flown.craft.order = order(height_m=2.0)
    flown.begin("goto", point_m=(3.0, 3.0), params={"height_m": 1.2})
    assert flown.work(200.0) is not None
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
    assert flown.work(20.0) is not None
    assert flown.craft.airborne


def test_it_lands_only_when_nobody_passes_below() -> None:
    flown = Flown()
    flown.do("take_off")
    flown.craft.order = order(column_taken=True)
    flown.begin("land")
    assert flown.work(5.0) is None
    assert flown.craft.airborne
    flown.craft.order = order()
    assert flown.work(20.0) is not None
    assert not flown.craft.airborne


def test_where_somebody_stands_below_it_lands_beside() -> None:
    flown = Flown()
    flown.do("take_off")
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
