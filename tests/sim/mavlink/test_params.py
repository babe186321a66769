"""Parameters on the wire: list, read, set, both encodings, and refusals."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink.pack import bits_int, int_bits


def read(bed, message) -> float:
    whole = message.param_type == mav.MAV_PARAM_TYPE_INT32 and bed.firmware.now.row.name == "px4"
    return bits_int(message.param_value) if whole else message.param_value


def test_list_gives_every_parameter_once(bed):
    client = bed.client()
    client.mav.param_request_list_send(1, 1)
    bed.advance(3.0)
    values = client.all("PARAM_VALUE")
    there = bed.firmware.params()
    assert [v.param_index for v in values] == list(range(len(there)))
    assert {v.param_count for v in values} == {len(there)}
    assert {v.param_id: read(bed, v) for v in values} == {
        p.name: (p.value if p.integer else v.param_value) for p, v in zip(there, values, strict=True)
    }


def test_list_is_paced(bed):
    client = bed.client()
    client.mav.param_request_list_send(1, 1)
    bed.advance(0.05)
    assert 0 < len(client.all("PARAM_VALUE")) <= 25


def test_read_by_name_and_index(bed):
    client = bed.client()
    name = bed.firmware.params()[3].name
    client.mav.param_request_read_send(1, 1, name.encode(), -1)
    assert client.wait("PARAM_VALUE").param_index == 3
    client.forget()
    client.mav.param_request_read_send(1, 1, b"", 3)
    assert client.wait("PARAM_VALUE").param_id == name


def test_unknown_is_an_error(bed):
    client = bed.client()
    client.mav.param_request_read_send(1, 1, b"NO_SUCH", -1)
    assert client.wait("PARAM_ERROR").error == mav.MAV_PARAM_ERROR_DOES_NOT_EXIST
    client.forget()
    client.mav.param_set_send(1, 1, b"NO_SUCH", 1.0, mav.MAV_PARAM_TYPE_REAL32)
    assert client.wait("PARAM_ERROR").param_id == "NO_SUCH"
    client.forget()
    client.mav.param_request_read_send(1, 1, b"", 9999)
    assert client.wait("PARAM_ERROR").param_index == 9999


def test_set_is_echoed_to_everybody(bed):
    client, other = bed.client(), bed.client("udp", 200)
    other.wait("HEARTBEAT")
    client.mav.param_set_send(1, 1, b"SIM_BAT_DRAIN", 120.0, mav.MAV_PARAM_TYPE_REAL32)
    assert client.wait("PARAM_VALUE").param_value == 120.0
    assert other.wait("PARAM_VALUE").param_value == 120.0


def test_set_of_a_whole_number(bed):
    client = bed.client()
    px4 = bed.firmware.now.row.name == "px4"
    param = next(p for p in bed.firmware.params() if p.integer and not p.read_only and p.most >= 2)
    sent = int_bits(2) if px4 else 2.0
    client.mav.param_set_send(1, 1, param.name.encode(), sent, mav.MAV_PARAM_TYPE_INT32)
    assert read(bed, client.wait("PARAM_VALUE")) == 2
    assert next(p.value for p in bed.firmware.params() if p.name == param.name) == 2


def test_what_is_out_of_range_changes_nothing(bed):
    client = bed.client()
    for value in (-5.0, 1e30, math.nan, math.inf):
        client.forget()
        client.mav.param_set_send(1, 1, b"SIM_BAT_DRAIN", value, mav.MAV_PARAM_TYPE_REAL32)
        assert client.wait("PARAM_ERROR").error == mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE
        assert client.wait("PARAM_VALUE").param_value == 0.0
        bed.advance(1.1)
        assert any("SIM_BAT_DRAIN" in text for text in client.texts())


def test_px4_takes_each_parameter_by_its_own_type_only(bed):
    """ArduCopter converts."""
    client = bed.client()
    px4 = bed.firmware.now.row.name == "px4"
    whole = next(p for p in bed.firmware.params() if p.integer and not p.read_only and p.most >= 2)
    for name, sent, kind in (
        (whole.name, 2.0, mav.MAV_PARAM_TYPE_REAL32),
        ("SIM_BAT_DRAIN", int_bits(2) if px4 else 2.0, mav.MAV_PARAM_TYPE_INT32),
    ):
        before = next(p.value for p in bed.firmware.params() if p.name == name)
        client.forget()
        client.mav.param_set_send(1, 1, name.encode(), sent, kind)
        client.wait("PARAM_ERROR" if px4 else "PARAM_VALUE")
        assert next(p.value for p in bed.firmware.params() if p.name == name) == (before if px4 else 2.0)
        assert px4 is any(f"{name} is set with type" in text for text in client.texts())
