"""Any sequence of commands, modes, setpoints, parameters and uploads: it never raises, and it stays in the air."""

import math

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from sim.autopilot.commands import COMMANDS
from sim.autopilot.defaults import ARDUPILOT_PARAMS, PX4_PARAMS
from sim.autopilot.interface import Ack, AttitudeSetpoint, Command, PositionTarget
from tests.sim.autopilot.rig import ZURICH, Rig, item

NUMBERS = st.one_of(
    st.sampled_from([0.0, 1.0, -1.0, 2.0, 0.5, -1.5, 21196.0, math.nan, math.inf, -math.inf, 1e30, -1e-30, *ZURICH]),
    st.floats(-5.0, 5.0),
    st.floats(),
)
TRIPLES = st.tuples(NUMBERS, NUMBERS, NUMBERS)
QUADS = st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS)
FRAMES = st.sampled_from([0, 1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 20, 255])
MASKS = st.one_of(st.sampled_from([0x9F8, 0x9C7, 0x5C7, 0x9C0, 0xDF8, 0xDC7, 0xC3F, 0]), st.integers(0, 0xFFFF))
MODES = st.sampled_from(
    [0, 2, 3, 4, 5, 6, 9, 16, 17, 21, *(main << 16 | sub << 24 for main in range(8) for sub in range(7))]
)
NAMES = st.sampled_from(sorted({param.name for param in (*ARDUPILOT_PARAMS, *PX4_PARAMS)}))
ITEMS = st.builds(
    lambda command, xyz, params, frame: (command, *xyz, params, frame),
    st.sampled_from(
        [
            16,
            17,
            18,
            19,
            20,
            21,
            22,
            93,
            115,
            177,
            178,
            179,
            195,
            197,
            201,
            31,
            82,
            189,
            206,
            1000,
            2000,
            5001,
            5002,
            5003,
            5100,
        ]
    ),
    st.one_of(TRIPLES, st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 0))),
    QUADS,
    st.sampled_from([1, 3, 6, 2]),
)
OPS = st.one_of(
    st.tuples(st.just("command"), st.sampled_from([*COMMANDS, 512, 9999]), QUADS, TRIPLES, st.none() | FRAMES),
    st.tuples(st.just("mode"), st.sampled_from([0, 1, 81, 129]), MODES),
    st.tuples(st.just("target"), FRAMES, MASKS, TRIPLES, TRIPLES, TRIPLES, NUMBERS),
    st.tuples(st.just("place"), st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(-3, 0))),
    st.tuples(st.just("attitude"), st.integers(0, 255), QUADS, TRIPLES, NUMBERS),
    st.tuples(st.just("param"), NAMES, NUMBERS),
    st.tuples(st.just("plan"), st.sampled_from([0, 1, 2]), st.lists(ITEMS, max_size=5)),
    st.tuples(st.just("pose"), TRIPLES, st.none() | NUMBERS),
    st.tuples(st.just("origin"), TRIPLES),
    st.tuples(st.just("manual"), QUADS),
    st.tuples(st.just("current"), st.integers(-2, 8)),
    st.tuples(st.just("station")),
    st.tuples(st.just("takeoff")),
)


def _command(rig: Rig, id, params, xyz, frame) -> None:
    assert isinstance(rig.firmware.command(Command(id, params, *xyz, frame), rig.now_s).result, Ack)


def _place(rig: Rig, place) -> None:
    rig.target(mask=0xDF8, position=place)
    rig.firmware.set_mode(1, rig.firmware.now.row.modes["offboard"], rig.now_s)


def _plan(rig: Rig, which, items) -> None:
    rig.firmware.accept_plan(which, [item(k, *one) for k, one in enumerate(items)])
    assert isinstance(rig.firmware.plan(which), list)


def _takeoff(rig: Rig) -> None:
    first = "offboard" if rig.firmware.now.row.home_is_item_0 else "hold"
    rig.firmware.set_mode(1, rig.firmware.now.row.modes[first], rig.now_s)
    rig.do(400, 1, 21196)
    rig.do(22, x=math.nan, y=math.nan, z=1.0, frame=3)


DEEDS = {
    "command": _command,
    "mode": lambda rig, *rest: rig.firmware.set_mode(*rest, rig.now_s),
    "target": lambda rig, *rest: rig.firmware.position_target(PositionTarget(*rest, 0.5), rig.now_s),
    "place": _place,
    "attitude": lambda rig, *rest: rig.firmware.attitude_target(AttitudeSetpoint(*rest), rig.now_s),
    "param": lambda rig, *rest: rig.firmware.set_param(*rest),
    "plan": _plan,
    "pose": lambda rig, *rest: rig.firmware.external_pose(*rest, rig.now_s),
    "origin": lambda rig, where: rig.firmware.set_origin(*where),
    "manual": lambda rig, sticks: rig.firmware.manual(*sticks, rig.now_s, 255),
    "current": lambda rig, seq: rig.firmware.set_current(seq),
    "station": lambda rig: rig.firmware.heard_station(rig.now_s, 255),
    "takeoff": _takeoff,
}


def do(rig: Rig, op) -> None:
    DEEDS[op[0]](rig, *op[1:])


def look(rig: Rig, was_armed: bool) -> None:
    """What must hold whatever was asked."""
    report = rig.report
    estimate = report.estimate
    for number in (*estimate.position_ned_m, *estimate.velocity_ned_mps, *estimate.attitude, *rig.true_ned):
        assert math.isfinite(number)
    said = [text.lower() for _, text in rig.firmware.texts()]
    meant = any(word in text for text in said for word in ("killed", "terminated", "crash"))
    if was_armed and not report.armed and not meant:
        assert rig.true_ned[2] > -0.25 or rig.vehicle.tipped, (said, rig.true_ned)
    assert report.target_ned_m is None or all(map(math.isfinite, report.target_ned_m))
    assert report.system_status in (3, 4, 5)
    assert report.mission_current <= report.mission_count
    rig.firmware.reached(), rig.firmware.progress(), rig.firmware.changed_params()


@settings(
    max_examples=45,
    deadline=None,
    derandomize=True,
    phases=(Phase.explicit, Phase.generate),  # a shorter script takes minutes to find
    suppress_health_check=list(HealthCheck),
)
@given(
    st.sampled_from(["ardupilot", "px4"]),
    st.sampled_from(["fused", "none"]),
    st.sampled_from([math.inf, 2.5]),
    st.booleans(),
    st.lists(st.tuples(OPS, st.sampled_from([0.02, 0.1, 0.5, 1.5])), min_size=12, max_size=25),
)
def test_whatever_is_asked_it_neither_raises_nor_falls(name, gps, ceiling_m, begins_in_the_air, script):
    rig = Rig(name, gps, ceiling_m, settle_s=0.3)
    try:
        if begins_in_the_air:
            do(rig, ("takeoff",))
            rig.fly(2.0)
        for op, span_s in script:
            was_armed = rig.report.armed
            do(rig, op)
            look(rig, was_armed)
            was_armed = rig.report.armed
            for _ in range(max(1, round(span_s / 0.1))):
                rig.fly(min(span_s, 0.1))
                look_after(rig, was_armed)
                was_armed = rig.report.armed
    finally:
        rig.close()


def look_after(rig: Rig, was_armed: bool) -> None:
    """Texts that the rig took in while it flew count as well."""
    rig.firmware.now.said = rig.said + rig.firmware.now.said
    rig.said = []
    look(rig, was_armed)
