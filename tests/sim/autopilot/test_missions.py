"""Missions, fences and rally points: what an upload may hold, and how a mission is flown."""

import math

from sim.autopilot.interface import Ack
from tests.sim.autopilot.rig import NAN, ZURICH, ardupilot, item, start, upload


def test_flies_a_mission_to_its_landing(rig):
    latitude, longitude = rig.firmware.now.origin.globe(1.0, 2.0)
    items = [
        item(0, 22, z=1.0, frame=3),
        item(0, 178, params=(1, 1.5, -1, 0), frame=2),
        item(0, 16, 2.0, 0.0, -1.5, (0.5, 0, 0, NAN)),
        item(0, 16, latitude, longitude, 1.5, (0, 0.3, 0, NAN), frame=3),
        item(0, 93, params=(0.5, 0, 0, 0)),
        item(0, 21, 0.0, 1.0, 0.0, (0, 0, 0, NAN)),
    ]
    assert upload(rig, items) == 0
    first = rig.firmware.plans.mission.first
    rig.fly(0.2)
    start(rig)
    passed = []

    def over() -> bool:
        for seq in rig.firmware.reached():
            passed.append((seq, rig.true_ned))
        return not rig.report.armed

    assert rig.fly(40, over), (rig.report.mission_current, rig.true_ned)
    over()
    assert [seq - first for seq, _ in passed] == [0, 1, 2, 3, 4, 5]
    assert math.dist(passed[2][1], (2.0, 0.0, -1.5)) < 0.15
    assert math.dist(passed[3][1], (1.0, 2.0, -1.5)) < 0.35
    assert math.dist(rig.true_ned, (0.0, 1.0, 0.0)) < 0.3


def test_takes_off_by_itself_jumps_and_hovers_at_the_end(rig):
    """Without a take-off item, as MAVSDK sends missions; the last item on its wire is no place."""
    jump_to = rig.firmware.plans.mission.first
    items = [
        item(0, 16, 0.8, 0.0, -1.2, (0, 0, 0, NAN)),
        item(0, 16, 0.0, 0.0, -1.2, (0, 0, 0, NAN)),
        item(0, 177, params=(jump_to, 1, 0, 0)),
        item(0, 178, params=(1, 1, -1, 0), frame=2),
    ]
    assert upload(rig, items) == 0
    start(rig)
    assert rig.fly(40, lambda: rig.firmware.plans.mission.finished)
    reached = [seq - jump_to for seq in rig.firmware.reached()]
    assert reached == [0, 1, 2, 0, 1, 2, 3]
    rig.fly(1.0)
    assert rig.off(0.0, 0.0, -1.2) < 0.25
    assert rig.in_mode("mission" if rig.firmware.now.row.name == "ardupilot" else "hold")


def test_goes_on_where_it_was_interrupted(rig):
    items = [item(0, 16, 1.0, 0.0, -1.0, (0, 0, 0, NAN)), item(0, 16, 1.0, 4.0, -1.0, (0, 0, 0, NAN)), item(0, 20)]
    upload(rig, items)
    start(rig)
    second = rig.firmware.plans.mission.first + 1
    assert rig.fly(15, lambda: rig.report.mission_current == second)
    rig.fly(0.5)
    assert rig.mode("hold").result is Ack.ACCEPTED
    rig.fly(2.0)
    assert rig.report.mission_current == second
    assert rig.mode("mission").result is Ack.ACCEPTED
    assert rig.fly(10, lambda: rig.report.mission_current == second + 1)
    assert math.dist(rig.true_ned, (1.0, 4.0, -1.0)) < 0.2
    assert rig.fly(30, lambda: not rig.report.armed)
    assert math.hypot(*rig.true_ned[:2]) < 0.5


def test_the_current_item_can_be_set(rig):
    upload(rig, [item(0, 16, 3.0, 0.0, -1.0), item(0, 16, 0.0, 1.0, -1.0), item(0, 17, 0.0, 1.0, -1.0)])
    first = rig.firmware.plans.mission.first
    start(rig)
    rig.fly(4.0)
    assert not rig.firmware.set_current(99)
    assert not rig.firmware.set_current(-1)
    assert rig.firmware.set_current(first + 1)
    assert rig.fly(10, lambda: rig.off(0.0, 1.0, -1.0) < 0.2)
    rig.fly(3.0)
    assert rig.report.mission_current == first + 2


def test_a_mission_is_paused_and_goes_on(rig):
    upload(rig, [item(0, 16, 3.0, 0.0, -1.0), item(0, 16, 0.0, 0.0, -1.0)])
    start(rig)
    rig.fly(3.0)
    assert rig.do(193, 0).result is Ack.ACCEPTED
    rig.fly(2.0)
    there = rig.true_ned
    rig.fly(2.0)
    assert math.dist(rig.true_ned, there) < 0.2
    assert rig.do(193, 1).result is Ack.ACCEPTED
    assert rig.fly(10, lambda: rig.off(3.0, 0.0, -1.0) < 0.2)


def test_loiters_for_a_time_and_in_turns(rig):
    upload(
        rig,
        [
            item(0, 19, 0.0, 0.0, -1.0, (1.0, 0, 0, NAN)),
            item(0, 18, 1.0, 0.0, -1.0, (1.0, 0, 1.0, NAN)),
            item(0, 21),
        ],
    )
    start(rig)
    assert rig.fly(40, lambda: not rig.report.armed)
    assert rig.firmware.plans.mission.finished


def test_a_mission_of_jumps_alone_ends(rig):
    first = rig.firmware.plans.mission.first
    upload(rig, [item(0, 178, params=(1, 1, 0, 0)), item(0, 177, params=(first, -1, 0, 0))])
    rig.take_off(1.0)
    rig.mode("mission")
    rig.fly(0.2)
    assert rig.heard("no item of it flies anywhere")


def test_items_are_checked(rig):
    check = rig.firmware.check_item
    for expected, bad in (
        (0, item(3, 16, 1.0, 1.0, -1.0)),
        (0 if ardupilot(rig) else 3, item(3, 82, 1.0, 1.0, -1.0)),
        (3 if ardupilot(rig) else 0, item(3, 4501, 1.0, 1.0, -1.0)),
        (0, item(3, 2000)),
        (0, item(3, 189)),
        (3, item(3, 183)),
        (3, item(3, 2500)),
        (12, item(3, 31, 1.0, 1.0, math.inf)),
        (2, item(3, 16, 1.0, 1.0, 1.0, frame=4)),
        (10, item(3, 16, NAN, 1.0, -1.0)),
        (11, item(3, 16, 1.0, math.inf, -1.0)),
        (12, item(3, 16, 1.0, 1.0, NAN)),
        (10, item(3, 16, 0.0, 200.0, 1.0, frame=3)),
        (10, item(3, 16, 1e6, 1.0, -1.0)),
        (6, item(3, 16, 1.0, 1.0, -1.0, (-1, 0, 0, 0))),
        (6, item(3, 19, 1.0, 1.0, -1.0, (math.inf, 0, 0, 0))),
        (6, item(3, 177, params=(3, 1, 0, 0))),
        (7, item(3, 178, params=(1, NAN, 0, 0))),
        (6, item(3, 93, params=(-1, 0, 0, 0))),
    ):
        assert check(0, bad) == expected, bad
    assert check(1, item(0, 16)) == 3
    assert check(1, item(0, 5001, 1.0, 1.0, params=(2, 0, 0, 0))) == 6
    assert check(1, item(0, 5003, 1.0, 1.0, params=(NAN, 0, 0, 0))) == 6
    assert check(1, item(0, 5003, NAN, 1.0, params=(1, 0, 0, 0))) == 10
    assert check(1, item(0, 5003, 1.0, 1.0, params=(1, 0, 0, 0), frame=2)) == 2
    assert check(2, item(0, 5100, *ZURICH[:2], 1.0, frame=3)) == 0
    assert check(2, item(0, 16)) == 3
    assert check(2, item(0, 5100, 0.0, 0.0, 1.0, frame=3)) == 10
    assert check(2, item(0, 5100, 0.0, 0.0, -1.0)) == 0, "the site's own origin is a place"


def test_a_bad_upload_leaves_the_old_plan(rig):
    good = [item(0, 16, 1.0, 0.0, -1.0), item(0, 20)]
    assert upload(rig, good) == 0
    before = rig.firmware.plan(0)
    first = rig.firmware.plans.mission.first
    assert upload(rig, [item(0, 16, NAN, 0.0, 0.0)]) == 10
    assert upload(rig, [item(0, 177, params=(9, 1, 0, 0))]) == 6
    assert rig.firmware.accept_plan(0, [item(5, 16, 1.0, 0.0, -1.0), item(4, 20)]) == 13
    assert rig.firmware.plan(0)[first:] == before[first:]
    ring = [item(k, 5001, x, y, params=(3, 0, 0, 0)) for k, (x, y) in enumerate(((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))]
    assert rig.firmware.accept_plan(1, ring) == 0
    assert rig.firmware.accept_plan(1, ring[:2]) == 1
    assert rig.firmware.accept_plan(1, [ring[0], item(1, 5002, 1.0, 1.0, params=(3, 0, 0, 0))]) == 1
    assert rig.firmware.plan(1) == ring
    assert rig.firmware.clear_plan(1) == 0
    assert rig.firmware.plan(1) == []
    assert rig.firmware.accept_plan(2, [item(0, 5100, 1.0, 1.0, -1.0)]) == 0
    assert len(rig.firmware.plan(2)) == 1


def test_home_stands_at_item_0_of_arducopter(rigs):
    rig = rigs("ardupilot")
    (home,) = rig.firmware.plan(0)
    assert math.dist((home.x, home.y), ZURICH[:2]) < 1e-5
    assert rig.report.mission_count == 1
    assert rig.mode("mission").result is Ack.FAILED
    assert rigs("px4").firmware.plan(0) == []


def test_clearing_the_mission_in_flight_hovers(rig):
    upload(rig, [item(0, 16, 5.0, 0.0, -1.0), item(0, 20)])
    start(rig)
    rig.fly(4.0)
    assert rig.firmware.clear_plan(0) == 0
    rig.fly(3.0)
    there = rig.true_ned
    rig.fly(2.0)
    assert math.dist(rig.true_ned, there) < 0.2
    assert there[2] < -0.5
    assert rig.report.armed


def test_what_lies_above_the_ceiling_is_flown_lower(rigs):
    rig = rigs("px4", ceiling_m=2.5)
    upload(rig, [item(0, 16, 0.5, 0.0, -9.0, (0, 0, 0, NAN)), item(0, 21)])
    assert rig.heard("below the ceiling")
    start(rig)
    assert rig.fly(15, lambda: rig.off(0.5, 0.0, -2.1) < 0.15)
