"""Where it will not be sent, and what the places that it was given stay."""

import pytest

from sim.autopilot.interface import Ack
from tests.sim.autopilot.rig import NAN, ZURICH, ardupilot, item, put


def fenced(rig) -> None:
    """Within two metres of the origin, and not near its north-east."""
    corners = ((-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0))
    ring = [item(k, 5001, x, y, params=(4, 0, 0, 0)) for k, (x, y) in enumerate(corners)]
    assert rig.firmware.accept_plan(1, [*ring, item(4, 5004, 1.5, 1.5, params=(0.4, 0, 0, 0))]) == 0
    put(rig, **({"FENCE_ENABLE": 1} if ardupilot(rig) else {"GF_ACTION": 3}))


@pytest.mark.parametrize(("x", "y", "words"), [(30.0, 0.0, "inclusion zone"), (1.5, 1.5, "exclusion zone")])
def test_is_not_sent_across_its_fence(rig, x, y, words):
    fenced(rig)
    rig.take_off(1.0)
    assert rig.do(192, -1, 1, NAN, NAN, x=x, y=y, z=-1.0, frame=1).result is Ack.DENIED
    assert rig.heard(f"beyond the fence: {words}")
    assert rig.do(252, 0, 3, 1, NAN, x=x, y=y, z=-1.0).result is Ack.DENIED
    rig.fly(2.0)
    assert rig.off(0.0, 0.0, -1.0) < 0.3
    assert rig.report.system_status == 4
    assert rig.do(192, -1, 1, NAN, NAN, x=1.0, y=0.0, z=-1.0, frame=1).result is Ack.ACCEPTED
    assert rig.fly(6, lambda: rig.off(1.0, 0.0, -1.0) < 0.2)


def test_is_not_sent_higher_or_farther_than_allowed(rig):
    if ardupilot(rig):
        put(rig, FENCE_ENABLE=1, FENCE_ALT_MAX=3.0, FENCE_RADIUS=5.0)
    else:
        put(rig, GF_MAX_VER_DIST=3.0, GF_MAX_HOR_DIST=5.0)
    rig.take_off(1.0)
    for x, z, words in ((0.0, -4.0, "maximum altitude"), (6.0, -1.0, "maximum distance")):
        assert rig.do(192, -1, 1, NAN, NAN, x=x, y=0.0, z=z, frame=1).result is Ack.DENIED
        assert rig.heard(words)


def test_a_fence_that_is_switched_off_keeps_nobody(rigs):
    rig = rigs("ardupilot")
    fenced(rig)
    put(rig, FENCE_ENABLE=0)
    rig.take_off(1.0)
    assert rig.do(192, -1, 1, NAN, NAN, x=3.0, y=0.0, z=-1.0, frame=1).result is Ack.ACCEPTED


@pytest.mark.parametrize("action", [0, 1])
def test_a_fence_of_px4_that_only_warns_keeps_nobody(rigs, action):
    rig = rigs("px4")
    fenced(rig)
    put(rig, GF_ACTION=action)
    rig.take_off(1.0)
    assert rig.do(192, -1, 1, NAN, NAN, x=3.0, y=0.0, z=-1.0, frame=1).result is Ack.ACCEPTED
    assert rig.fly(6, lambda: rig.off(3.0, 0.0, -1.0) < 0.2)
    assert rig.heard("inclusion zone") is bool(action)


def test_an_origin_is_not_moved_under_an_armed_vehicle(rigs):
    for name in ("ardupilot", "px4"):
        rig = rigs(name, gps="none")
        rig.every = lambda rig=rig: rig.firmware.external_pose(rig.true_ned, 0.0, rig.now_s)
        rig.fly(2.0)
        assert rig.firmware.set_origin(*ZURICH)
        assert rig.firmware.set_origin(ZURICH[0], ZURICH[1] + 0.001, 500.0)
        assert rig.firmware.set_origin(*ZURICH)
        rig.take_off(1.0)
        assert rig.firmware.set_origin(*ZURICH)  # the same again is nothing new
        assert not rig.firmware.set_origin(0.0, 0.0, 0.0)
        assert rig.heard("Origin refused: it is armed")
        assert rig.report.origin == ZURICH
