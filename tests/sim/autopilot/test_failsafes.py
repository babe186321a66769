"""Failsafes of both firmwares: provoked, announced, acted upon by the parameters, the more severe one first."""

import math

import pytest

from sim.autopilot.interface import Ack
from tests.sim.autopilot.rig import ardupilot, put

# A ground station that falls silent


@pytest.mark.parametrize(
    ("name", "parameter", "value", "mode"),
    [
        ("ardupilot", "FS_GCS_ENABLE", 1, "return"),
        ("ardupilot", "FS_GCS_ENABLE", 5, "land"),
        ("ardupilot", "FS_GCS_ENABLE", 0, "offboard"),
        ("px4", "NAV_DLL_ACT", 2, "return"),
        ("px4", "NAV_DLL_ACT", 3, "land"),
        ("px4", "NAV_DLL_ACT", 0, "hold"),
    ],
)
def test_losing_the_station(rigs, name, parameter, value, mode):
    rig = rigs(name)
    put(rig, **{parameter: value})
    rig.firmware.heard_station(rig.now_s, 255)
    rig.take_off(1.0)
    rig.firmware.heard_station(rig.now_s, 255)
    rig.fly(4.5)
    assert rig.report.system_status == 4
    rig.fly(6.0)
    if name == "px4" and value:
        assert rig.in_mode("hold")  # it waits for COM_FAIL_ACT_T first
        assert rig.report.system_status == 5
        rig.fly(5.0)
    if mode == "offboard" or (name == "px4" and not value):
        assert rig.in_mode(mode)
        assert rig.report.system_status == 4
        return
    assert rig.heard("heartbeat" if name == "ardupilot" else "ground station lost")
    assert rig.fly(5, lambda: rig.in_mode(mode) or not rig.report.armed)
    assert rig.fly(20, lambda: not rig.report.armed)


def test_a_station_that_comes_back_in_time_is_forgiven(rigs):
    rig = rigs("px4")
    rig.firmware.heard_station(rig.now_s, 255)
    rig.take_off(1.0)
    rig.fly(11.0)
    rig.firmware.heard_station(rig.now_s, 255)
    rig.fly(6.0)
    assert rig.in_mode("hold")
    assert rig.report.armed


def test_a_station_that_never_was_or_left_before_is_not_missed(rig):
    put(rig, **({"FS_GCS_ENABLE": 1} if ardupilot(rig) else {}))
    rig.firmware.heard_station(rig.now_s, 255)
    rig.fly(12.0)
    rig.take_off(1.0)
    rig.fly(18.0)
    assert rig.report.landed_state == 2
    assert rig.report.system_status == 4


# Setpoints that stop


@pytest.mark.parametrize(("action", "mode"), [(0, "hold"), (3, "return"), (4, "land"), (5, "hold")])
def test_px4_leaves_offboard_when_setpoints_stop(rigs, action, mode):
    rig = rigs("px4")
    put(rig, COM_OBL_RC_ACT=action)
    rig.take_off(1.0)
    rig.offboard(position=(0.5, 0.0, -1.0))
    rig.fly(3.0)
    rig.every = None
    rig.fly(0.8)
    assert rig.in_mode("offboard")
    assert rig.fly(0.6, lambda: rig.in_mode(mode))
    assert rig.heard("No offboard signal")
    assert rig.report.system_status == 5
    rig.offboard(position=(0.0, 0.0, -1.0))
    assert rig.in_mode("offboard")
    rig.fly(0.2)
    assert rig.report.system_status == 4


def test_arducopter_stops_when_velocities_stop(rigs):
    rig = rigs("ardupilot")
    rig.take_off(1.0)
    rig.offboard(mask=0xDC7, velocity=(0.5, 0.0, 0.0))
    rig.fly(1.0)
    rig.every = None
    rig.fly(2.0)
    assert rig.report.estimate.velocity_ned_mps[0] > 0.3
    rig.fly(4.0)
    assert abs(rig.report.estimate.velocity_ned_mps[0]) < 0.1
    assert rig.in_mode("offboard")
    assert rig.heard("setpoints stopped")


# Battery


def test_low_then_critical_battery(rig):
    rig.take_off(1.0)
    rig.offboard(position=(2.0, 0.0, -1.0))
    rig.fly(4.0)
    rig.every = lambda: rig.target(position=(2.0, 0.0, -1.0))
    if ardupilot(rig):
        put(rig, BATT_LOW_TIMER=1, SIM_BATT_VOLTAGE=13.9)
    else:
        put(rig, COM_FAIL_ACT_T=0, SIM_BAT_REMAIN=6.5)
    assert rig.fly(3, lambda: rig.in_mode("return"))
    assert rig.heard("low" if ardupilot(rig) else "critical battery")
    assert rig.report.system_status == 5
    put(rig, **({"SIM_BATT_VOLTAGE": 13.0} if ardupilot(rig) else {"SIM_BAT_REMAIN": 3.0}))
    assert rig.fly(3, lambda: rig.in_mode("land"))
    assert rig.heard("critical" if ardupilot(rig) else "emergency battery")
    assert rig.fly(10, lambda: not rig.report.armed)
    assert rig.do(400, 1).result is rig.firmware.now.row.refused


def test_the_battery_drains_as_fast_as_is_asked(rig):
    put(rig, SIM_BAT_DRAIN=20.0)
    rig.take_off(1.0)
    before = rig.report.battery.remaining
    rig.fly(2.0)
    assert 0.08 < before - rig.report.battery.remaining < 0.12


def test_a_battery_that_only_warns(rigs):
    rig = rigs("px4")
    put(rig, COM_LOW_BAT_ACT=0, SIM_BAT_REMAIN=12.0)
    rig.take_off(1.0)
    assert rig.heard("Low battery level")
    assert rig.report.system_status == 4
    assert rig.in_mode("hold")


# Estimator


def test_losing_the_position_lands(rig):
    rig.take_off(1.5)
    put(rig, **({} if ardupilot(rig) else {"SYS_FAILURE_EN": 1}))
    assert rig.do(420, 4, 1).result is Ack.ACCEPTED
    assert rig.fly(4, lambda: rig.in_mode("land"))
    assert rig.heard("position estimate lost")
    assert rig.report.system_status == 5
    assert rig.report.ekf_flags & 0x80
    assert not rig.report.health & 0x20
    assert rig.mode("hold").result is rig.firmware.now.row.refused
    assert rig.mode("return").result is rig.firmware.now.row.refused
    assert rig.fly(15, lambda: not rig.report.armed), rig.true_ned
    assert math.hypot(*rig.true_ned[:2]) < 3.0
    assert rig.true_ned[2] > -0.1


def test_arducopter_can_be_told_to_hover_without_a_position(rigs):
    rig = rigs("ardupilot")
    rig.take_off(1.5)
    put(rig, FS_EKF_ACTION=2)
    rig.do(420, 4, 1)
    rig.fly(4.0)
    assert rig.in_mode("hold")
    assert abs(rig.true_ned[2] + 1.5) < 0.7


# Which wins


def test_the_more_severe_action_wins(rig):
    rig.take_off(1.0)
    rig.offboard(position=(0.5, 0.0, -1.0))
    rig.fly(2.0)
    if ardupilot(rig):
        put(rig, BATT_LOW_TIMER=0, SIM_BATT_VOLTAGE=13.0)
    else:
        put(rig, SIM_BAT_REMAIN=3.0)
    rig.fly(0.5)
    assert rig.in_mode("land")
    put(
        rig,
        **({"FENCE_ENABLE": 1, "FENCE_ALT_MAX": 0.5} if ardupilot(rig) else {"GF_ACTION": 3, "GF_MAX_VER_DIST": 0.5}),
    )
    rig.fly(0.3)
    assert rig.heard("maximum altitude")
    assert rig.in_mode("land")


def test_the_pilot_takes_over(rig):
    rig.take_off(1.0)
    put(
        rig,
        **(
            {"BATT_LOW_TIMER": 0, "SIM_BATT_VOLTAGE": 13.9}
            if ardupilot(rig)
            else {"COM_FAIL_ACT_T": 0, "SIM_BAT_REMAIN": 6.5}
        ),
    )
    assert rig.fly(2, lambda: rig.in_mode("return"))
    assert rig.mode("hold").result is Ack.ACCEPTED
    rig.fly(2.0)
    assert rig.in_mode("hold")
    assert rig.report.system_status == 5


def test_an_empty_battery_brings_it_down_and_leaves_it_disarmed(rig):
    rig.take_off(0.5)
    put(rig, SIM_BAT_REMAIN=0)
    rig.fly(1.0)
    assert rig.report.battery.voltage_v < 10.0
    assert rig.fly(25, lambda: not rig.report.armed)
