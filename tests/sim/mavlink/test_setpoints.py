"""Setpoints, sticks and outside poses; clocks, pings and file transfer."""

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from tests.sim.mavlink.bed import STEPS, Bed

POSITION, VELOCITY = 0x9F8, 0x9C7
NAN = math.nan


def offboard(client) -> int:
    row = client.bed.firmware.now.row
    number = row.modes["offboard"]
    params = (1, number >> 16 & 0xFF, number >> 24) if row.name == "px4" else (1, number)
    return client.command(mav.MAV_CMD_DO_SET_MODE, *params)


def steer(client, frame, mask, values, span_s) -> None:
    """Send it 20 times a second."""
    for _ in range(round(span_s * 20)):
        client.mav.set_position_target_local_ned_send(0, 1, 1, frame, mask, *values)
        client.bed.advance(0.05)


def here(client):
    client.forget()
    return client.wait("LOCAL_POSITION_NED")


def test_position_and_velocity(bed):
    client = bed.client()
    client.fly()
    steer(client, 1, POSITION, (0, 0, -1.5, 0, 0, 0, 0, 0, 0, 0, 0), 0.5)
    assert offboard(client) == 0
    steer(client, 1, POSITION, (2, 1, -2, 0, 0, 0, 0, 0, 0, math.pi / 2, 0), 7)
    at = here(client)
    assert (at.x, at.y, at.z) == pytest.approx((2, 1, -2), abs=0.15)
    assert client.wait("ATTITUDE").yaw == pytest.approx(math.pi / 2, abs=0.1)
    steer(client, 1, VELOCITY, (0, 0, 0, 0, -0.5, 0, 0, 0, 0, 0, 0), 3)
    assert here(client).vy == pytest.approx(-0.5, abs=0.15)


def test_what_is_no_number_changes_nothing(bed):
    client = bed.client()
    client.fly()
    before = here(client)
    steer(client, 1, POSITION, (0, 0, -1.5, 0, 0, 0, 0, 0, 0, 0, 0), 0.5)
    assert offboard(client) == 0
    for bad in (NAN, math.inf, 1e38):
        good = (before.x, before.y, before.z, 0, 0, 0, 0, 0, 0, 0, 0)
        steer(client, 1, POSITION, (bad, 0, -1.5, 0, 0, 0, 0, 0, 0, 0, 0), 0.3)
        steer(client, 1, POSITION, good, 0.5)
        client.mav.set_attitude_target_send(0, 1, 1, 0, [bad, 0, 0, 0], 0, 0, bad, 0.5)
        client.mav.set_position_target_global_int_send(0, 1, 1, 6, 0xDC7, 0, 0, 0, bad, 0, 0, 0, 0, 0, 0, 0)
        steer(client, 1, POSITION, good, 1.0)
    assert any("not finite" in text for text in client.texts())
    at = here(client)
    assert (at.x, at.y, at.z) == pytest.approx((before.x, before.y, before.z), abs=0.4)


def test_outside_pose_becomes_the_position():
    for firmware in ("ardupilot", "px4"):
        with Bed(firmware, "--gps", "none") as bed:
            client = bed.client()
            bed.advance(2.0)
            assert not client.all("LOCAL_POSITION_NED")
            assert not client.all("GLOBAL_POSITION_INT")
            assert {m.fix_type for m in client.all("GPS_RAW_INT")} == {0}
            for tick in range(200):
                odd = tick % 4
                if odd == 0:
                    client.mav.vision_position_estimate_send(0, 3, 4, -0.1, 0, 0, 0.2)
                elif odd == 1:
                    client.mav.vision_position_estimate_send(0, NAN, 4, -0.1, 0, 0, 0.2)
                elif odd == 2:
                    q = [math.cos(0.1), 0, 0, math.sin(0.1)]
                    client.mav.odometry_send(0, 20, 12, 3, 4, -0.1, q, 0, 0, 0, 0, 0, 0, [0] * 21, [0] * 21)
                else:
                    q = [math.cos(-0.1), 0, 0, math.sin(-0.1)]
                    client.mav.odometry_send(0, 21, 12, 3, -4, 0.1, q, 0, 0, 0, 0, 0, 0, [0] * 21, [0] * 21)
                bed.advance(0.02)
            at = here(client)
            assert (at.x, at.y) == pytest.approx((3, 4), abs=0.2)


def test_origin_without_gps():
    with Bed("px4", "--gps", "none") as bed:
        client = bed.client()
        bed.advance(1.0)
        client.mav.set_gps_global_origin_send(1, 473977420, 85455940, 488000)
        answer = client.wait("GPS_GLOBAL_ORIGIN", 1.0)
        assert (answer.latitude, answer.longitude, answer.altitude) == (473977420, 85455940, 488000)
        client.forget()
        client.mav.set_gps_global_origin_send(1, 2_000_000_000, 0, 0)
        bed.advance(0.2)
        assert any("Origin refused" in text for text in client.texts())


def test_sticks_are_taken_in_any_form(bed):
    client = bed.client()
    client.fly()
    row = bed.firmware.now.row
    bed.firmware.set_param("SYSID_MYGCS", 245)
    bed.firmware.set_mode(1, row.modes["position"], bed.flight.now_s)
    for _ in range(40):
        client.mav.manual_control_send(1, 500, 0, 500, 0x7FFF, 0)
        bed.advance(0.05)
    assert here(client).vx > 0.3
    for _ in range(60):
        client.mav.rc_channels_override_send(1, 1, 1500, 1250, 1500, 0xFFFF, 0, 0, 0, 0)
        bed.advance(0.05)
    assert here(client).vx > 0.3


def test_arducopter_follows_the_sticks_and_the_heartbeat_of_one_station():
    with Bed("ardupilot") as bed:
        own, other = bed.client("tcp", 255), bed.client("udp", 245)
        own.fly()
        row = bed.firmware.now.row
        bed.firmware.set_param("FS_GCS_ENABLE", 5)
        bed.firmware.set_mode(1, row.modes["position"], bed.flight.now_s)
        for _ in range(20):
            other.mav.manual_control_send(1, 500, 0, 500, 0, 0)
            bed.advance(0.05)
        assert own.texts().count("Sticks of system 245 ignored: SYSID_MYGCS is 255") == 1
        assert abs(here(own).vx) < 0.2
        for _ in range(20):
            own.mav.manual_control_send(1, 500, 0, 500, 0, 0)
            bed.advance(0.05)
        own.forget()
        assert here(own).vx > 0.3
        own.beats = False
        bed.advance(7.0)
        assert bed.firmware.telemetry(bed.flight.now_s).custom_mode == row.modes["land"], "the other one does not count"


def test_overridden_channels_are_told_until_they_are_let_go(bed):
    own, other = bed.client("tcp", 255), bed.client("udp", 245)
    bed.advance(1.0)

    def throttle_us() -> int:
        own.forget()
        return int(own.wait("RC_CHANNELS").chan3_raw)

    assert throttle_us() == 1000
    own.mav.rc_channels_override_send(1, 1, 1500, 1500, 1350, 1500, 0, 0, 0, 0)
    bed.advance(0.1)
    assert throttle_us() == 1350
    own.mav.rc_channels_override_send(1, 1, 0, 0, 0, 0, 0, 0, 0, 0)
    bed.advance(0.1)
    assert throttle_us() == 1000
    other.mav.rc_channels_override_send(1, 1, 1500, 1500, 1700, 1500, 0, 0, 0, 0)
    bed.advance(0.1)
    assert throttle_us() == (1700 if bed.firmware.now.row.name == "px4" else 1000), "SYSID_MYGCS is 255"


def test_time_is_handed_in(bed):
    client = bed.client()
    bed.advance(1.0)
    assert bed.flight.steps % STEPS == 0
    client.mav.timesync_send(0, 77)
    answer = client.wait("TIMESYNC")
    assert answer.ts1 == 77
    assert answer.tc1 == pytest.approx(bed.flight.now_s * 1e9, abs=5e7)
    client.mav.ping_send(5, 9, 0, 0)
    pong = client.wait("PING")
    assert (pong.seq, pong.target_system, pong.target_component) == (9, 245, 190)


def test_file_transfer_is_refused_at_once(bed):
    client = bed.client()
    asked = [7, 0, 3, 4, 5, 0, 0, 0, 0, 0, 0, 0]
    client.mav.file_transfer_protocol_send(0, 1, 1, asked + [0] * (251 - len(asked)))
    answer = client.wait("FILE_TRANSFER_PROTOCOL").payload
    assert answer[:6] == [8, 0, 3, 129, 1, 4]
    assert answer[12] == 10
