"""What a drone does not begin, or cannot go on with, and the words in which it says so."""

from dataclasses import replace

import pytest

from devices.drone.airspace import Obstacle
from devices.drone.outlines import Outline
from devices.drone.pilot import Arm, Found, Said, Steer
from tests.devices.drone.scripted import Flown, kinds
from wire.messages.command import Command


@pytest.mark.parametrize(
    ("says", "words"),
    [
        ({"located": False}, "no position estimate"),
        ({"position_enu_m": None}, "no position estimate"),
        ({"battery": 0.15}, "the battery is at 15%, 20% is needed to begin"),
        ({"position_enu_m": (-3.0, 1.0, 0.0)}, "it is at (-3.0, 1.0), outside the rooms of the site; origin_enu_m"),
        ({"armable": False}, "does not let itself be armed: PreArm: no fix"),
    ],
)
@pytest.mark.parametrize(("action", "fields"), [("take_off", {}), ("goto", {"point_m": (3.0, 3.0)})])
def test_it_says_why_it_cannot_begin(action, fields, says, words):
    flown = Flown()
    flown.pilot.says = replace(flown.pilot.says, **says)
    flown.begin(action, **fields)
    flown.work(3.0)
    flown.pilot.tell(Said("PreArm: no fix", urgent=True))
    outcome = flown.work(10.0)
    assert (outcome.status, outcome.code) == ("failed", "precondition")
    assert words in outcome.reason
    assert flown.pilot.orders == []


def test_what_is_not_ready_yet_is_waited_for():
    flown = Flown()
    ready, flown.pilot.says = flown.pilot.says, replace(flown.pilot.says, located=False)
    flown.begin("take_off")
    assert flown.work(2.0) is None
    flown.pilot.says = ready
    assert flown.work(10.0).status == "done"


def test_refusals_are_passed_on_with_what_the_autopilot_said():
    flown = Flown()
    flown.pilot.refusals[Arm] = "failed"
    flown.pilot.tell(Said("Arm: throttle not down", urgent=True))
    outcome = flown.do("take_off")
    assert outcome.reason == "not armed: failed: Arm: throttle not down"
    del flown.pilot.refusals[Arm]
    flown.pilot.refusals[Steer] = "command denied"
    assert "takes no setpoints: command denied" in flown.do("goto", point_m=(3.0, 3.0)).reason
    assert kinds(flown)[-1] == "Hover"


def test_what_cannot_hover_is_not_flown():
    flown = Flown()
    flown.pilot.tell(Found(1, "px4", "the vehicle is a fixed wing, and only a multicopter hovers"))
    assert "fixed wing" in flown.do("take_off").reason


@pytest.mark.parametrize(
    ("action", "fields", "words"),
    [
        ("goto", {"point_m": (9.0, 1.0)}, "outside the rooms"),
        ("goto", {"point_m": (2.0, 2.0), "params": {"height_m": 2.4}}, "too high"),
        ("take_off", {"params": {"height_m": 2.3}}, "too high here: at most 2.1 m"),
        ("follow_path", {"params": {"way_m": "1 1 1.5; 6 3.5 1.5"}}, "blocked"),
        ("orbit", {"point_m": (3.5, 2.0), "params": {"radius_m": 1.5}}, "no room to fly around"),
        ("hold", {}, "take off first"),
    ],
)
def test_what_the_building_does_not_allow_is_not_begun(action, fields, words):
    flown = Flown()
    outcome = flown.do(action, **fields)
    assert outcome.status == "failed"
    assert words in outcome.reason
    assert flown.pilot.orders == []


@pytest.mark.parametrize(
    ("action", "fields", "words"),
    [
        ("goto", {}, "exactly one of target, room and point_m"),
        ("goto", {"room": "cellar"}, "there is no room cellar"),
        ("follow_path", {"params": {"way_m": "1 1 1; 2 2"}}, "'2 2' is not three numbers"),
        ("follow_path", {"params": {"way_m": "1 1 1"}}, "a way has 2 to 60"),
        ("orbit", {"point_m": (1.0, 1.0), "params": {"turns": 0.0}}, "0 is no orbit"),
        ("construct_map", {"params": {"west_m": 1.0}}, "give either room or all of"),
        ("fetch", {}, "cannot fetch; it can take_off, land, goto"),
    ],
)
def test_wrong_parameters_are_refused_with_a_sentence(action, fields, words):
    given = {"epoch": 1, "robot": "drone-1", "valid_until_s": 1e6, "timeout_s": 60.0, **fields}
    command = Command.model_validate({"goal_id": "g-1", "action": action, **given})
    assert words in Flown().worker.fault_of(command)


def test_what_stands_in_the_way_is_waited_for_and_named():
    flown = Flown()
    flown.do("take_off")
    flown.craft.space.obstacles = things = {"obj-1": Obstacle(Outline((4.0, 2.0), 0.4), 1.9)}
    flown.begin("goto", point_m=(7.0, 3.0))
    assert flown.work(5.0) is None
    assert flown.worker.progress[1] == "waiting for the way to (7.0, 3.0) at 1.5 m: obj-1"
    assert "Steer" not in kinds(flown), "it hovers meanwhile"
    things.clear()
    outcome = flown.work(30.0)
    assert outcome.code == "ok"


def test_what_stays_in_the_way_ends_the_goal():
    flown = Flown()
    flown.craft.space.obstacles = {
        "obj-1": Obstacle(Outline((4.0, 2.0), 0.4), 1.9),
        "obj-2": Obstacle(Outline((1.0, 3.5), 0.4), 1.9),
    }
    outcome = flown.do("goto", point_m=(7.0, 3.0))
    assert (outcome.code, outcome.reason) == ("blocked", "(7.0, 3.0): obj-1 is in the way")


def test_who_takes_it_by_hand_while_it_waits_for_its_way_is_left_alone():
    flown = Flown()
    flown.do("take_off")
    flown.craft.space.obstacles = {"obj-1": Obstacle(Outline((4.0, 2.0), 0.4), 1.9)}
    flown.begin("goto", point_m=(7.0, 3.0))
    flown.work(2.0)
    flown.pilot.says = replace(flown.pilot.says, mode="POSCTL")
    assert flown.work(2.0).code == "interrupted"
    assert kinds(flown)[-1] != "Steer"
