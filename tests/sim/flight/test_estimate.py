"""What the estimator is worth when its sources come late, go away or come back."""

from math import dist, pi, sqrt
from random import Random

import pytest

from sim.flight.quadrotor import Quadrotor
from sim.flight.state import Trajectory, Vec3
from sim.flight.world import BareFloor


def place_ned(vehicle: Quadrotor) -> Vec3:
    (east, north, up), _ = vehicle.true_pose()
    return (north, east, -up)


def in_the_air(world: BareFloor) -> Quadrotor:
    vehicle = world.vehicles[0]
    world.advance(1.0)
    vehicle.arm()
    vehicle.command(Trajectory((0.0, 0.0, -2.0), heading_rad=0.0))
    world.advance(6.0)
    return vehicle


@pytest.fixture
def world():
    made = BareFloor(seed=3)
    yield made
    made.close()


@pytest.fixture
def blind_world():
    made = BareFloor(seed=1, fixes=False)
    yield made
    made.close()


def test_a_pose_that_comes_late_is_passed_over(blind_world) -> None:
    vehicle = blind_world.vehicles[0]
    blind_world.advance(1.0)
    for number in range(240):
        vehicle.external_pose(blind_world.now_s, place_ned(vehicle), None)
        vehicle.external_pose(blind_world.now_s - 0.5, (1.0, 1.0, 0.0), None)
        if number == 20:
            vehicle.arm()
            vehicle.command(Trajectory((0.0, 0.0, -1.0), heading_rad=0.0))
        blind_world.advance(0.025)
    assert dist(vehicle.estimate.position_ned_m, place_ned(vehicle)) < 0.1
    assert dist(place_ned(vehicle), (0.0, 0.0, -1.0)) < 0.15


@pytest.mark.parametrize("seed", [3, 7])
def test_poses_without_a_heading_leave_it_to_the_compass(seed) -> None:
    world = BareFloor(seed=seed, fixes=False)
    vehicle = world.vehicles[0]
    world.advance(1.0)
    vehicle.arm()
    for number in range(500):
        vehicle.external_pose(world.now_s, place_ned(vehicle), None)
        if number == 20:
            vehicle.command(Trajectory((0.0, 0.0, -1.0), heading_rad=2.0))
        world.advance(0.05)
    true_heading = pi / 2.0 - vehicle.true_pose()[1]
    assert (true_heading - 2.0 + pi) % (2.0 * pi) - pi == pytest.approx(0.0, abs=0.1)
    world.close()


def test_it_stays_where_it_stands_without_any_position(blind_world) -> None:
    vehicle = blind_world.vehicles[0]
    blind_world.advance(60.0)
    assert dist(vehicle.estimate.position_ned_m, (0.0, 0.0, 0.0)) < 0.5
    assert dist(vehicle.estimate.velocity_ned_mps, (0.0, 0.0, 0.0)) < 0.05
    assert not vehicle.estimate.position_ok


def test_a_fix_that_returns_brings_its_velocity(world) -> None:
    vehicle = in_the_air(world)
    vehicle.command(Trajectory(velocity_ned_mps=(4.0, 0.0, 0.0), heading_rad=0.0))
    world.advance(3.0)
    vehicle.fail("fix", works=False)
    world.advance(1.6)
    assert not vehicle.estimate.position_ok
    vehicle.fail("fix", works=True)
    leans = []
    for _ in range(20):
        world.advance(0.05)
        leans.append(vehicle.estimate.pitch_rad)
    assert vehicle.estimate.position_ok
    assert min(leans) > -0.3, "it flies on as it did, without a leap"
    assert vehicle.estimate.velocity_ned_mps[0] == pytest.approx(4.0, abs=0.4)


def test_poses_that_return_after_a_short_while_keep_the_velocity(blind_world) -> None:
    vehicle = blind_world.vehicles[0]
    blind_world.advance(1.0)

    def advance(span_s: float) -> None:
        for _ in range(round(span_s / 0.05)):
            vehicle.external_pose(blind_world.now_s, place_ned(vehicle), 0.0)
            blind_world.advance(0.05)

    advance(1.0)
    vehicle.arm()
    vehicle.command(Trajectory((0.0, 0.0, -2.0), heading_rad=0.0))
    advance(6.0)
    vehicle.command(Trajectory(velocity_ned_mps=(3.0, 0.0, 0.0), heading_rad=0.0))
    advance(3.0)
    blind_world.advance(1.5)
    assert not vehicle.estimate.position_ok
    advance(0.05)
    assert vehicle.estimate.velocity_ned_mps[0] == pytest.approx(3.0, abs=0.6)


def test_the_height_is_known_by_the_barometer_alone_and_not_without_it(world) -> None:
    vehicle = in_the_air(world)
    vehicle.fail("fix", works=False)
    world.advance(2.0)
    assert vehicle.estimate.height_ok
    vehicle.fail("baro", works=False)
    world.advance(2.0)
    assert not vehicle.estimate.height_ok
    vehicle.fail("baro", works=True)
    world.advance(0.1)
    assert vehicle.estimate.height_ok


def test_without_a_gyroscope_the_attitude_is_not_to_be_relied_on(world) -> None:
    vehicle = in_the_air(world)
    assert vehicle.estimate.attitude_ok
    vehicle.fail("gyro", works=False)
    world.advance(0.1)
    assert not vehicle.estimate.attitude_ok
    vehicle.fail("gyro", works=True)
    world.advance(0.1)
    assert vehicle.estimate.attitude_ok


def test_without_a_compass_it_keeps_its_heading_for_a_while(world) -> None:
    vehicle = in_the_air(world)
    vehicle.fail("mag", works=False)
    world.advance(10.0)
    assert dist(place_ned(vehicle), (0.0, 0.0, -2.0)) < 0.1
    assert vehicle.true_pose()[1] == pytest.approx(pi / 2.0, abs=0.2)


@pytest.mark.parametrize("every", [48, 24, 8, 2])
@pytest.mark.parametrize("late", [0, 24])
def test_noisy_poses_hold_the_place_at_any_rate_and_somewhat_late(every, late) -> None:
    """`every`: physics steps from pose to pose, 5 to 120 Hz. `late`: steps by which they are old, up to 100 ms."""
    world, noise = BareFloor(seed=2, fixes=False), Random(2)
    vehicle, track = world.vehicles[0], list[Vec3]()

    def advance(steps: int) -> None:
        for _ in range(steps):
            track.append(place_ned(vehicle))
            if world.steps % every == 0:
                n, e, d = track[max(0, len(track) - 1 - late)]
                seen = (n + noise.gauss(0.0, 0.01), e + noise.gauss(0.0, 0.01), d + noise.gauss(0.0, 0.01))
                vehicle.external_pose(world.now_s, seen, None)
            world.advance(1.0 / 240.0)

    advance(240)
    vehicle.arm()
    vehicle.command(Trajectory((0.0, 0.0, -2.0), heading_rad=0.0))
    advance(8 * 240)
    track.clear()
    track.append(place_ned(vehicle))
    advance(10 * 240)
    held = track[1:]
    assert sqrt(sum(dist(place, (0.0, 0.0, -2.0)) ** 2 for place in held) / len(held)) < 0.05
    world.close()


def told(vehicle, world, span_s: float, where=None, heading_rad: float | None = 0.0) -> None:
    """A pose twenty times a second, from `where` or where it truly is."""
    for _ in range(round(span_s / 0.05)):
        vehicle.external_pose(world.now_s, where or place_ned(vehicle), heading_rad)
        world.advance(0.05)


@pytest.mark.parametrize("absurd", [(1500.0, -900.0, -40.0), (0.0, 6.0, -2.0)])
def test_absurd_poses_among_good_ones_are_not_believed(blind_world, absurd) -> None:
    vehicle = blind_world.vehicles[0]
    blind_world.advance(1.0)
    told(vehicle, blind_world, 1.0)
    vehicle.arm()
    vehicle.command(Trajectory((0.0, 0.0, -2.0), heading_rad=0.0))
    told(vehicle, blind_world, 6.0)
    for _ in range(5):
        assert not vehicle.external_pose(blind_world.now_s, absurd, 2.5)
        blind_world.advance(0.05)
        told(vehicle, blind_world, 0.5)
        assert vehicle.estimate.position_ok
        assert dist(place_ned(vehicle), (0.0, 0.0, -2.0)) < 0.3


def test_a_stream_of_absurd_poses_loses_the_place_and_moves_it_only_when_it_insists(blind_world) -> None:
    vehicle = blind_world.vehicles[0]
    blind_world.advance(1.0)
    told(vehicle, blind_world, 1.0)
    told(vehicle, blind_world, 3.0, (1500.0, 0.0, 0.0))
    assert not vehicle.estimate.position_ok
    assert dist(vehicle.estimate.position_ned_m, (0.0, 0.0, 0.0)) < 1.0
    told(vehicle, blind_world, 3.0, (1500.0, 0.0, 0.0))
    assert vehicle.estimate.position_ok, "it was carried, or its tracker began anew"
    assert dist(vehicle.estimate.position_ned_m, (1500.0, 0.0, 0.0)) < 0.2


def test_poses_far_from_the_fixes_are_never_believed(world) -> None:
    vehicle = in_the_air(world)
    told(vehicle, world, 8.0, (300.0, 40.0, -9.0), 2.0)
    told(vehicle, world, 8.0, None, 2.0)
    assert vehicle.estimate.position_ok
    assert dist(place_ned(vehicle), (0.0, 0.0, -2.0)) < 0.1
    assert abs(vehicle.estimate.heading_rad) < 0.1, "nor a heading that the compass speaks against"


def test_the_heading_of_the_first_poses_is_taken_and_a_leap_of_it_is_not(blind_world) -> None:
    vehicle = blind_world.vehicles[0]
    blind_world.advance(1.0)
    told(vehicle, blind_world, 1.0, heading_rad=2.0)
    assert vehicle.estimate.heading_rad == pytest.approx(2.0, abs=0.05)
    told(vehicle, blind_world, 0.5, heading_rad=-1.0)
    assert vehicle.estimate.heading_rad == pytest.approx(2.0, abs=0.05)
    assert vehicle.estimate.position_ok
