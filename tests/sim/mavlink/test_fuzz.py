"""Whatever bytes come, and whatever a well-formed message holds: nothing raises, and the vehicle goes on."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mav

from tests.sim.mavlink.bed import Bed

BITS = {"uint8_t": 8, "int8_t": 8, "uint16_t": 16, "int16_t": 16, "uint32_t": 32, "int32_t": 32}
COMMANDS = [16, 20, 21, 22, 84, 92, 112, 115, 176, 178, 179, 192, 193, 195, 201, 206, 207, 224, 246, 300, 400, 410, 420]
COMMANDS += [510, 511, 512, 519, 520, 521, 1000, 1001, 2000, 2001, 5001, 42003]
FLOATS = st.one_of(
    st.floats(width=32),
    st.sampled_from([0.0, 1.0, -1.0, 2.0, 4.0, 21196.0, math.nan, math.inf, -math.inf, 3e38, 1e-40, 30.0, 33.0, 242.0]),
)


def field(name: str, kind: str, length: int):
    if kind == "char":
        names = [b"SIM_BAT_DRAIN", b"FENCE_ENABLE", b"GF_ACTION", b"\xff\xfe", b""]
        return st.one_of(st.binary(max_size=length or 1), st.sampled_from([n[: length or 1] for n in names]))
    if kind in ("float", "double"):
        one = FLOATS
    else:
        bits = BITS.get(kind, 64)
        least, most = (0, 2**bits - 1) if kind.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        one = st.one_of(st.integers(least, most), st.integers(0, 6), st.sampled_from([least, most]))
        if name in ("target_system", "target"):
            one = st.sampled_from([1, 1, 1, 0, 7])
        elif name == "target_component":
            one = st.sampled_from([1, 1, 1, 0, 100, 154, 9])
        elif name == "command" and bits == 16:
            one = st.one_of(st.sampled_from(COMMANDS), st.integers(0, 65535))
    return st.lists(one, min_size=length, max_size=length) if length else one


def well_formed(message_id: int):
    kind = mav.mavlink_map[message_id]
    lengths = dict(zip(kind.ordered_fieldnames, kind.array_lengths, strict=True))
    fields = [field(name, typ, lengths[name]) for name, typ in zip(kind.fieldnames, kind.fieldtypes, strict=True)]
    return st.tuples(*fields).map(lambda values: kind(*values))


with Bed("ardupilot") as _bed:
    HANDLED = _bed.endpoint.nodes[0].handled()
MESSAGES = st.one_of(
    st.sampled_from(HANDLED).flatmap(well_formed),
    st.sampled_from([75, 76]).flatmap(well_formed),
    st.sampled_from(sorted(mav.mavlink_map)).flatmap(well_formed),
)
INPUT = st.lists(st.one_of(MESSAGES, st.binary(max_size=300)), max_size=25)


@pytest.fixture(scope="module", params=["ardupilot", "px4"])
def flying(request):
    with Bed(request.param) as bed:
        client = bed.client()
        client.fly()
        yield bed


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(inputs=INPUT, kind=st.sampled_from(["tcp", "udp"]))
def test_anything_may_come(flying, inputs, kind):
    client = flying.clients[0]
    vandal = flying.client(kind, 99)
    vandal.beats = False
    for each in inputs:
        vandal.write(each if isinstance(each, bytes) else each.pack(vandal.mav))
        vandal.mav.seq = (vandal.mav.seq + 1) % 256
    flying.advance(0.1)
    flying.clients.remove(vandal)
    vandal.socket.close()
    client.forget()
    flying.advance(1.1)
    assert [m for m in client.all("HEARTBEAT") if m.get_srcComponent() == 1]
    estimate = flying.firmware.telemetry(flying.flight.now_s).estimate
    assert all(map(math.isfinite, (*estimate.position_ned_m, *estimate.velocity_ned_mps)))
