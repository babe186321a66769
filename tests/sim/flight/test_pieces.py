"""The vehicle's parts: axes, mixing, rotors, battery, sensors, estimator."""

from math import cos, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.flight.airframe import ARM_M, HOVER_THRUST, MASS_KG, Rotors, ground_effect, mix
from sim.flight.attitude import euler, from_bullet, from_heading, leaning, multiply, normalised, rotate, rotate_back
from sim.flight.estimator import Estimator
from sim.flight.power import Power
from sim.flight.sensing import FIELD_NED_GAUSS, SensorModel, magnetic_heading

share = st.floats(-3.0, 3.0)
angle = st.floats(-3.1, 3.1)
reading = st.tuples(*[st.floats(-60.0, 60.0)] * 3)


@pytest.mark.parametrize(
    ("yaw_rad", "body_frd", "ned"),
    [
        (pi / 2.0, (1.0, 0.0, 0.0), (1.0, 0.0, 0.0)),  # facing north: forward is north
        (pi / 2.0, (0.0, 1.0, 0.0), (0.0, 1.0, 0.0)),  # and right is east
        (0.0, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),  # facing east
        (0.0, (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0)),  # right is south
        (0.0, (0.0, 0.0, 1.0), (0.0, 0.0, 1.0)),  # down is down
    ],
)
def test_axes_of_a_level_body(yaw_rad, body_frd, ned) -> None:
    q = from_bullet(0.0, 0.0, sin(yaw_rad / 2.0), cos(yaw_rad / 2.0))
    assert rotate(q, body_frd) == pytest.approx(ned, abs=1e-9)


def test_a_nose_that_points_up_is_a_positive_pitch_and_a_low_right_side_a_positive_roll() -> None:
    nose_up = from_bullet(0.0, -sin(0.1), 0.0, cos(0.1))  # about the body's left axis, facing east
    assert euler(nose_up) == pytest.approx((0.0, 0.2, pi / 2.0), abs=1e-9)
    right_down = from_bullet(sin(0.1), 0.0, 0.0, cos(0.1))
    assert euler(right_down) == pytest.approx((0.2, 0.0, pi / 2.0), abs=1e-9)


@given(angle, angle, angle, reading)
def test_turning_there_and_back_changes_nothing(a, b, c, vector) -> None:
    q = normalised(multiply(from_heading(a), (cos(b / 2.0), sin(b / 2.0) * cos(c), sin(b / 2.0) * sin(c), 0.0)))
    assert rotate_back(q, rotate(q, vector)) == pytest.approx(vector, abs=1e-6)


@given(st.floats(0.0, 0.7), angle, angle)
def test_leaning_points_the_body_down_where_it_is_asked_to(tilt, side, heading) -> None:
    down = (sin(tilt) * cos(side), sin(tilt) * sin(side), cos(tilt))
    assert rotate(leaning(down, heading), (0.0, 0.0, 1.0)) == pytest.approx(down, abs=1e-9)


@given(st.floats(-1.0, 2.0), share, share, share)
def test_a_mix_never_leaves_what_rotors_can_do(thrust, roll, pitch, yaw) -> None:
    assert all(0.0 <= value <= 1.0 for value in mix(thrust, roll, pitch, yaw))


@given(st.floats(0.0, 1.0), st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), share)
def test_roll_and_pitch_come_before_yaw_and_climb(thrust, roll, pitch, yaw) -> None:
    front_right, rear_left, front_left, rear_right = mix(thrust, roll, pitch, yaw)
    assert (-front_right + rear_left + front_left - rear_right) / 4.0 == pytest.approx(roll, abs=1e-9)
    assert (front_right - rear_left + front_left - rear_right) / 4.0 == pytest.approx(pitch, abs=1e-9)


def test_rotors_push_as_their_places_and_senses_say() -> None:
    rotors = Rotors(1.0)
    rotors.step((1.0, 0.0, 0.0, 0.0), idle=False)  # front right alone, counter-clockwise
    thrust, roll, pitch, yaw = rotors.wrench(16.0, 5.0)
    assert thrust > 6.0
    assert roll == pytest.approx(-ARM_M * thrust)  # to the left
    assert pitch == pytest.approx(ARM_M * thrust)  # nose up
    assert yaw > 0.0  # the body turns clockwise, against the rotor


def test_rotors_hover_with_the_weight_lag_behind_and_lift_more_near_the_floor() -> None:
    rotors = Rotors(1.0 / 240.0)
    wish = (HOVER_THRUST,) * 4
    rotors.step(wish, idle=True)
    assert rotors.wrench(16.0, 5.0)[0] < 0.2 * MASS_KG * 9.81
    for _ in range(240):
        rotors.step(wish, idle=True)
    assert rotors.wrench(16.0, 5.0)[0] == pytest.approx(MASS_KG * 9.81, rel=1e-3)
    assert 1.0 < ground_effect(0.3) < ground_effect(0.0) <= 1.3
    assert ground_effect(3.0) == pytest.approx(1.0, abs=1e-3)


def test_a_battery_sags_and_drains_and_can_be_provoked() -> None:
    power = Power()
    full_v = power.state.voltage_v
    power.draw(300.0, 1.0)
    assert power.state.voltage_v < full_v
    assert power.state.current_a == pytest.approx(300.0 / full_v)
    for _ in range(60):
        power.draw(200.0, 10.0)
    assert 0.3 < power.state.remaining < 0.7
    power.provoke(0.2, None, None)
    power.draw(6.0, 0.05)
    assert power.state.remaining == pytest.approx(0.2, abs=0.01)
    power.provoke(None, 10.0, None)
    power.draw(200.0, 1.0)
    assert power.state.remaining == pytest.approx(0.1, abs=0.01)
    power.provoke(None, None, 12.5)
    power.draw(200.0, 1.0)
    assert power.state.voltage_v == 12.5


def test_the_compass_finds_north_leaning_or_not() -> None:
    for roll, pitch, heading in ((0.0, 0.0, 1.0), (0.2, -0.1, -2.0), (-0.3, 0.3, 3.0)):
        q = multiply(
            from_heading(heading),
            multiply((cos(pitch / 2), 0.0, sin(pitch / 2), 0.0), (cos(roll / 2), sin(roll / 2), 0.0, 0.0)),
        )
        mag = rotate_back(q, FIELD_NED_GAUSS)
        found = magnetic_heading(mag, *euler(q)[:2])
        assert (found - heading + pi) % (2.0 * pi) - pi == pytest.approx(0.0, abs=1e-9)


def test_sensors_are_noisy_and_the_same_for_the_same_seed() -> None:
    def some(seed: int) -> list[object]:
        model = SensorModel(seed, fixes=True, altitude_m=0.0)
        model.inertial((0.0, 0.0, 0.0), (0.0, 0.0, -9.81))
        model.slow((1.0, 0.0, 0.0, 0.0), (1.0, 2.0, -3.0), (0.0, 0.0, 0.0))
        return [
            model.readings.gyro_frd_radps,
            model.readings.accel_frd_mps2,
            model.readings.fix_ned_m,
            model.baro_height_m(),
        ]

    assert some(3) == some(3) != some(4)
    assert some(3)[2] == pytest.approx((1.0, 2.0, -3.0), abs=0.1)
    assert some(3)[3] == pytest.approx(3.0, abs=0.5)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(reading, reading), min_size=1, max_size=40))
def test_an_estimate_stays_finite_whatever_the_sensors_say(readings) -> None:
    estimator = Estimator((0.0, 0.0, 0.0), 0.0)
    for number, (gyro, accel) in enumerate(readings * 10):
        estimator.predict(gyro, accel, 1.0 / 240.0)
        if number % 12 == 0:
            estimator.fix(number / 240.0, accel, gyro, 0.05)
            estimator.compass(number / 240.0, accel)
    estimator.tell(2.0)
    told = estimator.estimate
    assert all(abs(v) < 1e6 for v in (*told.position_ned_m, *told.velocity_ned_mps))
    assert sum(v * v for v in told.attitude) == pytest.approx(1.0, abs=0.02)
