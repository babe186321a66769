"""The geofence: crossed, it is announced and acted upon; the ceiling is a fence too."""

import math

import pytest

from sim.autopilot.interface import Ack
from tests.sim.autopilot.rig import ZURICH, ardupilot, item, put


def ring(kind: int, size: float):
    corners = ((-size, -size), (size, -size), (size, size), (-size, size))
    return [item(k, kind, x, y, params=(4, 0, 0, 0)) for k, (x, y) in enumerate(corners)]


@pytest.mark.parametrize(
    ("plan", "words"),
    [
        (ring(5001, 1.0), "inclusion zone"),
        ([item(0, 5003, *ZURICH[:2], params=(1.0, 0, 0, 0), frame=5)], "inclusion zone"),
        ([item(0, 5004, 2.0, 0.0, params=(1.0, 0, 0, 0))], "exclusion zone"),
        ([item(k, 5002, x, y, params=(3, 0, 0, 0)) for k, (x, y) in enumerate(((1, -1), (3, 0), (1, 1)))], "exclusion"),
    ],
)
def test_crossing_a_fence(rig, plan, words):
    assert rig.firmware.accept_plan(1, plan) == 0
    put(rig, **({"FENCE_ENABLE": 1, "FENCE_ACTION": 2} if ardupilot(rig) else {"GF_ACTION": 5}))
    rig.take_off(1.0)
    rig.offboard(mask=0xDC7, velocity=(0.8, 0.0, 0.0))
    assert rig.fly(4, lambda: rig.in_mode("land"))
    assert 0.8 < rig.true_ned[0] < 1.5
    assert rig.heard(words)
    assert words in rig.report.fence_breach
    assert rig.report.fence_breaches == 1
    assert not rig.report.health & 0x100000
    assert rig.report.system_status == 5


@pytest.mark.parametrize(("limit", "velocity"), [("distance", (0.8, 0.0, 0.0)), ("altitude", (0.0, 0.0, -0.5))])
def test_the_farthest_and_the_highest(rig, limit, velocity):
    names = {"distance": ("FENCE_RADIUS", "GF_MAX_HOR_DIST"), "altitude": ("FENCE_ALT_MAX", "GF_MAX_VER_DIST")}[limit]
    put(rig, **{names[0 if ardupilot(rig) else 1]: 1.5})
    put(rig, **({"FENCE_ENABLE": 1} if ardupilot(rig) else {"GF_ACTION": 3}))
    rig.take_off(1.0)
    rig.offboard(mask=0xDC7, velocity=velocity)
    assert rig.fly(4, lambda: rig.in_mode("return"))
    assert rig.heard(f"maximum {limit}")
    assert rig.fly(25, lambda: not rig.report.armed)
    assert math.hypot(*rig.true_ned[:2]) < 0.5


def test_climbing_towards_the_ceiling_ends_below_it(rigs):
    for name in ("ardupilot", "px4"):
        rig = rigs(name, ceiling_m=2.5)
        rig.take_off(1.0)
        rig.offboard(mask=0xDC7, velocity=(0.0, 0.0, -2.0))
        rig.fly(5.0)
        assert -2.25 < rig.true_ned[2] < -1.8
        rig.stream(position=(0.0, 0.0, -50.0))
        rig.fly(3.0)
        assert -2.25 < rig.true_ned[2] < -1.9
        assert rig.report.system_status == 4


def test_the_ceiling_is_a_fence_for_who_flies_by_thrust(rigs):
    rig = rigs("px4", ceiling_m=3.0)
    put(rig, GF_ACTION=5)
    rig.take_off(1.5)
    assert rig.mode("stabilize").result is Ack.ACCEPTED
    rig.every = lambda: rig.firmware.manual(0.0, 0.0, 0.65, 0.0, rig.now_s, 255)
    assert rig.fly(5, lambda: rig.in_mode("land"))
    assert rig.heard("ceiling")


def test_arducopter_switches_its_fence_by_command(rigs):
    rig = rigs("ardupilot")
    assert rig.do(207, 1).result is Ack.ACCEPTED
    assert [(param.name, param.value) for param in rig.firmware.changed_params()] == [("FENCE_ENABLE", 1.0)]
    assert rig.do(207, 5).result is Ack.DENIED
    assert rigs("px4").do(207, 1).result is Ack.UNSUPPORTED
