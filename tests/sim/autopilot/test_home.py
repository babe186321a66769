"""Where it returns to, and what it says when it can not fly as high as it was asked."""

import math

from sim.autopilot.interface import Ack
from tests.sim.autopilot.rig import NAN, ZURICH, ardupilot, item, put


def ready(rig) -> None:
    """Armed on the ground in a mode that takes off."""
    rig.mode("offboard" if ardupilot(rig) else "hold")
    assert rig.do(400, 1).result is Ack.ACCEPTED


def test_arming_leaves_a_home_that_was_set(rig):
    assert rig.do(179, 0, x=2.0, y=1.0, z=0.0, frame=1).result is Ack.ACCEPTED
    rig.take_off(1.0)
    assert rig.report.home_ned_m == (2.0, 1.0, 0.0)
    assert rig.mode("return").result is Ack.ACCEPTED
    assert rig.fly(25, lambda: not rig.report.armed)
    assert rig.off(2.0, 1.0, 0.0) < 0.3


def test_returns_to_a_rally_point_that_is_nearer_than_home(rig):
    rally = [item(0, 5100, 3.0, 0.0, -1.0), item(1, 5100, 0.0, -9.0, -1.0)]
    assert rig.firmware.accept_plan(2, rally) == 0
    rig.take_off(1.0)
    rig.offboard(position=(3.0, 1.0, -1.5))
    assert rig.fly(8, lambda: rig.off(3.0, 1.0, -1.5) < 0.2)
    rig.every = None
    assert rig.mode("return").result is Ack.ACCEPTED
    assert rig.fly(25, lambda: not rig.report.armed)
    assert rig.off(3.0, 0.0, 0.0) < 0.3


def test_returns_home_when_rally_points_are_cleared_or_farther(rig):
    assert rig.firmware.accept_plan(2, [item(0, 5100, 0.5, 0.0, -1.0)]) == 0
    assert rig.firmware.accept_plan(2, [item(0, 5100, NAN, 0.0, -1.0)]) == 10  # and the old plan stays
    assert rig.firmware.now.rally_ned_m == ((0.5, 0.0, -1.0),)
    assert rig.firmware.clear_plan(2) == 0
    assert rig.firmware.accept_plan(2, [item(0, 5100, 30.0, 0.0, -1.0)]) == 0
    rig.take_off(1.0)
    assert rig.mode("return").result is Ack.ACCEPTED
    assert rig.fly(20, lambda: not rig.report.armed)
    assert math.hypot(*rig.true_ned[:2]) < 0.3


def test_says_that_it_flies_below_the_ceiling(rigs):
    for name in ("ardupilot", "px4"):
        rig = rigs(name, ceiling_m=2.5)
        put(rig, **({"RTL_ALT": 1500} if name == "ardupilot" else {"RTL_RETURN_ALT": 15}))
        ready(rig)
        assert rig.do(22, z=30.0 if name == "ardupilot" else ZURICH[2] + 30.0).result is Ack.ACCEPTED
        assert rig.heard("Takeoff: flown at 2.1 m, below the ceiling")
        rig.fly(5.0)
        assert rig.do(192, -1, 1, NAN, NAN, x=1.0, y=0.0, z=-30.0, frame=1).result is Ack.ACCEPTED
        assert rig.heard("Go to: flown at 2.1 m, below the ceiling")
        assert rig.do(34, 2.0, 1.0, x=0.0, y=0.0, z=-30.0, frame=1).result is Ack.ACCEPTED
        assert rig.heard("Orbit: flown at 2.1 m, below the ceiling")
        assert rig.mode("return").result is Ack.ACCEPTED
        rig.fly(0.5)
        assert rig.heard("Return: flown at 2.1 m, below the ceiling")


def test_says_nothing_of_a_ceiling_that_is_high_enough(rig):
    rig.take_off(1.0)
    assert rig.do(192, -1, 1, NAN, NAN, x=1.0, y=0.0, z=-3.0, frame=1).result is Ack.ACCEPTED
    assert not rig.heard("below the ceiling")


def test_a_home_far_below_does_not_keep_it_on_the_ground(rig):
    ready(rig)
    assert rig.do(179, 0, x=0.0, y=0.0, z=50.0, frame=1).result is Ack.ACCEPTED
    answer = rig.do(22, NAN, NAN, NAN, NAN, x=NAN, y=NAN, z=1.0 if ardupilot(rig) else NAN)
    if ardupilot(rig):
        assert answer.result is Ack.FAILED
        assert rig.heard("below where it stands")
        return
    assert answer.result is Ack.ACCEPTED
    assert rig.fly(6, lambda: rig.true_ned[2] < -1.3)


def test_a_mission_lifts_off_above_a_home_far_below(rig):
    first = rig.firmware.plans.mission.first
    items = [item(k, 16, params=(0, 0, 0, NAN)) for k in range(first)]
    items += [item(first, 22, z=1.0, frame=3), item(first + 1, 17, 0.0, 0.0, -1.0)]
    assert rig.firmware.accept_plan(0, items) == 0
    ready(rig)
    assert rig.do(179, 0, x=0.0, y=0.0, z=50.0, frame=1).result is Ack.ACCEPTED
    assert rig.do(300).result is Ack.ACCEPTED
    assert rig.fly(8, lambda: rig.true_ned[2] < -0.7), rig.true_ned


def test_reboot_forgets_what_was_set_for_the_flight(rigs):
    for name in ("ardupilot", "px4"):
        rig = rigs(name)
        rig.do(179, 0, x=2.0, y=1.0, z=0.0, frame=1)
        rig.do(195, x=1.0, y=0.0, z=0.0, frame=1)
        rig.do(178, 1, 0.5)
        assert rig.do(246, 1).result is Ack.ACCEPTED
        rig.fly(0.2)
        now = rig.firmware.now
        assert now.region_ned_m is now.speed_mps is None
        assert math.hypot(*rig.report.home_ned_m) < 0.2
        assert rig.report.origin == ZURICH
        bare = rigs(name, gps="none")
        assert bare.firmware.set_origin(*ZURICH)
        assert bare.do(246, 1).result is Ack.ACCEPTED
        assert bare.report.origin is None
