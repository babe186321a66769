"""Every mode on both firmwares, with the real simulated vehicle."""

import math

import pytest

from sim.autopilot.interface import Ack, AttitudeSetpoint
from tests.sim.autopilot.rig import NAN, ZURICH

COURSE = ((0.0, 0.0, -2.0), (0.0, 5.0, -2.0), (5.0, 5.0, -4.0), (5.0, 0.0, -4.0), (0.0, 0.0, -2.0))


def test_takes_off_hovers_lands_and_disarms(rig):
    rig.take_off(1.5)
    assert rig.report.landed_state == 2
    assert rig.report.system_status == 4
    assert rig.in_mode("offboard" if rig.firmware.now.row.name == "ardupilot" else "hold")
    assert rig.do(21).result is Ack.ACCEPTED
    rig.fly(1.0)
    assert rig.in_mode("land")
    assert rig.report.landed_state == 4
    assert rig.fly(10, lambda: not rig.report.armed)
    assert rig.heard("Disarmed after landing")
    assert math.hypot(*rig.true_ned[:2]) < 0.3
    assert rig.report.landed_state == 1
    assert rig.report.system_status == 3


def test_flies_again_after_landing(rig):
    for _ in range(2):
        rig.take_off(1.0)
        rig.do(21)
        assert rig.fly(10, lambda: not rig.report.armed)


def test_offboard_flies_the_acceptance_course(rigs):
    rig = rigs("px4")
    rig.stream(position=COURSE[0])
    rig.fly(0.3)
    assert rig.mode("offboard").result is Ack.ACCEPTED
    assert rig.do(400, 1).result is Ack.ACCEPTED
    for place in COURSE:
        rig.stream(position=place)
        assert rig.fly(10, lambda place=place: rig.off(*place) < 0.3), (place, rig.true_ned)
    rig.every = None
    rig.do(21)
    assert rig.fly(15, lambda: not rig.report.armed)
    assert math.hypot(*rig.true_ned[:2]) < 0.5


def test_guided_flies_the_acceptance_course_after_a_takeoff(rigs):
    rig = rigs("ardupilot")
    rig.take_off(2.0)
    for place in COURSE:
        rig.target(position=place)  # once is enough: a place stays
        assert rig.fly(10, lambda place=place: rig.off(*place) < 0.3), (place, rig.true_ned)


def test_returns_lands_and_disarms_at_home(rig):
    rig.take_off(1.0)
    rig.offboard(position=(2.0, -1.0, -1.0))
    assert rig.fly(8, lambda: rig.off(2.0, -1.0, -1.0) < 0.2)
    rig.every = None
    assert rig.do(20).result is Ack.ACCEPTED
    highest = 0.0

    def home() -> bool:
        nonlocal highest
        highest = min(highest, rig.true_ned[2])
        return not rig.report.armed

    assert rig.fly(25, home)
    assert math.hypot(*rig.true_ned[:2]) < 0.5
    assert -1.8 < highest < -1.3


def test_return_and_takeoff_stay_below_the_ceiling(rigs):
    for name, height in (("ardupilot", "RTL_ALT"), ("px4", "RTL_RETURN_ALT")):
        rig = rigs(name, ceiling_m=2.5)
        rig.firmware.set_param(height, 1500 if name == "ardupilot" else 15)
        if name == "ardupilot":
            rig.mode("offboard")
        rig.do(400, 1)
        assert rig.do(22, z=30.0 if name == "ardupilot" else ZURICH[2] + 30.0).result is Ack.ACCEPTED
        highest = 0.0

        def top(rig=rig) -> bool:
            nonlocal highest
            highest = min(highest, rig.true_ned[2])
            return not rig.report.armed

        rig.fly(6, top)
        assert rig.mode("return").result is Ack.ACCEPTED
        assert rig.fly(20, top)
        assert -2.25 < highest < -1.9


def test_hold_stops_and_stays(rig):
    rig.take_off(1.5)
    rig.offboard(mask=0xDC7, velocity=(1.0, 0.0, 0.0))
    rig.fly(2.0)
    assert rig.true_ned[0] > 1.0
    rig.every = None
    assert rig.mode("hold").result is Ack.ACCEPTED
    rig.fly(3.0)
    there = rig.true_ned
    rig.fly(2.0)
    assert math.dist(rig.true_ned, there) < 0.15


def test_sticks_fly_position_and_stabilize(rig):
    assert rig.mode("position").result is Ack.ACCEPTED
    assert rig.do(400, 1).result is Ack.ACCEPTED
    rig.every = lambda: rig.firmware.manual(0.0, 0.0, 0.9, 0.0, rig.now_s, 255)
    assert rig.fly(5, lambda: rig.true_ned[2] < -1.2)
    rig.every = lambda: rig.firmware.manual(0.0, 0.5, 0.5, 0.0, rig.now_s, 255)
    rig.fly(2.0)
    assert rig.true_ned[0] > 0.8
    assert rig.mode("stabilize").result is Ack.ACCEPTED
    rig.every = lambda: rig.firmware.manual(0.3, 0.0, 0.5, 0.0, rig.now_s, 255)
    rig.fly(1.0)
    assert rig.report.estimate.roll_rad > 0.05
    rig.every = None
    rig.fly(4.0)
    there = rig.true_ned
    rig.fly(1.0)
    assert math.dist(rig.true_ned, there) < 0.3
    assert there[2] < -0.5


def test_goes_to_a_place_on_the_globe(rig):
    rig.take_off(1.5)
    latitude, longitude = rig.firmware.now.origin.globe(2.0, 1.0)
    answer = rig.do(192, -1, 1, NAN, NAN, x=latitude, y=longitude, z=ZURICH[2] + 1.2, frame=5)
    assert answer.result is Ack.ACCEPTED
    assert rig.fly(8, lambda: rig.off(2.0, 1.0, -1.2) < 0.15)
    assert rig.do(192, -1, 1, NAN, NAN, x=latitude, y=longitude, z=2.0, frame=6).result is Ack.ACCEPTED
    assert rig.fly(8, lambda: rig.off(2.0, 1.0, -2.0) < 0.15)


def test_orbits(rig):
    rig.take_off(1.5)
    assert rig.do(34, 2.0, 1.0, 0, 0, x=0.0, y=0.0, z=-1.5, frame=1).result is Ack.ACCEPTED
    rig.fly(6.0)
    bearings = set()

    def turn() -> bool:
        north, east, _ = rig.true_ned
        assert abs(math.hypot(north, east) - 2.0) < 0.4
        bearings.add(int(math.degrees(math.atan2(east, north)) // 90))
        return len(bearings) == 4

    assert rig.fly(15, turn)


def test_turns_and_looks_at_a_region(rig):
    rig.firmware.now.nose_to_region = True
    rig.take_off(1.5)
    assert rig.do(115, 90.0, 0, 1, 0).result is Ack.ACCEPTED
    assert rig.fly(4, lambda: abs(rig.report.estimate.heading_rad - math.pi / 2) < 0.1)
    assert rig.do(195, x=-5.0, y=0.0, z=0.0, frame=1).result is Ack.ACCEPTED
    assert rig.fly(6, lambda: abs(abs(rig.report.estimate.heading_rad) - math.pi) < 0.1)
    assert rig.do(197).result is Ack.ACCEPTED


@pytest.mark.parametrize(
    ("frame", "mask", "position", "velocity", "where"),
    [
        (7, 0xDF8, (1.0, 0.5, 0.0), (0.0, 0.0, 0.0), (1.0, 0.5, -1.5)),
        (8, 0xDF8, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, -1.5)),
        (9, 0xDF8, (1.0, 0.0, -0.5), (0.0, 0.0, 0.0), (0.0, 1.0, -2.0)),
        (1, 0xDF9, (9.0, 9.0, 9.0), (0.0, 0.0, 0.0), (0.0, 0.0, -1.5)),
    ],
)
def test_offsets_count_from_here_in_the_axes_of_the_frame(rigs, frame, mask, position, velocity, where):
    """The nose points east; a triple of which a part is ignored is ignored."""
    rig = rigs("ardupilot")
    rig.take_off(1.5)
    rig.do(115, 90.0, 0, 1, 0)
    rig.fly(3.0)
    rig.target(frame=frame, mask=mask, position=position, velocity=velocity)
    rig.fly(4.0)
    assert rig.off(*where) < 0.25, rig.true_ned


def test_velocity_in_body_axes(rig):
    rig.take_off(1.5)
    rig.do(115, 90.0, 0, 1, 0)
    rig.fly(3.0)
    rig.offboard(frame=8, mask=0x5C7, velocity=(0.5, 0.0, 0.0))
    rig.fly(3.0)
    assert abs(rig.true_ned[0]) < 0.3
    assert rig.true_ned[1] > 0.8


def test_global_setpoints_and_accelerations(rig):
    rig.take_off(1.5)
    latitude, longitude = rig.firmware.now.origin.globe(1.0, -1.0)
    rig.offboard(frame=6, mask=0xDF8, position=(latitude, longitude, 1.0))
    assert rig.fly(8, lambda: rig.off(1.0, -1.0, -1.0) < 0.2)
    rig.stream(mask=0xC3F, accel=(0.5, 0.0, 0.0))
    rig.fly(2.0)
    assert 0.5 < rig.report.estimate.velocity_ned_mps[0] < 1.3


def test_attitude_setpoints(rig):
    rig.take_off(1.5)
    px4 = rig.firmware.now.row.name == "px4"
    thrust = rig.vehicle.hover_thrust if px4 else 0.5
    lean = (math.cos(0.05), math.sin(0.05), 0.0, 0.0)
    rig.every = lambda: rig.firmware.attitude_target(AttitudeSetpoint(0x07, lean, (0.0, 0.0, 0.0), thrust), rig.now_s)
    rig.every()
    assert rig.mode("offboard").result is Ack.ACCEPTED
    rig.fly(1.5)
    assert 0.07 < rig.report.estimate.roll_rad < 0.13
    assert rig.true_ned[1] > 0.2
    assert abs(rig.true_ned[2] + 1.5) < (1.0 if px4 else 0.3)  # a bare thrust does not hold a height


def test_pause_and_speed(rig):
    rig.take_off(1.5)
    assert rig.do(178, 1, 0.5).result is Ack.ACCEPTED
    assert rig.do(193, 0).result is Ack.ACCEPTED
    assert rig.do(193, 7).result is Ack.DENIED
    assert rig.do(252, 0, 3, 1, 0, x=1.0, y=0.0, z=-1.5).result is Ack.ACCEPTED
    assert rig.fly(6, lambda: rig.off(1.0, 0.0, -1.5) < 0.2)
    assert rig.do(252, 0, 2).result is Ack.ACCEPTED


def test_delay_is_in_progress_until_it_is_over(rig):
    rig.take_off(1.0)
    assert rig.do(93, 1.0).result is Ack.IN_PROGRESS
    rig.fly(0.5)
    assert {result for _, result, _ in rig.firmware.progress()} == {Ack.IN_PROGRESS}
    rig.fly(1.0)
    assert rig.firmware.progress()[-1] == (93, Ack.ACCEPTED, 100)
    rig.do(93, 5.0)
    rig.mode("land")
    assert rig.firmware.progress()[-1] == (93, Ack.CANCELLED, 0)
