"""Whatever is refused leaves the vehicle flying what it flew."""

import copy
import math

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from sim.autopilot.commands import COMMANDS
from sim.autopilot.conduct import Conduct
from sim.autopilot.interface import Ack, Answer, Command
from tests.sim.autopilot.rig import NAN, Rig, item
from tests.sim.autopilot.test_fuzz import ITEMS, MODES, NAMES, NUMBERS, do

_OK = (Ack.ACCEPTED, Ack.IN_PROGRESS)


def flown(conduct: Conduct) -> str:
    """Everything that says what is flown, as text, for NaN equals nothing."""
    now, mission = conduct.now, conduct.plans.mission
    return repr(
        (
            now.mode, now.custom_mode, now.armed, now.home_ned_m, now.home_kept, now.home_heading_rad, now.origin, now.speed_mps,
            now.region_ned_m, now.rally_ned_m, now.params.all(), conduct.activity, conduct.stream, conduct.waiting,
            mission.items, mission.current, mission.finished, conduct.plans.fence, conduct.failsafes.engaged,
        )
    )  # fmt: skip


def accepted(rig: Rig, op) -> bool:
    """Do it; whether it was taken."""
    firmware, kind, rest = rig.firmware, op[0], op[1:]
    if kind == "command":
        id, params, xyz, frame = rest
        answer: Answer = firmware.command(Command(id, params, *xyz, frame), rig.now_s)
        return answer.result in _OK
    if kind == "mode":
        return firmware.set_mode(*rest, rig.now_s).result in _OK
    if kind == "param":
        return not isinstance(firmware.set_param(*rest), str)
    which, items = rest
    return firmware.accept_plan(which, [item(k, *one) for k, one in enumerate(items)]) == 0


FINITE = st.sampled_from([0.0, 1.0, 2.0, -1.0, 0.5, 90.0])
MIXED = st.one_of(FINITE, FINITE, NUMBERS)
COMMAND = st.tuples(
    st.just("command"),
    st.sampled_from([*COMMANDS, 512, 9999]),
    st.tuples(MIXED, MIXED, MIXED, MIXED),
    st.tuples(MIXED, MIXED, MIXED),
    st.sampled_from([None, None, 0, 1, 2, 3, 6]),
)
ASKED = st.one_of(
    COMMAND,
    COMMAND,
    st.tuples(st.just("mode"), st.sampled_from([0, 1]), MODES),
    st.tuples(st.just("param"), NAMES, NUMBERS),
    st.tuples(st.just("plan"), st.sampled_from([0, 1, 2]), st.lists(ITEMS, min_size=1, max_size=3)),
)
BEGUN = st.sampled_from(["ground", "hold", "offboard", "mission", "land", "return", "position"])


@settings(
    max_examples=40,
    deadline=None,
    derandomize=True,
    phases=(Phase.explicit, Phase.generate),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.large_base_example],
)
@given(st.sampled_from(["ardupilot", "px4"]), BEGUN, st.lists(ASKED, min_size=10, max_size=40))
def test_what_is_refused_changes_nothing(name, begun, script):
    rig = Rig(name, settle_s=0.3)
    try:
        rig.firmware.accept_plan(0, [item(k, 16, 1.0, 0.0, -1.0) for k in range(3)])
        assert rig.do(195, x=5.0, y=5.0, z=0.0, frame=1).result is Ack.ACCEPTED
        if begun != "ground":
            do(rig, ("takeoff",))
            rig.fly(1.5)
            rig.target(position=(0.0, 0.0, -1.0))
            assert rig.mode(begun).result is Ack.ACCEPTED
            assert rig.report.landed_state != 1
            rig.fly(0.1)
        for op in script:
            before = flown(rig.firmware)
            if not accepted(rig, op):
                assert flown(rig.firmware) == before, op
            rig.fly(1 / 60)
    finally:
        rig.close()


def test_a_refused_turn_leaves_the_region_of_interest(rig):
    rig.take_off(1.0)
    assert rig.do(195, x=-5.0, y=0.0, z=0.0, frame=1).result is Ack.ACCEPTED
    rig.mode("return")
    assert rig.do(115, 90.0).result is rig.firmware.now.row.refused
    assert rig.firmware.now.region_ned_m == (-5.0, 0.0, 0.0)


def test_refused_setpoints_leave_the_stream(rig):
    rig.take_off(1.0)
    rig.offboard(position=(1.0, 0.0, -1.0))
    rig.fly(0.2)
    rig.every = None
    before = copy.deepcopy((rig.firmware.activity, rig.firmware.stream))
    for position in ((NAN, 0.0, -1.0), (0.0, math.inf, -1.0), (1e6, 0.0, 0.0)):
        rig.target(position=position)
    assert (rig.firmware.activity, rig.firmware.stream) == before


@pytest.mark.parametrize("unit", [3.5, -0.5, 1e30])
def test_no_sensor_fails_for_half_a_number(rig, unit):
    rig.firmware.set_param("SYS_FAILURE_EN", 1)
    assert rig.do(420, unit, 1).result is Ack.UNSUPPORTED
