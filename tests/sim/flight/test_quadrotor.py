"""A vehicle in the physics: it hovers, flies, lands, falls, tips and loses its way as a real one would."""

from math import dist, pi

import pytest

from sim.bullet import STEP_S
from sim.flight.quadrotor import Quadrotor
from sim.flight.state import AttitudeTarget, Trajectory
from sim.flight.world import BareFloor


@pytest.fixture
def world():
    made = BareFloor(seed=7)
    made.advance(0.5)
    yield made
    made.close()


def place_ned(vehicle: Quadrotor) -> tuple[float, float, float]:
    (east, north, up), _ = vehicle.true_pose()
    return (north, east, -up)


def take_off(world: BareFloor, down_m: float = -1.5) -> Quadrotor:
    vehicle = world.vehicles[0]
    vehicle.arm()
    vehicle.command(Trajectory((0.0, 0.0, down_m), heading_rad=0.0))
    world.advance(6.0)
    assert dist(place_ned(vehicle), (0.0, 0.0, down_m)) < 0.1
    assert not vehicle.on_ground
    return vehicle


def test_disarmed_it_stands_where_it_was_put_and_knows_it(world) -> None:
    vehicle = world.vehicles[0]
    world.advance(2.0)
    assert dist(place_ned(vehicle), (0.0, 0.0, 0.0)) < 0.01
    assert vehicle.on_ground
    assert vehicle.rotors == (0.0, 0.0, 0.0, 0.0)
    assert vehicle.estimate.position_ok
    assert dist(vehicle.estimate.position_ned_m, (0.0, 0.0, 0.0)) < 0.08


def test_it_flies_to_a_place_turns_and_lands(world) -> None:
    vehicle = take_off(world)
    vehicle.command(Trajectory((2.0, -1.0, -2.0), heading_rad=pi / 2.0))
    world.advance(6.0)
    assert dist(place_ned(vehicle), (2.0, -1.0, -2.0)) < 0.1
    assert vehicle.true_pose()[1] == pytest.approx(0.0, abs=0.1), "heading east is yaw 0"
    vehicle.command(Trajectory((2.0, -1.0, None), (None, None, 0.5)))
    world.advance(6.0)
    assert vehicle.on_ground
    vehicle.disarm()
    assert dist(place_ned(vehicle), (2.0, -1.0, 0.0)) < 0.1


def test_it_follows_velocities_and_a_turning_rate(world) -> None:
    vehicle = take_off(world)
    vehicle.command(Trajectory(velocity_ned_mps=(0.0, 1.0, 0.0), heading_rate_radps=0.5))
    world.advance(3.0)
    assert vehicle.estimate.velocity_ned_mps == pytest.approx((0.0, 1.0, 0.0), abs=0.2)
    assert vehicle.estimate.heading_rad == pytest.approx(1.5, abs=0.25)


def test_it_holds_an_attitude_and_a_thrust(world) -> None:
    vehicle = take_off(world, -3.0)
    vehicle.command(AttitudeTarget((0.9962, 0.0, -0.0872, 0.0), (0.0, 0.0, 0.0), 1.02 * vehicle.hover_thrust))
    world.advance(1.0)
    assert vehicle.estimate.pitch_rad == pytest.approx(-0.1745, abs=0.05)
    assert vehicle.estimate.velocity_ned_mps[0] > 0.8, "nose down flies north"


def test_lowered_by_thrust_alone_it_notices_the_floor(world) -> None:
    vehicle = take_off(world, -0.4)
    for share in (0.93, 0.8, 0.6):
        vehicle.command(AttitudeTarget((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), share * vehicle.hover_thrust))
        world.advance(1.0)
    assert vehicle.on_ground


def test_without_power_it_falls_as_things_fall(world) -> None:
    vehicle = take_off(world, -2.5)
    vehicle.disarm()
    world.advance(0.4)
    assert place_ned(vehicle)[2] == pytest.approx(-2.5 + 0.5 * 9.81 * 0.4**2, abs=0.12)
    world.advance(3.0)
    assert vehicle.on_ground
    assert abs(place_ned(vehicle)[2]) < 0.2


def test_an_empty_battery_lets_it_down(world) -> None:
    vehicle = take_off(world)
    vehicle.set_battery(0.0, None, None)
    world.advance(2.0)
    assert place_ned(vehicle)[2] > -0.2


def test_it_dead_reckons_for_a_while_and_says_so(world) -> None:
    vehicle = take_off(world)
    vehicle.fail("fix", works=False)
    world.advance(2.0)
    assert not vehicle.estimate.position_ok
    assert vehicle.estimate.position_std_m > 0.2
    assert dist(place_ned(vehicle)[:2], (0.0, 0.0)) < 2.0
    vehicle.fail("fix", works=True)
    world.advance(3.0)
    assert vehicle.estimate.position_ok
    assert dist(place_ned(vehicle), (0.0, 0.0, -1.5)) < 0.15


def test_a_pose_from_outside_takes_the_place_of_fixes() -> None:
    world = BareFloor(seed=3, fixes=False)
    vehicle = world.vehicles[0]
    world.advance(1.0)
    assert not vehicle.estimate.position_ok

    def advance(span_s: float) -> None:
        for _ in range(round(span_s / 0.025)):
            vehicle.external_pose(world.now_s, place_ned(vehicle), None)
            world.advance(0.025)

    advance(1.0)
    assert vehicle.estimate.position_ok
    vehicle.arm()
    vehicle.command(Trajectory((0.0, 0.0, -1.0), heading_rad=0.0))
    advance(6.0)
    assert dist(place_ned(vehicle), (0.0, 0.0, -1.0)) < 0.15
    world.advance(1.5)
    assert not vehicle.estimate.position_ok
    world.close()


def test_a_wall_can_tip_it_over() -> None:
    world = BareFloor(seed=1)
    bullet, vehicle = world.bullet, world.vehicles[0]
    wall = bullet.createMultiBody(
        0.0, bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=(2.0, 0.1, 0.6)), basePosition=(0.0, 2.5, 0.6)
    )
    bullet.setCollisionFilterGroupMask(wall, -1, 2, 0x7FFF)
    world.advance(1.0)
    vehicle = take_off(world, -1.0)
    vehicle.command(Trajectory(velocity_ned_mps=(4.0, 0.0, 0.0)))
    tipped = False
    for _ in range(80):
        world.advance(0.05)
        tipped = tipped or vehicle.tipped
    assert tipped or place_ned(vehicle)[0] < 2.6
    assert place_ned(vehicle)[0] < 2.6, "nothing flies through a wall"
    world.close()


def test_several_fly_in_one_world_and_the_same_seed_flies_the_same() -> None:
    def fly() -> list[object]:
        world = BareFloor(3, seed=5)
        world.advance(0.5)
        for vehicle in world.vehicles:
            vehicle.arm()
            n, e, _ = vehicle.estimate.position_ned_m
            vehicle.command(Trajectory((n, e, -1.0), heading_rad=0.0))
        world.advance(3.0)
        poses: list[object] = [vehicle.true_pose() for vehicle in world.vehicles]
        world.close()
        return poses

    first = fly()
    assert first == fly()
    assert all(0.8 < pose[0][2] < 1.2 for pose in first)  # type: ignore[index]


def test_a_unit_that_is_not_there_cannot_fail(world) -> None:
    with pytest.raises(ValueError, match="no unit sonar; there are accel, baro"):
        world.vehicles[0].fail("sonar", works=False)


def test_a_step_is_that_of_the_physics() -> None:
    world = BareFloor()
    world.advance(1.0)
    assert world.steps == round(1.0 / STEP_S)
    world.close()
