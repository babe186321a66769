"""The autopilot, or a person at its remote control, flies it otherwise than it was asked to from here."""

from dataclasses import replace

from devices.drone.pilot import Said
from tests.devices.drone.scripted import Flown, kinds
from wire.messages.command import TrafficOrder


def test_who_takes_over_is_left_alone():
    flown = Flown()
    flown.begin("goto", point_m=(7.0, 3.0))
    flown.work(4.0)
    flown.pilot.says = replace(flown.pilot.says, mode="RETURN_TO_LAUNCH")
    flown.pilot.tell(Said("Failsafe: low battery", urgent=True))
    outcome = flown.work(10.0)
    assert outcome.code == "interrupted"
    assert outcome.reason == "(7.0, 3.0): the autopilot has gone over to return to launch: Failsafe: low battery"
    orders = len(flown.pilot.orders)
    flown.pause(5.0)
    assert len(flown.pilot.orders) == orders, "it flies home by itself"


def test_who_takes_it_by_hand_has_it_until_the_mode_is_switched_back():
    flown = Flown()
    flown.do("take_off")
    flown.begin("goto", point_m=(7.0, 3.0))
    flown.work(3.0)
    flown.pilot.says = replace(flown.pilot.says, mode="POSCTL")
    assert flown.work(5.0).code == "interrupted"
    back = "drone-1 is flown by hand (posctl): switch its mode to give it back"
    assert flown.fault_of("goto", point_m=(1.0, 1.0)) == back
    flown.pilot.says = replace(flown.pilot.says, armed=False, landed="on_ground")
    flown.pause(1.0)
    assert flown.fault_of("take_off") == back, "whoever has landed it may walk up to it"
    flown.pilot.says = replace(flown.pilot.says, mode="HOLD")
    flown.pause(1.0)
    assert flown.fault_of("take_off") == ""


def test_who_takes_it_by_hand_while_it_waits_to_climb_on_keeps_it():
    flown = Flown()
    flown.pilot.climbs_mps = 0.5
    flown.begin("goto", point_m=(7.0, 3.0))
    flown.work(1.5)
    flown.worker.halt()  # it does not climb any more
    taken = {"robot": "drone-1", "seq": 1, "stamp_s": 1.0, "go": True, "column_taken": True}
    flown.craft.order = TrafficOrder.model_validate(taken)
    flown.work(1.0)
    flown.pilot.says = replace(flown.pilot.says, mode="POSCTL")
    flown.work(0.5)
    orders = len(flown.pilot.orders)
    flown.craft.order = None
    outcome = flown.work(5.0)
    assert outcome is not None
    assert (outcome.code, len(flown.pilot.orders)) == ("interrupted", orders)


def test_who_takes_it_by_hand_while_it_waits_to_land_keeps_it():
    flown = Flown()
    flown.do("take_off")
    taken = {"robot": "drone-1", "seq": 1, "stamp_s": 1.0, "go": True, "column_taken": True}
    flown.craft.order = TrafficOrder.model_validate(taken)
    flown.begin("land")
    flown.work(1.0)
    flown.pilot.says = replace(flown.pilot.says, mode="ALTCTL")
    flown.work(0.5)
    orders = len(flown.pilot.orders)
    flown.craft.order = None
    outcome = flown.work(5.0)
    assert outcome is not None
    assert (outcome.code, len(flown.pilot.orders)) == ("interrupted", orders)


def test_modes_of_sticks_mean_nothing_before_it_has_flown():
    flown = Flown()
    flown.pilot.says = replace(flown.pilot.says, mode="STABILIZED")  # ArduCopter's, when it is switched on
    flown.pause(1.0)
    assert flown.fault_of("take_off") == ""


def test_who_takes_over_while_it_turns_is_left_alone_too():
    flown = Flown()
    flown.do("take_off")
    flown.begin("goto", point_m=(1.0, 1.0), params={"yaw_deg": 180.0})
    flown.work(1.5)
    assert 0.1 < abs(flown.craft.yaw_rad) < 3.0
    flown.pilot.says = replace(flown.pilot.says, mode="POSCTL")
    outcome = flown.work(5.0)
    assert outcome.code == "interrupted"
    assert outcome.reason == "(1.0, 1.0): the autopilot has gone over to posctl"
    assert kinds(flown)[-1] == "Steer"
