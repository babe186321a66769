"""What is refused, with which result and which words; nothing of it disturbs the vehicle."""

import math

import pytest

from sim.autopilot.interface import Ack, AttitudeSetpoint, Param
from tests.sim.autopilot.rig import NAN, ZURICH

INF = math.inf


def test_arming_needs_a_position(rigs):
    for name in ("ardupilot", "px4"):
        rig = rigs(name, gps="none")
        rig.mode("offboard" if name == "ardupilot" else "hold")
        assert not rig.report.armable
        assert not rig.report.health & 0x10000000
        assert rig.do(400, 1).result is rig.firmware.now.row.refused
        assert rig.heard("Need Position Estimate")
        assert rig.do(400, 1, 21196).result is Ack.ACCEPTED
        assert rig.report.armed


def test_refusals_have_the_results_of_the_firmware(rigs):
    assert rigs("ardupilot").do(22, z=1.0).result is Ack.FAILED
    assert rigs("px4").do(21).result is Ack.TEMPORARILY_REJECTED


def test_arming_needs_charge_level_ground_and_sensors(rig):
    rig.firmware.set_param("SIM_BAT_REMAIN", 1.0)
    rig.fly(11.0)
    assert rig.do(400, 1).result is rig.firmware.now.row.refused
    assert rig.heard("Battery too low")
    rig.firmware.set_param("SIM_BAT_REMAIN", 100.0)
    rig.fly(1.0)
    rig.firmware.set_param("SYS_FAILURE_EN", 1)
    assert rig.do(420, 2, 1).result is Ack.ACCEPTED
    rig.fly(0.5)
    assert rig.do(400, 1).result is rig.firmware.now.row.refused
    assert rig.heard("Compass not healthy")
    assert rig.do(420, 2, 0).result is Ack.ACCEPTED
    rig.tip_over()
    rig.fly(3.0)
    assert rig.do(400, 1).result is rig.firmware.now.row.refused
    assert rig.heard("Leaning too far")


def test_a_crashed_vehicle_stops_its_rotors(rig):
    rig.take_off(1.0)
    rig.tip_over()
    assert rig.fly(12, lambda: not rig.report.armed)
    assert rig.heard("Crash")


def test_arming_needs_a_mode_that_arms(rig):
    rig.mode("return" if rig.firmware.now.row.name == "ardupilot" else "land")
    assert rig.do(400, 1).result is rig.firmware.now.row.refused
    assert rig.heard("does not arm")


def test_disarms_in_the_air_only_by_force(rig):
    rig.take_off(1.0)
    assert rig.do(400, 0).result is rig.firmware.now.row.refused
    assert rig.do(400, NAN).result is Ack.DENIED
    assert rig.do(246, 1).result is rig.firmware.now.row.refused
    assert rig.do(241, 1).result is rig.firmware.now.row.refused
    assert rig.report.armed
    assert rig.do(400, 0, 21196).result is Ack.ACCEPTED
    assert not rig.report.armed


def test_flight_termination(rig):
    rig.take_off(0.5)
    assert rig.do(185, 0).result is Ack.DENIED
    assert rig.do(185, 1).result is Ack.ACCEPTED
    assert not rig.report.armed


def test_idle_on_the_ground_disarms(rig):
    rig.do(400, 1)
    assert not rig.fly(9.5, lambda: not rig.report.armed)
    assert rig.fly(1.5, lambda: not rig.report.armed)


def test_commands_of_the_wire_and_unknown_ones_are_unsupported(rig):
    for command in (511, 512, 510, 519, 520, 521, 2000, 31000, -1, 0):
        assert rig.do(command).result is Ack.UNSUPPORTED


def test_takeoff_of_arducopter_wants_guided_armed_and_a_height(rigs):
    rig = rigs("ardupilot")
    assert rig.do(22, z=1.0).result is Ack.FAILED
    rig.do(400, 1)
    assert rig.do(22, z=1.0).result is Ack.FAILED
    assert rig.heard("not in guided mode")
    rig.mode("offboard")
    assert rig.do(22, z=NAN).result is Ack.FAILED
    assert rig.do(22, z=INF).result is Ack.DENIED
    assert rig.do(22, z=1.0, frame=0).result is Ack.DENIED
    assert rig.do(22, z=1.0, frame=3).result is Ack.ACCEPTED
    rig.fly(4.0)
    assert rig.do(22, z=1.0).result is Ack.FAILED


def test_px4_takes_off_once_armed_when_asked_before(rigs):
    rig = rigs("px4")
    assert rig.do(22, NAN, NAN, NAN, NAN, x=NAN, y=NAN, z=ZURICH[2]).result is Ack.ACCEPTED
    assert rig.do(400, 1).result is Ack.ACCEPTED
    assert rig.fly(8, lambda: rig.in_mode("hold"))
    assert abs(rig.true_ned[2] + 1.5) < 0.3  # an altitude below the parameter's is lifted to it


def test_px4_offboard_needs_a_stream(rigs):
    rig = rigs("px4")
    rig.take_off(1.0)
    assert rig.mode("offboard").result is Ack.TEMPORARILY_REJECTED
    rig.target(position=(0.0, 0.0, -1.0))
    rig.fly(0.6)
    assert rig.mode("offboard").result is Ack.TEMPORARILY_REJECTED
    rig.target(position=(0.0, 0.0, -1.0))
    assert rig.mode("offboard").result is Ack.ACCEPTED


def test_modes_that_are_none(rig):
    row = rig.firmware.now.row
    assert rig.firmware.set_mode(1, 77 << 16 | 77, rig.now_s).result is row.unknown_mode
    assert rig.firmware.set_mode(0, row.modes["hold"], rig.now_s).result is row.unknown_mode
    assert rig.do(176, NAN, NAN, NAN).result is row.unknown_mode
    assert rig.do(176, 1, -4).result is Ack.DENIED
    assert rig.do(176, 1, INF).result is Ack.DENIED
    assert rig.mode("mission").result is row.refused
    assert rig.heard("there is no mission")
    number = row.modes["land"]
    main, sub = (number >> 16 & 255, number >> 24) if row.name == "px4" else (number, NAN)
    assert rig.do(176, 129, main, sub).result is Ack.ACCEPTED
    assert rig.in_mode("land")


@pytest.mark.parametrize("id", [192, 34])
def test_places_without_sense_are_refused(rig, id):
    rig.take_off(1.0)
    first = 2.0 if id == 34 else -1.0
    for x, y, z in (
        (91.0, 0.0, 490.0),
        (INF, 0.0, 490.0),
        (0.0, 0.0, 490.0),
        (47.397742, 8.545594, 1e9),
        (47.4, 8.5, -INF),
    ):
        assert rig.do(id, first, 1, NAN, NAN, x=x, y=y, z=z, frame=5).result is Ack.DENIED
    assert rig.do(id, first, 1, NAN, NAN, x=0, y=0, z=0, frame=2).result is Ack.UNSUPPORTED_FRAME
    assert rig.do(192, INF, 1, NAN, NAN, x=0, y=0, z=-1, frame=1).result is Ack.DENIED
    assert rig.do(192, -1, 1, NAN, INF, x=0, y=0, z=-1, frame=1).result is Ack.DENIED
    assert rig.do(34, 0.0, 1).result is Ack.DENIED
    assert rig.do(34, 1.0, 15.0).result is Ack.DENIED
    assert rig.do(115, INF).result is Ack.DENIED
    assert rig.do(178, 1, NAN).result is Ack.DENIED
    rig.fly(1.0)
    assert rig.off(0.0, 0.0, -1.0) < 0.3


def test_bad_setpoints_leave_it_flying_what_it_flew(rig):
    rig.take_off(1.5)
    rig.offboard(position=(1.0, 0.0, -1.5))
    rig.fly(4.0)
    bad = [
        {"position": (NAN, 0.0, -1.0)},
        {"position": (INF, 0.0, -1.0)},
        {"position": (1e7, 0.0, -1.0)},
        {"mask": 0xDC7, "velocity": (0.0, NAN, 0.0)},
        {"mask": 0xDC7, "velocity": (1e4, 0.0, 0.0)},
        {"mask": 0xC3F, "accel": (0.0, 0.0, -INF)},
        {"mask": 0x23F, "accel": (0.0, 0.0, 0.0)},
        {"frame": 2},
        {"mask": 0xFFFF},
        {"yaw": INF},
        {"frame": 0, "position": (95.0, 0.0, 500.0)},
    ]
    for target in bad:
        rig.target(**target)
        rig.fly(0.05)
    for thrust, q in ((NAN, (1, 0, 0, 0)), (0.5, (NAN, 0, 0, 0)), (0.5, (0, 0, 0, 0)), (2.0, (1, 0, 0, 0))):
        rig.firmware.attitude_target(AttitudeSetpoint(0x07, q, (0.0, 0.0, 0.0), thrust), rig.now_s)
    rig.firmware.attitude_target(AttitudeSetpoint(0x80, (1, 0, 0, 0), (INF, 0.0, 0.0), 0.5), rig.now_s)
    rig.firmware.attitude_target(AttitudeSetpoint(0x47, (1, 0, 0, 0), (0.0, 0.0, 0.0), 0.5), rig.now_s)
    rig.firmware.external_pose((NAN, 0.0, 0.0), None, rig.now_s)
    rig.firmware.external_pose((0.0, 0.0, 0.0), INF, rig.now_s)
    rig.firmware.manual(NAN, 0.0, 0.5, 0.0, rig.now_s, 255)
    rig.fly(1.0)
    assert rig.heard("Setpoint refused")
    assert rig.off(1.0, 0.0, -1.5) < 0.2


def test_parameters(rig):
    firmware = rig.firmware
    system = "SYSID_THISMAV" if firmware.now.row.name == "ardupilot" else "MAV_SYS_ID"
    names = [param.name for param in firmware.params()]
    assert len(set(names)) == len(names)
    assert all(len(name) <= 16 for name in names)
    for param in firmware.params():
        assert param.least <= param.value <= param.most
        if not param.read_only:
            assert isinstance(firmware.set_param(param.name, param.most), Param)
    for name, value, words in (
        ("NO_SUCH", 1.0, "no parameter"),
        ("SIM_BAT_DRAIN", NAN, "must be a number"),
        ("SIM_BAT_DRAIN", -1.0, "must lie from"),
        (system, 2.0, "read-only"),
    ):
        assert words in firmware.set_param(name, value)
    whole = next(param for param in firmware.params() if param.integer and not param.read_only)
    assert "whole number" in firmware.set_param(whole.name, 0.5)


def test_failures_are_injected_only_where_that_is_allowed(rigs):
    rig = rigs("px4")
    assert rig.do(420, 4, 1).result is Ack.DENIED
    rig.firmware.set_param("SYS_FAILURE_EN", 1)
    assert rig.do(420, 4, 1).result is Ack.ACCEPTED
    assert rig.do(420, 55, 1).result is Ack.UNSUPPORTED
    assert rig.do(420, NAN, 1).result is Ack.UNSUPPORTED
    assert rig.do(420, 4, 3).result is Ack.UNSUPPORTED


def test_home_is_set_here_or_there(rig):
    rig.fly(0.5)
    assert rig.report.home_ned_m is not None
    assert rig.do(179, 0, x=ZURICH[0], y=ZURICH[1], z=ZURICH[2] + 1.0, frame=0).result is Ack.ACCEPTED
    assert math.dist(rig.report.home_ned_m, (0.0, 0.0, -1.0)) < 1e-6
    assert rig.do(179, 1).result is Ack.ACCEPTED
    assert math.dist(rig.report.home_ned_m, (0.0, 0.0, 0.0)) < 0.2
    assert rig.do(179, 0, x=0.0, y=0.0, z=0.0).result is Ack.DENIED


def test_reboot_begins_anew(rig):
    rig.mode("land")
    assert rig.do(246, 3).result is Ack.DENIED
    assert rig.do(246, 1).result is Ack.ACCEPTED
    assert rig.in_mode("stabilize" if rig.firmware.now.row.name == "ardupilot" else "hold")
    assert rig.do(241, 1).result is Ack.ACCEPTED


def test_a_region_of_interest_needs_a_place(rig):
    for x, y in ((NAN, NAN), (NAN, 8.5), (47.4, NAN)):
        assert rig.do(195, x=x, y=y, z=1.0, frame=3).result is Ack.DENIED
    assert rig.heard("needs a place")
    assert rig.do(195, x=ZURICH[0], y=ZURICH[1], z=1.0, frame=3).result is Ack.ACCEPTED
