"""The vehicle obeys physics: weight, energy, symmetry, and every axis the way its frames say."""

from math import cos, dist, pi, sin

import pytest

from sim.bullet import GRAVITY_MPS2
from sim.flight.airframe import HALF_M, HOVER_THRUST, MASS_KG, MAX_THRUST_N, Rotors
from sim.flight.quadrotor import Quadrotor
from sim.flight.state import AttitudeTarget, Trajectory, Vec3
from sim.flight.world import BareFloor
from wire.frames import enu_to_ned, ned_to_enu, yaw_to_heading_rad


@pytest.fixture
def hovering():
    world = BareFloor(seed=2)
    world.advance(1.0)
    vehicle = world.vehicles[0]
    vehicle.arm()
    vehicle.command(Trajectory((0.0, 0.0, -2.0), heading_rad=0.0))
    world.advance(7.0)
    yield world, vehicle
    world.close()


def place_ned(vehicle: Quadrotor) -> Vec3:
    return enu_to_ned(vehicle.true_pose()[0])


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_each_axis_of_a_place_is_the_site_s(hovering, axis, sign) -> None:
    world, vehicle = hovering
    wish = [0.0, 0.0, -2.0]
    wish[axis] += sign
    vehicle.command(Trajectory((wish[0], wish[1], wish[2]), heading_rad=0.0))
    world.advance(5.0)
    assert vehicle.true_pose()[0] == pytest.approx(ned_to_enu((wish[0], wish[1], wish[2])), abs=0.1)
    assert vehicle.estimate.position_ned_m == pytest.approx(tuple(wish), abs=0.1)


@pytest.mark.parametrize(
    ("rates", "axis", "sign"),
    [
        ((0.6, 0.0, 0.0), 1, 1.0),  # rolling right flies to the right: east, looking north
        ((-0.6, 0.0, 0.0), 1, -1.0),
        ((0.0, 0.6, 0.0), 0, -1.0),  # nose up flies backwards
        ((0.0, -0.6, 0.0), 0, 1.0),
    ],
)
def test_each_rate_leans_to_its_side(hovering, rates, axis, sign) -> None:
    world, vehicle = hovering
    vehicle.command(AttitudeTarget(None, rates, HOVER_THRUST))
    world.advance(0.5)
    assert vehicle.estimate.rates_frd_radps == pytest.approx(rates, abs=0.1)
    world.advance(0.1)
    assert sign * vehicle.estimate.velocity_ned_mps[axis] > 0.1
    assert sign * place_ned(vehicle)[axis] > 0.01


@pytest.mark.parametrize("rate", [0.5, -0.5])
def test_a_positive_yaw_rate_turns_clockwise_seen_from_above(hovering, rate) -> None:
    world, vehicle = hovering
    vehicle.command(AttitudeTarget(None, (0.0, 0.0, rate), HOVER_THRUST))
    world.advance(1.0)
    assert yaw_to_heading_rad(vehicle.true_pose()[1]) == pytest.approx(rate, abs=0.15)


def test_hovering_the_rotors_carry_the_weight(hovering) -> None:
    world, vehicle = hovering
    thrusts = []
    for _ in range(40):
        world.advance(0.05)
        full = 4.0 * MAX_THRUST_N * (vehicle.battery.voltage_v / 16.0) ** 2
        thrusts.append(full * sum(speed * speed for speed in vehicle.rotors) / 4.0)
    assert sum(thrusts) / len(thrusts) == pytest.approx(MASS_KG * GRAVITY_MPS2, rel=0.02)
    assert vehicle.sensors.accel_frd_mps2[2] == pytest.approx(-GRAVITY_MPS2, abs=0.5)


def test_the_same_thrust_takes_the_same_power_at_any_voltage() -> None:
    def power_w(voltage_v: float) -> float:
        rotors = Rotors(1.0)
        share = HOVER_THRUST * (16.0 / voltage_v) ** 2
        for _ in range(3):
            rotors.step((share,) * 4, idle=True)
        assert rotors.wrench(voltage_v, 5.0)[0] == pytest.approx(MASS_KG * GRAVITY_MPS2, rel=1e-3)
        return rotors.power_w(voltage_v)

    assert power_w(13.2) == pytest.approx(power_w(16.6), rel=1e-3)


def test_flying_takes_the_energy_that_the_battery_gives(hovering) -> None:
    world, vehicle = hovering
    before, energy_wh = vehicle.battery.consumed_mah, 0.0
    for _ in range(200):
        world.advance(0.05)
        energy_wh += vehicle.battery.voltage_v * vehicle.battery.current_a * 0.05 / 3600.0
    used_wh = (vehicle.battery.consumed_mah - before) / 1000.0 * vehicle.battery.voltage_v
    assert used_wh == pytest.approx(energy_wh, rel=0.05)
    ideal_w = (MASS_KG * GRAVITY_MPS2) ** 1.5 / (2.0 * 1.2 * 4.0 * pi * 0.11**2) ** 0.5
    assert ideal_w < used_wh * 360.0 < 3.0 * ideal_w, "more than momentum theory asks for, not thrice as much"


def test_it_answers_alike_to_every_side() -> None:
    ends = []
    for quarter in range(4):
        side = quarter * pi / 2.0
        world = BareFloor(seed=2)
        vehicle = world.vehicles[0]
        world.advance(1.0)
        vehicle.arm()
        vehicle.command(Trajectory((0.0, 0.0, -2.0), heading_rad=0.0))
        world.advance(7.0)
        vehicle.command(Trajectory((3.0 * cos(side), 3.0 * sin(side), -2.0), heading_rad=0.0))
        world.advance(1.5)
        north, east, _ = place_ned(vehicle)
        ends.append(north * cos(side) + east * sin(side))
        world.close()
    assert max(ends) - min(ends) < 0.1
    assert 1.0 < min(ends) < 2.9


def test_a_broken_battery_gives_nothing_and_a_mended_one_what_it_had(hovering) -> None:
    world, vehicle = hovering
    before = vehicle.battery.remaining
    vehicle.fail("battery", works=False)
    world.advance(0.5)
    assert vehicle.battery.remaining == 0.0
    assert place_ned(vehicle)[2] > -1.6
    vehicle.fail("battery", works=True)
    assert vehicle.battery.remaining == before


def test_two_that_meet_in_the_air_touch() -> None:
    world = BareFloor(2, seed=4)
    world.advance(1.0)
    one, other = world.vehicles
    for vehicle in world.vehicles:
        vehicle.arm()
        north, east, _ = vehicle.estimate.position_ned_m
        vehicle.command(Trajectory((north, east, -1.5), heading_rad=0.0))
    world.advance(5.0)
    east_of_both = 0.75
    for vehicle in world.vehicles:
        vehicle.command(Trajectory((0.0, east_of_both, -1.5), heading_rad=0.0))
    touched = False
    for _ in range(480):
        world.advance(1.0 / 240.0)
        touched = touched or bool(world.bullet.getContactPoints(one.body, other.body))
    assert touched
    assert dist(place_ned(one), place_ned(other)) > HALF_M[2], "neither is inside the other"
    world.close()


def test_what_stands_with_its_rotors_off_is_looked_at_less_often_and_wakes() -> None:
    world = BareFloor(seed=6)
    vehicle = world.vehicles[0]
    world.advance(1.0)

    def looks(steps: int) -> int:
        """At how many of the coming steps the gyroscope is read."""
        seen, before = 0, vehicle.sensors.gyro_frd_radps
        for _ in range(steps):
            world.advance(1.0 / 240.0)
            seen += vehicle.sensors.gyro_frd_radps != before
            before = vehicle.sensors.gyro_frd_radps
        return seen

    assert looks(48) == 12
    world.bullet.resetBaseVelocity(vehicle.body, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.advance(4.0 / 240.0)
    assert looks(24) == 24, "it was pushed"
    world.advance(3.0)
    assert looks(24) == 6
    vehicle.arm()
    assert looks(24) == 24
    world.close()
