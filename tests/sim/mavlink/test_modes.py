"""The standard modes protocol and the protocol version: asked for, streamed, and chosen by standard mode."""

import struct

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav
from pymavlink.dialects.v20 import development

from tests.sim.mavlink.bed import Bed


@pytest.fixture
def px4():
    with Bed("px4") as bed:
        client = bed.client()
        client.reader = development.MAVLink(None)
        client.reader.robust_parsing = True
        yield client


def test_every_mode_is_listed_once(px4):
    assert px4.command(mav.MAV_CMD_REQUEST_MESSAGE, 435, 0) == 0
    px4.bed.advance(0.1)
    rows = px4.all("AVAILABLE_MODES")
    assert [row.mode_index for row in rows] == list(range(1, len(rows) + 1))
    assert {row.number_modes for row in rows} == {len(rows)}
    assert all(bool(row.mode_name) != bool(row.standard_mode) for row in rows), "standard modes go without a name"
    row = px4.bed.firmware.now.row
    assert {each.custom_mode for each in rows} >= set(row.modes.values())
    assert all(row.mode(each.custom_mode) for each in rows), "each can be chosen"
    px4.forget()
    assert px4.command(mav.MAV_CMD_REQUEST_MESSAGE, 435, 5) == 0
    px4.bed.advance(0.1)
    assert [row.mode_name for row in px4.all("AVAILABLE_MODES")] == ["Hold"]
    for wrong in (len(rows) + 1, -1, 0.5, float("inf")):
        assert px4.command(mav.MAV_CMD_REQUEST_MESSAGE, 435, wrong) == mav.MAV_RESULT_DENIED


def test_a_standard_mode_is_chosen_and_told(px4):
    px4.bed.advance(3.0)
    assert px4.command(mav.MAV_CMD_DO_SET_STANDARD_MODE, mav.MAV_STANDARD_MODE_POSITION_HOLD) == 0
    px4.wait("CURRENT_MODE", such=lambda m: m.standard_mode == mav.MAV_STANDARD_MODE_POSITION_HOLD)
    assert px4.wait("HEARTBEAT", such=lambda m: m.get_srcComponent() == 1).custom_mode == 3 << 16
    assert px4.command(mav.MAV_CMD_DO_SET_STANDARD_MODE, 77) == mav.MAV_RESULT_DENIED
    assert px4.command(mav.MAV_CMD_DO_SET_STANDARD_MODE, 0) == mav.MAV_RESULT_DENIED, "which is no mode of its own"
    px4.wait("AVAILABLE_MODES_MONITOR", 4.0)


def test_who_does_not_know_the_protocol_says_so():
    with Bed("ardupilot") as bed:
        client = bed.client()
        for message_id in (435, 436, 437):
            assert client.command(mav.MAV_CMD_REQUEST_MESSAGE, message_id) == mav.MAV_RESULT_UNSUPPORTED
        assert client.command(mav.MAV_CMD_DO_SET_STANDARD_MODE, 1) == mav.MAV_RESULT_UNSUPPORTED
        assert client.command(mav.MAV_CMD_SET_MESSAGE_INTERVAL, 436, 1e5) == mav.MAV_RESULT_DENIED


@pytest.mark.parametrize("asking", [(mav.MAV_CMD_REQUEST_PROTOCOL_VERSION, 1), (mav.MAV_CMD_REQUEST_MESSAGE, 300)])
def test_versions_that_it_speaks(bed, asking):
    client = bed.client()
    assert client.command(*asking) == 0
    frame = bytes(client.wait("UNKNOWN_300").get_msgbuf())
    payload = frame[10 : 10 + frame[1]].ljust(22, b"\0")  # zeros at the end do not travel
    assert struct.unpack("<HHH", payload[:6]) == (200, 100, 200)
    assert client.command(mav.MAV_CMD_REQUEST_PROTOCOL_VERSION, 0) == mav.MAV_RESULT_DENIED


@pytest.mark.parametrize(
    ("firmware", "mode", "base_mode"),
    [("ardupilot", "stabilize", 81), ("ardupilot", "offboard", 89), ("px4", "hold", 29), ("px4", "position", 81)],
)
def test_the_base_mode_is_as_the_firmware_has_it(firmware, mode, base_mode):
    with Bed(firmware) as bed:
        client = bed.client()
        bed.advance(3.0)
        bed.firmware.set_mode(1, bed.firmware.now.row.modes[mode], bed.flight.now_s)
        client.forget()
        assert client.wait("HEARTBEAT", such=lambda m: m.get_srcComponent() == 1).base_mode == base_mode
