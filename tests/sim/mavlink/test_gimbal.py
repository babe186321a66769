"""The gimbal manager's flags and rates, who is in control, and regions of interest, over a socket."""

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink.gimbal import CAPABILITIES, GIMBAL
from tests.sim.mavlink.bed import Bed
from tests.sim.mavlink.test_payload import HOME, METRE, pitch_deg

NAN = math.nan
LOCK, IN_VEHICLE, FROM_NORTH = 0x10, 0x20, 0x40


def yaw_deg(message) -> float:
    """In the frame that the message's flags name."""
    w, x, y, z = message.q
    return math.degrees(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def now(client):
    client.forget()
    return client.wait("GIMBAL_DEVICE_ATTITUDE_STATUS")


def off(a_deg: float, b_deg: float) -> float:
    return abs(math.degrees(math.remainder(math.radians(a_deg - b_deg), math.tau)))


def nose_deg(bed) -> float:
    return math.degrees(bed.firmware.telemetry(bed.flight.now_s).estimate.heading_rad)


def turn_nose(client, degrees: float) -> None:
    client.bed.advance(1.5)  # PX4 first ends its take-off
    assert client.command(115, degrees, 0, 1, 0) == 0
    for _ in range(100):
        client.bed.advance(0.1)
        if off(nose_deg(client.bed), degrees) < 2:
            return
    raise AssertionError(nose_deg(client.bed))


def test_it_claims_what_it_does(bed):
    client = bed.client()
    assert client.command(512, 280, target=(1, GIMBAL)) == 0
    claimed = client.wait("GIMBAL_MANAGER_INFORMATION").cap_flags
    absent = mav.GIMBAL_MANAGER_CAP_FLAGS_HAS_RETRACT | mav.GIMBAL_MANAGER_CAP_FLAGS_HAS_ROLL_AXIS
    absent |= mav.GIMBAL_MANAGER_CAP_FLAGS_HAS_RC_INPUTS
    assert not claimed & absent
    assert claimed & mav.GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_LOCK
    assert claimed & mav.GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL
    assert client.command(512, 283, target=(1, GIMBAL)) == 0
    assert client.wait("GIMBAL_DEVICE_INFORMATION").cap_flags == CAPABILITIES


def test_locked_it_keeps_its_yaw_and_following_it_turns_with_the_nose(bed):
    client = bed.client()
    client.fly()
    turn_nose(client, 90)
    assert client.command(1000, 0, 30, NAN, NAN, LOCK | FROM_NORTH, target=(1, GIMBAL)) == 0
    bed.advance(2.0)
    turn_nose(client, 180)
    status = now(client)
    assert status.flags & LOCK
    assert off(yaw_deg(status), 30) < 2
    assert off(math.degrees(status.delta_yaw), 180) < 4
    assert client.command(1000, 0, 30, NAN, NAN, IN_VEHICLE, target=(1, GIMBAL)) == 0
    bed.advance(3.0)
    turn_nose(client, 90)
    status = now(client)
    assert status.flags & IN_VEHICLE
    assert not status.flags & LOCK
    assert off(yaw_deg(status), 30) < 2


def test_a_rate_turns_on_and_on_and_an_angle_is_reached_at_one(bed):
    client = bed.client()
    bed.advance(2.0)
    client.mav.gimbal_manager_set_pitchyaw_send(1, GIMBAL, 0, GIMBAL, NAN, NAN, math.radians(-8), math.radians(50))
    bed.advance(1.0)
    assert -15 < pitch_deg(now(client)) < -5
    bed.advance(4.0)
    assert yaw_deg(now(client)) < 0, "it has no end in yaw"
    client.mav.gimbal_manager_set_attitude_send(1, GIMBAL, 0, GIMBAL, [NAN] * 4, NAN, 0.0, 0.0)
    bed.advance(0.1)
    stopped = now(client)
    bed.advance(1.0)
    assert now(client).q == pytest.approx(stopped.q, abs=1e-3)
    assert client.command(1000, 0, 0, NAN, NAN, target=(1, GIMBAL)) == 0
    bed.advance(3.0)
    assert client.command(1000, -60, 0, 20, 20, target=(1, GIMBAL)) == 0
    bed.advance(1.0)
    assert pitch_deg(now(client)) == pytest.approx(-22, abs=4)
    client.mav.gimbal_manager_set_manual_control_send(1, GIMBAL, 0, GIMBAL, -0.5, 0.25, NAN, NAN)
    bed.advance(2.0)
    assert (pitch_deg(now(client)), yaw_deg(now(client))) == pytest.approx((-45, 45), abs=1)
    client.mav.gimbal_manager_set_pitchyaw_send(1, GIMBAL, 2, GIMBAL, NAN, NAN, NAN, NAN)
    bed.advance(2.0)
    assert (pitch_deg(now(client)), yaw_deg(now(client))) == pytest.approx((0, 0), abs=1), "neutral"


@pytest.mark.parametrize(
    "params", [(math.inf,), (0, 200), (0, 0, math.inf), (0, 0, 0, -math.inf), (0, 0, 0, 0, 5000), (0, 0, 0, 0, 0, 0, 9)]
)
def test_what_makes_no_sense_is_denied(bed, params):
    client = bed.client()
    assert client.command(1000, *params, target=(1, GIMBAL)) == mav.MAV_RESULT_DENIED


def test_px4_turns_it_only_for_who_is_in_control():
    for firmware, result in (("px4", mav.MAV_RESULT_DENIED), ("ardupilot", mav.MAV_RESULT_ACCEPTED)):
        with Bed(firmware) as bed:
            holder, other = bed.client(), bed.client("udp", 200)
            bed.advance(1.0)
            assert holder.command(1001, -2, -2, target=(1, GIMBAL)) == 0
            assert other.command(1000, -30, 0, NAN, NAN, target=(1, GIMBAL)) == result
            assert holder.command(1000, -10, 0, NAN, NAN, target=(1, GIMBAL)) == 0
            assert holder.command(1001, -3, -3, target=(1, GIMBAL)) == 0
            assert other.command(1000, -30, 0, NAN, NAN, target=(1, GIMBAL)) == 0


def look_at(client, north: float, east: float, target: int) -> int:
    client.forget()
    east_deg = east * METRE / math.cos(math.radians(HOME[0]))
    x, y = round((HOME[0] + north * METRE) * 1e7), round((HOME[1] + east_deg) * 1e7)
    floor = 488.0 if client.bed.firmware.now.row.name == "px4" else 0.0  # which takes every altitude for one AMSL
    client.mav.command_int_send(1, target, 6, mav.MAV_CMD_DO_SET_ROI_LOCATION, 0, 0, 0, 0, 0, 0, x, y, floor)
    return client.wait("COMMAND_ACK", such=lambda m: m.command == mav.MAV_CMD_DO_SET_ROI_LOCATION).result


@pytest.mark.parametrize("target", [1, GIMBAL])
def test_a_region_of_interest_turns_the_gimbal_and_not_the_nose(bed, target):
    client = bed.client()
    client.fly()
    bed.firmware.now.nose_to_region = False
    nose = nose_deg(bed)
    assert look_at(client, 0.0, 3.0, target) == 0
    bed.advance(3.0)
    status = now(client)
    assert off(yaw_deg(status), 90) < 5
    assert pitch_deg(status) == pytest.approx(-math.degrees(math.atan2(1.5, 3.0)), abs=4)
    assert off(nose_deg(bed), nose) < 3
    assert client.command(mav.MAV_CMD_DO_SET_ROI_NONE, target=(1, target)) == 0
    bed.advance(3.0)
    assert (pitch_deg(now(client)), yaw_deg(now(client))) == pytest.approx((0, 0), abs=1), "ahead again"


def test_the_nose_turns_where_no_gimbal_would():
    with Bed("ardupilot", "--camera", "off") as bed:
        client = bed.client()
        client.fly()
        assert look_at(client, 0.0, 3.0, 1) == 0
        bed.advance(4.0)
        assert off(nose_deg(bed), 90) < 5


def test_who_turns_it_himself_ends_the_region_of_interest(bed):
    client = bed.client()
    client.fly()
    assert look_at(client, 0.0, 3.0, 1) == 0
    bed.advance(1.0)
    assert client.command(1000, -80, 0, NAN, NAN, target=(1, GIMBAL)) == 0
    bed.advance(3.0)
    assert bed.firmware.now.region_ned_m is None
    assert pitch_deg(now(client)) == pytest.approx(-80, abs=1)
