"""What a drone does with its goals, whatever its autopilot answers."""

from dataclasses import replace
from itertools import pairwise
from math import dist, hypot, pi

from devices.drone.pilot import Found, Hover, Land, Pictured, Shoot, Steer, TakeOff
from devices.drone.skills import SKILLS
from tests.devices.drone.scripted import Flown, kinds
from wire.frames import bearing_rad
from wire.messages.command import Target, TrafficOrder

FRIDGE = Target(id="fridge-1", type="Fridge", position_enu_m=(7.0, 2.0, 0.9), spread_m=0.1)


def test_it_takes_off_flies_and_lands():
    flown = Flown()
    assert flown.do("take_off", params={"height_m": 1.2}).status == "done"
    assert kinds(flown) == ["Arm", "TakeOff", "Hover"]
    assert flown.pilot.orders[1] == TakeOff(1.2)
    assert flown.do("take_off").code == "already"
    outcome = flown.do("goto", point_m=(6.0, 3.0), params={"yaw_deg": 90.0})
    assert outcome.status == "done", outcome.reason
    assert dist(flown.craft.position_m, (6.0, 3.0, 1.5)) < 0.2
    assert abs(flown.craft.yaw_rad - pi / 2.0) < 0.1
    assert kinds(flown)[-1] == "Hover", "every flight ends in hover"
    assert flown.do("land").status == "done"
    assert not flown.craft.airborne
    assert flown.do("land").code == "already"


def test_setpoints_come_every_step_and_make_no_jumps():
    flown = Flown()
    flown.do("goto", point_m=(6.0, 3.0))
    for a, b in pairwise(flown.pilot.setpoints):
        assert dist(a.position_enu_m, b.position_enu_m) < 0.06
        assert dist(a.velocity_enu_mps, b.velocity_enu_mps) < 0.2
    assert max(hypot(*s.velocity_enu_mps) for s in flown.pilot.setpoints) > 0.8, "the velocity is fed forward"


def test_a_flight_that_is_dropped_ends_in_hover_ahead_on_its_way():
    flown = Flown()
    flown.begin("goto", point_m=(3.0, 1.0))
    assert flown.work(3.0) is None
    assert flown.worker.pose.path_m
    speed = flown.craft.velocity_mps[0]
    assert speed > 0.3
    flown.worker.drop()
    hover = flown.pilot.orders[-1]
    assert isinstance(hover, Hover)
    assert 0.0 < hover.setpoint.position_enu_m[0] - flown.craft.position_m[0] < 0.6
    flown.pause(1.0)
    assert flown.pilot.orders[-1] is hover, "it is told once"
    assert flown.worker.pose.path_m == ()


def test_a_path_is_flown_through_its_points():
    flown = Flown()
    points = [(1.0, 1.0, 1.2), (2.5, 1.0, 1.5), (3.0, 2.5, 1.8), (1.5, 3.0, 1.2)]
    outcome = flown.do("follow_path", params={"way_m": "; ".join(" ".join(map(str, p)) for p in points)})
    assert outcome.status == "done", outcome.reason
    flown_m = [s.position_enu_m for s in flown.pilot.setpoints]
    assert all(min(dist(p, f) for f in flown_m) < 0.05 for p in points)


def test_an_orbit_looks_at_its_middle():
    flown = Flown()
    begun = len(flown.pilot.setpoints)
    assert flown.do("orbit", point_m=(2.0, 2.0), params={"radius_m": 1.0}).status == "done"
    around = [s for s in flown.pilot.setpoints[begun:] if abs(dist(s.position_enu_m[:2], (2.0, 2.0)) - 1.0) < 0.06]
    assert len(around) > 100
    off = [abs((s.yaw_rad - bearing_rad(s.position_enu_m[:2], (2.0, 2.0)) + pi) % (2 * pi) - pi) for s in around[60:]]
    assert max(off) < 0.2


def test_a_thing_is_looked_at_from_its_room_and_from_above():
    flown = Flown()
    outcome = flown.do("look_at", target=FRIDGE)
    assert outcome.status == "done"
    assert "picture 7 taken" in outcome.reason
    assert flown.craft.position_m[0] > 4.5
    assert abs(flown.craft.yaw_rad) < 0.5, "facing east, where the fridge is"
    above = flown.do("inspect_from_above", room="west")
    assert "living room seen from 0.1 m beside, 2.1 m high; picture 7 taken" in above.reason


def test_a_survey_takes_a_picture_at_every_station():
    flown = Flown()
    outcome = flown.do("construct_map", room="west", params={"spacing_m": 1.5})
    assert outcome.reason == "9 of 9 pictures taken"
    assert kinds(flown).count("Shoot") == 9
    corner = flown.do(
        "construct_map", params={"west_m": 5.0, "south_m": 1.0, "width_m": 2.0, "depth_m": 2.0, "spacing_m": 2.0}
    )
    assert corner.reason == "4 of 4 pictures taken"


def test_a_survey_of_too_many_stations_is_refused_however_few_can_be_flown_to():
    flown = Flown()
    much = {"west_m": -100.0, "south_m": 0.5, "width_m": 110.0, "depth_m": 3.0, "spacing_m": 0.5}
    outcome = flown.do("construct_map", params=much)
    assert (outcome.code, outcome.reason) == ("precondition", "more than 400 pictures; give a wider spacing_m")
    assert flown.pilot.orders == []


def test_a_camera_that_fails_is_told_of():
    flown = Flown()
    flown.pilot.refusals[Shoot] = "the vehicle has no camera on its link"
    assert flown.do("take_picture").reason == "no picture was taken: the vehicle has no camera on its link"
    assert flown.do("construct_map", room="west").status == "failed"
    del flown.pilot.refusals[Shoot]
    flown.pilot.picture = Pictured(8, False)
    assert flown.do("take_picture").reason == "the camera could not take the picture"


def test_one_that_comes_along_fast_is_taken_up_where_it_can_stop():
    flown = Flown()
    flown.do("take_off")
    flown.pilot.says = replace(flown.pilot.says, velocity_enu_mps=(2.0, 0.0, 0.0), mode="RETURN_TO_LAUNCH")
    flown.tick()
    assert flown.do("goto", point_m=(3.0, 3.0)).status == "done"
    taken_up = next(order for order in flown.pilot.orders if isinstance(order, Steer))
    assert dist(taken_up.setpoint.position_enu_m, (3.0, 1.0, 1.5)) < 0.01


def test_traffic_makes_it_wait_and_step_aside():
    flown = Flown()
    flown.begin("goto", point_m=(3.0, 1.0))
    flown.work(2.0)
    flown.craft.order = TrafficOrder(robot="drone-1", seq=1, stamp_s=1.0, go=False)
    flown.work(2.0)
    here = flown.craft.position_m
    assert flown.work(3.0) is None
    assert dist(here, flown.craft.position_m) < 0.01
    assert flown.worker.pose.held_up
    flown.craft.order = TrafficOrder(robot="drone-1", seq=2, stamp_s=1.0, go=True, step_aside_m=(1.0, 3.0))
    assert flown.work(6.0) is None
    assert dist(flown.craft.position_m[:2], (1.0, 3.0)) < 0.4
    flown.craft.order = TrafficOrder(robot="drone-1", seq=3, stamp_s=1.0, go=True)
    assert flown.work(30.0).status == "done"
    assert dist(flown.craft.position_m[:2], (3.0, 1.0)) < 0.2


def test_without_its_hub_it_hovers_and_then_lands():
    flown = Flown(land_after_s=5.0)
    flown.begin("goto", point_m=(7.0, 3.0))
    flown.work(4.0)
    flown.pause(4.0, hub=True)
    assert kinds(flown)[-1] == "Hover"
    assert flown.craft.airborne
    flown.pause(2.0, hub=True)
    assert isinstance(flown.pilot.orders[-1], Land)
    outcome = flown.work(1.0)
    assert (outcome.code, outcome.reason) == ("lost_hub", "landed after hovering for 5 s without the hub")
    flown.pause(1.0)
    assert kinds(flown).count("Land") == 1


def test_a_hub_that_comes_back_finds_it_going_on():
    flown = Flown()
    flown.begin("goto", point_m=(7.0, 3.0))
    flown.work(4.0)
    flown.pause(3.0, hub=True)
    assert flown.work(30.0).status == "done"
    assert dist(flown.craft.position_m[:2], (7.0, 3.0)) < 0.2


def test_a_silent_autopilot_is_lost_and_its_goal_fails():
    flown = Flown()
    flown.begin("goto", point_m=(7.0, 3.0))
    flown.work(4.0)
    flown.pilot.silent = True
    silent_s = flown.now_s
    outcome = flown.work(5.0)
    assert outcome.code == "driver"
    assert "not heard any more" in outcome.reason
    assert flown.now_s - silent_s < 1.8
    assert flown.worker.pose.lost
    flown.pilot.silent = False
    flown.pause(0.1)
    assert not flown.worker.pose.lost


def test_an_idle_drone_lands_before_its_battery_is_empty():
    flown = Flown()
    flown.do("take_off")
    flown.pilot.says = replace(flown.pilot.says, battery=0.1)
    flown.pause(1.0)
    assert isinstance(flown.pilot.orders[-1], Land)
    assert not flown.craft.airborne


def test_a_landing_that_the_old_link_swallowed_is_asked_for_over_the_new_one():
    flown = Flown()
    flown.do("take_off")
    flown.pilot.says = replace(flown.pilot.says, battery=0.1)
    flown.pilot.deaf = True
    flown.pause(4.0)
    assert flown.craft.airborne
    flown.pilot.deaf = False
    flown.pilot.tell(Found(1, "px4"))
    flown.pause(4.0)
    assert kinds(flown).count("Land") == 2
    assert not flown.craft.airborne


def test_one_that_sinks_for_want_of_battery_comes_home_when_it_is_told_to():
    flown = Flown()
    flown.do("goto", point_m=(7.0, 3.0))
    flown.pilot.sinks_mps = 0.1
    flown.pilot.says = replace(flown.pilot.says, battery=0.1)
    flown.pause(2.0)
    assert kinds(flown)[-1] == "Land"
    assert flown.craft.airborne
    flown.pilot.sinks_mps = None
    assert flown.do("return_home").reason == "home, and landed"
    assert kinds(flown).count("Land") == 2
    assert dist(flown.craft.position_m, (1.0, 1.0, 0.0)) < 0.2


def test_a_person_at_the_sticks_is_not_landed_for_want_of_a_hub():
    flown = Flown(land_after_s=1.0)
    flown.do("take_off")
    flown.pilot.says = replace(flown.pilot.says, mode="POSCTL", battery=0.1)
    orders = len(flown.pilot.orders)
    flown.pause(5.0, hub=True)
    flown.pause(5.0)
    assert len(flown.pilot.orders) == orders


def test_it_comes_home_to_where_it_took_off():
    flown = Flown()
    flown.do("goto", point_m=(7.0, 3.0))
    assert flown.do("return_home").reason == "home, and landed"
    assert dist(flown.craft.position_m, (1.0, 1.0, 0.0)) < 0.2


def test_every_skill_is_announced_with_words_and_a_schema():
    card = Flown().worker.card("boot")
    assert [skill.name for skill in card.skills] == list(SKILLS)
    assert all(skill.doc and skill.parameters for skill in card.skills)
