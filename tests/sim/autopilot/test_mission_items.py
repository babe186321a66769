"""Mission items beyond waypoints: heights, curves, gates, and what is for camera and gimbal."""

import math

import pytest

from tests.sim.autopilot.rig import NAN, item, start, upload


def test_loiters_to_a_height(rig):
    """First across, as high as it is, then straight up or down."""
    upload(rig, [item(0, 22, z=1.0, frame=3), item(0, 31, 2.0, 0.0, -2.0, (0, 0, 0, NAN)), item(0, 17, 2.0, 0.0, -2.0)])
    first = rig.firmware.plans.mission.first
    start(rig)
    assert rig.fly(15, lambda: rig.true_ned[0] > 1.5)
    assert abs(rig.true_ned[2] + 1.0) < 0.3
    assert rig.fly(15, lambda: rig.report.mission_current == first + 2)
    assert rig.off(2.0, 0.0, -2.0) < 0.3


def test_flies_splines_without_stopping_on_a_round_way(rigs):
    rig = rigs("ardupilot")
    corners = [(3.0, 0.0), (3.0, 3.0), (0.0, 3.0), (0.0, 0.0)]
    upload(rig, [item(0, 16, 0.0, 0.0, -1.5), *(item(0, 82, x, y, -1.5) for x, y in corners)])
    first = rig.firmware.plans.mission.first
    start(rig)
    assert rig.fly(15, lambda: rig.report.mission_current == first + 2), rig.true_ned
    way, speeds = [], []

    def over() -> bool:
        way.append(rig.true_ned)
        speeds.append(math.hypot(*rig.report.estimate.velocity_ned_mps))
        return rig.report.mission_current > first + 3

    assert rig.fly(20, over), (rig.report.mission_current, rig.true_ned)
    for corner in corners[1:3]:
        assert min(math.dist(at[:2], corner) for at in way) < 0.4
    assert min(speeds) > 0.3, "it does not stop at the places in between"
    assert max(at[0] for at in way) > 3.1, "it swings out between them"
    assert all(abs(at[2] + 1.5) < 0.25 for at in way)
    assert rig.fly(20, lambda: rig.firmware.plans.mission.finished)
    rig.fly(1.5)
    assert rig.off(0.0, 0.0, -1.5) < 0.25


def test_hands_on_what_is_for_camera_and_gimbal(rig):
    """In their order and when they are reached, the one between two places before the second."""
    items = [
        item(0, 189, frame=2),
        item(0, 16, 0.5, 0.0, -1.0, (0, 0, 0, NAN)),
        item(0, 1000, params=(-45, 0, NAN, NAN), frame=2),
        item(0, 2000, params=(0, 0, 1, 0), frame=2),
        item(0, 16, 1.5, 0.0, -1.0, (0, 0, 0, NAN)),
        item(0, 203, x=1.0, frame=2),
    ]
    assert upload(rig, items) == 0
    start(rig)
    wanted = []

    def over() -> bool:
        wanted.extend((command.id, command.params[0], command.x, rig.true_ned[0]) for command in rig.firmware.payload())
        return rig.firmware.plans.mission.finished

    assert rig.fly(30, over)
    over()
    assert [each[:3] for each in wanted] == [(1000, -45, 0.0), (2000, 0, 0.0), (203, 0.0, 1.0)]
    assert [round(each[3], 1) for each in wanted] == [
        pytest.approx(0.5, abs=0.3), pytest.approx(0.5, abs=0.3), pytest.approx(1.5, abs=0.3)
    ]  # fmt: skip
    assert rig.firmware.payload() == []


def test_passes_the_gates_of_a_survey_without_stopping(rigs):
    """What lies beside its way is passed, not flown to: pictures begin there."""
    rig = rigs("px4")
    items = [
        item(0, 16, 0.0, 0.0, -1.5, (0, 0, 0, NAN)),
        item(0, 4501, 1.0, 0.5, -1.5),
        item(0, 206, params=(0.5, 0, 1, 0), frame=2),
        item(0, 16, 4.0, 0.0, -1.5, (0, 0, 0, NAN)),
        item(0, 4501, 4.0, 0.0, -1.5),
        item(0, 206, frame=2),
    ]
    assert upload(rig, items) == 0
    start(rig)
    begun, side = [], []

    def over() -> bool:
        begun.extend((rig.true_ned[0], rig.report.estimate.velocity_ned_mps[0]) for _ in rig.firmware.payload())
        side.append(abs(rig.true_ned[1]))
        return rig.firmware.plans.mission.finished

    assert rig.fly(30, over)
    over()
    assert begun[0][0] == pytest.approx(0.9, abs=0.4)
    assert begun[0][1] > 0.5, "it flies on"
    assert begun[1][0] == pytest.approx(4.0, abs=0.4)
    assert max(side) < 0.3
