"""Commands and streams: one acknowledgement each, rates that can be asked for, modes."""

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink import streams
from tests.sim.mavlink.bed import Bed

NAN = math.nan


def acks(client) -> list[tuple[int, int]]:
    return [(ack.command, ack.result) for ack in client.all("COMMAND_ACK")]


def test_unknown_command_is_unsupported_once(bed):
    client = bed.client()
    assert client.command(31999, NAN, NAN) == mav.MAV_RESULT_UNSUPPORTED
    bed.advance(1.0)
    assert acks(client) == [(31999, mav.MAV_RESULT_UNSUPPORTED)]


def test_answer_goes_to_the_sender_alone(bed):
    client, other = bed.client(), bed.client("udp", 200)
    other.wait("HEARTBEAT")
    client.command(mav.MAV_CMD_REQUEST_MESSAGE, 148)
    ack = client.all("COMMAND_ACK")[0]
    assert (ack.target_system, ack.target_component) == (245, 190)
    assert (ack.get_srcSystem(), ack.get_srcComponent()) == (1, 1)
    assert client.wait("AUTOPILOT_VERSION").capabilities == bed.firmware.now.row.capabilities
    bed.advance(0.5)
    assert not other.all("COMMAND_ACK")
    assert not other.all("AUTOPILOT_VERSION")


def test_another_vehicle_and_an_absent_component_are_left_alone(bed):
    client = bed.client()
    for target in ((7, 1), (1, 42)):
        client.mav.command_long_send(*target, mav.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
    bed.advance(1.0)
    assert not client.all("COMMAND_ACK")


def test_to_everybody_is_for_it_too(bed):
    client = bed.client()
    assert client.command(mav.MAV_CMD_REQUEST_MESSAGE, 0, target=(0, 0)) == mav.MAV_RESULT_ACCEPTED


@pytest.mark.parametrize("wanted", [NAN, math.inf, -1, 1e30, 12345, 0.5])
def test_message_that_does_not_exist(bed, wanted):
    client = bed.client()
    assert client.command(mav.MAV_CMD_REQUEST_MESSAGE, wanted) == mav.MAV_RESULT_UNSUPPORTED
    assert client.command(mav.MAV_CMD_SET_MESSAGE_INTERVAL, wanted, 1e5) == mav.MAV_RESULT_DENIED


def test_intervals_of_one_peer_only(bed):
    client, other = bed.client(), bed.client("udp", 200)
    other.wait("ATTITUDE")
    assert client.command(mav.MAV_CMD_SET_MESSAGE_INTERVAL, 30, -1) == 0
    client.forget()
    other.forget()
    bed.advance(2.0)
    assert not client.all("ATTITUDE")
    assert 38 <= len(other.all("ATTITUDE")) <= 42
    assert client.command(mav.MAV_CMD_SET_MESSAGE_INTERVAL, 30, 20000) == 0
    assert client.command(mav.MAV_CMD_GET_MESSAGE_INTERVAL, 30) == 0
    assert client.wait("MESSAGE_INTERVAL").interval_us == 20000
    client.forget()
    bed.advance(2.0)
    assert 95 <= len(client.all("ATTITUDE")) <= 101
    assert client.command(mav.MAV_CMD_SET_MESSAGE_INTERVAL, 30, 0) == 0
    client.forget()
    bed.advance(2.0)
    assert 38 <= len(client.all("ATTITUDE")) <= 42


def test_legacy_stream_request(bed):
    client = bed.client()
    client.mav.request_data_stream_send(1, 1, mav.MAV_DATA_STREAM_ALL, 4, 1)
    bed.advance(0.5)
    client.forget()
    bed.advance(2.0)
    assert 7 <= len(client.all("ATTITUDE")) <= 9
    client.mav.request_data_stream_send(1, 1, mav.MAV_DATA_STREAM_ALL, 0, 0)
    bed.advance(0.5)
    client.forget()
    bed.advance(2.0)
    assert not client.all("ATTITUDE")
    assert client.all("HEARTBEAT")


def test_everything_that_streams_comes_at_its_rate(bed):
    client = bed.client("udp")
    client.wait("HEARTBEAT", such=lambda m: m.get_srcComponent() == 1)
    bed.advance(3.0)
    client.forget()
    bed.advance(4.0)
    craft = bed.endpoint.nodes[0].craft
    sometimes = {85, 62}
    for message_id in streams.MESSAGES.keys() - sometimes:
        known = mav.mavlink_map.get(message_id)
        name = known.msgname if known else f"UNKNOWN_{message_id}"
        rate = streams.usual_rate_hz(craft, message_id)
        got = [m for m in client.all(name) if not known or m.get_srcComponent() == 1]
        assert abs(len(got) - 4 * rate) <= 1 + 0.05 * 4 * rate, (name, len(got), rate)


def test_mode_by_command_and_by_message(bed):
    client = bed.client()
    bed.advance(3.0)
    row = bed.firmware.now.row
    hold = row.modes["hold"]
    params = (1, hold >> 16 & 0xFF, hold >> 24) if row.name == "px4" else (1, hold)
    assert client.command(mav.MAV_CMD_DO_SET_MODE, *params, NAN) == 0
    client.wait("HEARTBEAT", such=lambda m: m.custom_mode == hold)
    client.forget()
    client.mav.set_mode_send(1, 1, row.modes["stabilize"])
    assert client.wait("COMMAND_ACK").command == 11
    client.wait("HEARTBEAT", such=lambda m: m.custom_mode == row.modes["stabilize"])
    for wrong in (NAN, math.inf, -3.0, 1e9):
        assert client.command(mav.MAV_CMD_DO_SET_MODE, 1, wrong) in (2, 3, 4)


def test_command_int_is_scaled(bed):
    client = bed.client()
    client.fly()
    here = client.wait("GLOBAL_POSITION_INT")
    north = here.lat + 180
    params = (-1, 1, 0, NAN)
    client.mav.command_int_send(1, 1, 6, mav.MAV_CMD_DO_REPOSITION, 0, 0, *params, north, here.lon, 1.5)
    assert client.wait("COMMAND_ACK").result == 0, client.texts()
    client.wait("LOCAL_POSITION_NED", 15.0, lambda m: abs(m.x - 2.0) < 0.2)


def test_the_altitude_of_an_orbit_is_above_the_sea_whatever_the_frame(bed):
    """As MAVSDK sends it."""
    client = bed.client()
    client.fly()
    here = client.wait("GLOBAL_POSITION_INT")
    client.mav.command_int_send(1, 1, 3, mav.MAV_CMD_DO_ORBIT, 0, 0, 1, 1, 0, NAN, here.lat, here.lon, 490.0)
    assert client.wait("COMMAND_ACK").result == 0, client.texts()
    bed.advance(6.0)
    assert here_down(client) == pytest.approx(-2.0, abs=0.3)


def here_down(client) -> float:
    client.forget()
    return float(client.wait("LOCAL_POSITION_NED").z)


@pytest.mark.parametrize(("params", "name"), [((1,), "gyro"), ((0, 1), "mag"), ((0, 0, 0, 0, 1), "accel")])
def test_px4_tells_of_a_calibration_in_the_words_that_stations_wait_for(params, name):
    with Bed("px4") as bed:
        client = bed.client()
        bed.advance(1.0)
        assert client.command(mav.MAV_CMD_PREFLIGHT_CALIBRATION, *params) == 0
        bed.advance(0.5)
        said = [text for text in client.texts() if text.startswith("[cal]")]
        assert (said[0], said[-1]) == (f"[cal] calibration started: 2 {name}", f"[cal] calibration done: {name}")
        assert client.command(mav.MAV_CMD_PREFLIGHT_CALIBRATION) == 0, "called off"
        bed.advance(0.5)
        assert not client.texts()
        assert client.command(mav.MAV_CMD_PREFLIGHT_CALIBRATION, 0, 0, 0, 1) == mav.MAV_RESULT_UNSUPPORTED


def test_a_reboot_mends_what_was_broken_and_nothing_shuts_down(bed):
    client = bed.client()
    bed.advance(3.0)
    if bed.firmware.now.row.name == "px4":
        bed.firmware.set_param("SYS_FAILURE_EN", 1)
    assert client.command(mav.MAV_CMD_INJECT_FAILURE, 4, 1) == 0
    client.wait("SYS_STATUS", 10.0, lambda m: not m.onboard_control_sensors_health & 0x10000000)
    assert client.command(mav.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 2) == mav.MAV_RESULT_DENIED
    bed.advance(0.2)
    assert "Only a reboot is possible" in "".join(client.texts())
    assert client.command(mav.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1) == 0
    client.forget()
    client.wait("SYS_STATUS", 20.0, lambda m: bool(m.onboard_control_sensors_health & 0x10000000))


def test_takeoff_reports_and_lands(bed):
    client = bed.client()
    client.fly()
    assert client.command(mav.MAV_CMD_NAV_LAND) == 0
    client.wait("EXTENDED_SYS_STATE", 20.0, lambda m: m.landed_state == 1)
    client.wait("HEARTBEAT", 20.0, lambda m: m.get_srcComponent() == 1 and not m.base_mode & 128)


def test_the_battery_says_how_long_it_lasts(bed):
    client = bed.client()
    assert client.wait("BATTERY_STATUS").time_remaining == 0, "on the ground nobody knows"
    client.fly()
    bed.firmware.set_param("SIM_BAT_DRAIN", 400.0)
    bed.advance(30.0)
    client.forget()
    said = client.wait("BATTERY_STATUS")
    assert said.time_remaining == pytest.approx(4.0 * said.battery_remaining, rel=0.1)


def test_one_system_id_a_vehicle():
    with Bed("ardupilot", "--vehicles", "3") as bed:
        client = bed.client()
        client.wait("HEARTBEAT")
        bed.advance(2.0)
        assert {m.get_srcSystem() for m in client.heard} == {1, 2, 3}
        assert client.command(mav.MAV_CMD_DO_SET_MODE, 1, 4, target=(2, 1)) == 0
        bed.advance(2.0)
        modes = {m.get_srcSystem(): m.custom_mode for m in client.all("HEARTBEAT") if m.get_srcComponent() == 1}
        assert modes == {1: 0, 2: 4, 3: 0}


def test_home_by_the_older_command(bed):
    client = bed.client()
    bed.advance(3.0)
    assert client.command(mav.MAV_CMD_GET_HOME_POSITION) == mav.MAV_RESULT_ACCEPTED
    assert client.wait("HOME_POSITION", 0.2).latitude == pytest.approx(473977420, abs=20)


def test_prearm_checks_are_run_when_asked_for(bed):
    client = bed.client()
    bed.advance(3.0)
    assert client.command(mav.MAV_CMD_RUN_PREARM_CHECKS) == mav.MAV_RESULT_ACCEPTED
    bed.firmware.vehicle.fail("mag", works=False)
    client.forget()
    assert client.command(mav.MAV_CMD_RUN_PREARM_CHECKS) == mav.MAV_RESULT_ACCEPTED
    bed.advance(0.5)
    assert client.texts() == ["PreArm: Compass not healthy"]


def test_a_mode_that_is_not_there_is_named_as_it_was_asked_for(bed):
    client = bed.client()
    bed.advance(1.0)
    px4 = bed.firmware.now.row.name == "px4"
    assert client.command(mav.MAV_CMD_DO_SET_MODE, 1, 99, 3) != mav.MAV_RESULT_ACCEPTED
    assert client.texts() == ["There is no mode 99, 3" if px4 else "There is no mode 99"]
    assert client.command(mav.MAV_CMD_DO_SET_MODE, 0, 4, 3) != mav.MAV_RESULT_ACCEPTED
    assert client.texts() == ["Only custom modes are known"]


def test_the_fence_status_says_what_is_crossed_and_how_often(bed):
    client = bed.client()
    bed.advance(2.0)
    watch = bed.firmware.failsafes.watch
    assert client.wait("FENCE_STATUS").breach_count == 0
    for words, kind in (("inclusion zone", mav.FENCE_BREACH_BOUNDARY), ("maximum altitude", mav.FENCE_BREACH_MAXALT)):
        watch.fence("", bed.flight.now_s)
        watch.fence(words, bed.flight.now_s)
        client.forget()
        assert client.command(mav.MAV_CMD_REQUEST_MESSAGE, 162) == mav.MAV_RESULT_ACCEPTED
        told = client.wait("FENCE_STATUS", 0.1)
        assert (told.breach_status, told.breach_type) == (1, kind)
        assert told.breach_time > 0
    assert told.breach_count == 2
