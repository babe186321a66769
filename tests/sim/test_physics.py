"""Robots drive, stop at what is solid, and push what is loose; the lidar measures it."""

from math import cos, hypot, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.flight.state import Trajectory
from sim.lidar import ANGLE_MIN_RAD, ANGLE_STEP_RAD, BEAMS, HEIGHT_M, RANGE_M, Lidar
from sim.physics import Physics, RobotStart
from sim.rover import BODY_SIZE_M, Wish
from tests.sim.small_home import BALL, FRIDGE, MUG, make_small_home


@pytest.fixture
def make_physics():
    made = []

    def make(*starts):
        physics = Physics(make_small_home(), [RobotStart(f"dog-{k + 1}", p, yaw) for k, (p, yaw) in enumerate(starts)])
        made.append(physics)
        return physics

    yield make
    for physics in made:
        physics.close()


def test_a_robot_drives_at_the_speed_asked_for_and_stays_upright(make_physics):
    physics = make_physics(((1.5, 2.5), 0.0))
    rover = physics.robots["dog-1"]
    rover.wish = Wish(forward_mps=0.5)
    physics.advance(480)
    assert rover.motion().position_m == pytest.approx((1.5 + 0.5 * 2 - 0.5**2 / 2 / 2.0, 2.5), abs=0.01)
    assert rover.motion().speed_mps == pytest.approx(0.5, abs=1e-6)
    assert rover.box().centre_m[2] == pytest.approx(0.235)
    assert not physics.in_contact("dog-1")
    assert physics.collisions == 0


def test_a_robot_turns_in_place(make_physics):
    physics = make_physics(((2.0, 2.5), 0.0))
    rover = physics.robots["dog-1"]
    rover.wish = Wish(yaw_rate_radps=pi / 2)
    physics.advance(240)
    rover.wish = Wish()
    physics.advance(120)
    assert rover.motion().yaw_rad == pytest.approx(pi / 2, abs=0.05)
    assert rover.motion().position_m == pytest.approx((2.0, 2.5), abs=1e-3)


@settings(max_examples=15, deadline=None)
@given(yaw_rad=st.floats(-pi, pi), speed_mps=st.floats(0.2, 2.0), left_mps=st.floats(-2.0, 2.0))
def test_no_robot_passes_a_wall(yaw_rad, speed_mps, left_mps):
    physics = Physics(make_small_home(), [RobotStart("dog-1", (2.5, 2.5), yaw_rad)])
    rover = physics.robots["dog-1"]
    rover.wish = Wish(forward_mps=speed_mps, left_mps=left_mps, yaw_rate_radps=0.4)
    for _ in range(40):
        physics.advance(60)
        x, y = rover.motion().position_m
        # No closer than half the body's narrow side to the outer walls' faces.
        assert 0.05 + BODY_SIZE_M[1] / 2 - 0.01 < x < 9.95 - BODY_SIZE_M[1] / 2 + 0.01
        assert 0.05 + BODY_SIZE_M[1] / 2 - 0.01 < y < 4.95 - BODY_SIZE_M[1] / 2 + 0.01
        assert rover.box().centre_m[2] == pytest.approx(0.235, abs=0.005)
    physics.close()


def test_a_wall_stops_a_robot_and_counts_as_one_collision(make_physics):
    physics = make_physics(((1.0, 1.0), pi))
    rover = physics.robots["dog-1"]
    rover.wish = Wish(forward_mps=0.5)
    physics.advance(720)
    assert rover.motion().position_m[0] == pytest.approx(0.05 + BODY_SIZE_M[0] / 2, abs=0.005)
    assert rover.motion().speed_mps < 0.02
    assert physics.in_contact("dog-1")
    assert physics.collisions == 1
    rover.wish = Wish(forward_mps=-0.5)
    physics.advance(240)
    rover.wish = Wish(forward_mps=0.5)
    physics.advance(480)
    assert physics.collisions == 2


def test_two_robots_pushing_each_other_do_not_interpenetrate(make_physics):
    physics = make_physics(((2.0, 2.5), 0.0), ((3.5, 2.5), pi))
    for rover in physics.robots.values():
        rover.wish = Wish(forward_mps=0.8)
    for _ in range(16):
        physics.advance(60)
        first, second = (rover.motion().position_m for rover in physics.robots.values())
        assert hypot(second[0] - first[0], second[1] - first[1]) > BODY_SIZE_M[0] - 0.002
    assert physics.collisions == 1


def test_a_parked_robot_is_not_pushed_away(make_physics):
    physics = make_physics(((2.0, 2.5), 0.0), ((3.5, 2.5), 0.0))
    physics.robots["dog-1"].wish = Wish(forward_mps=0.5)
    physics.advance(960)
    assert physics.robots["dog-2"].motion().position_m[0] < 3.62


def test_loose_things_sleep_until_they_are_touched(make_physics):
    physics = make_physics(((2.0, 1.0), 0.0))
    before = physics.scene.bodies[BALL].position_m
    mug_before = physics.scene.bodies[MUG].position_m
    physics.advance(240)
    assert physics.scene.bodies[BALL].position_m == before
    physics.robots["dog-1"].wish = Wish(forward_mps=0.5)
    physics.advance(960)
    assert physics.scene.bodies[BALL].position_m[0] > before[0] + 0.3
    assert physics.scene.bodies[MUG].position_m == mug_before
    assert physics.collisions == 0


def test_sleeping_things_cost_next_to_nothing(make_physics):
    physics = make_physics(((2.0, 2.5), 0.0))
    physics.advance(24)
    assert physics.awake_count() == 1  # the robot itself
    physics.robots["dog-1"].wish = Wish(forward_mps=0.5, left_mps=-0.5)
    physics.advance(720)
    assert physics.awake_count() == 2  # the ball that it pushes


def test_the_same_commands_give_the_same_world_to_the_last_bit(make_physics):
    def episode():
        physics = make_physics(((2.0, 1.0), 0.0))
        physics.robots["dog-1"].wish = Wish(forward_mps=0.6, yaw_rate_radps=0.05)
        physics.advance(1200)
        return physics.robots["dog-1"].motion(), physics.scene.bodies[BALL].position_m

    assert episode() == episode()


def test_a_world_at_rest_goes_on_exactly_as_if_every_step_had_been_worked_out(make_physics):
    def run(awake):
        physics = make_physics(((1.5, 2.5), 0.3), ((4.0, 1.0), 1.0))
        seen = []
        for tick in range(160):
            if awake:
                physics.place(FRIDGE)  # changes nothing, but has the next step worked out
            if tick in (40, 100):
                physics.robots["dog-1"].wish = Wish(0.6, 0.1, 0.4)
            if tick in (60, 130):
                physics.robots["dog-1"].wish = Wish()
            physics.advance(12)
            seen.append(([rover.state() for rover in physics.robots.values()], physics.step_count, physics.collisions))
        return seen

    assert run(awake=False) == run(awake=True)


def test_a_sweep_among_things_that_stand_is_as_good_as_a_new_one(make_physics):
    physics = make_physics(((1.5, 2.5), 0.3), ((4.0, 1.0), 1.0))
    lidar = Lidar(physics, "dog-1")
    first = lidar.sweep()
    physics.advance(12)
    assert lidar.sweep() == first
    physics.robots["dog-2"].wish = Wish(forward_mps=0.5)
    physics.advance(120)
    assert lidar.sweep() == Lidar(physics, "dog-1").sweep()
    assert lidar.sweep() != first, "the other robot is seen to have moved"


def test_the_lidar_measures_the_walls_and_sees_other_robots(make_physics):
    physics = make_physics(((2.5, 2.5), 0.0), ((2.5, 3.5), 0.0))
    ranges = Lidar(physics, "dog-1").sweep()

    def at(angle_rad):
        return ranges[round((angle_rad - ANGLE_MIN_RAD) / ANGLE_STEP_RAD)]

    assert at(-pi) == pytest.approx(2.45, abs=0.01)
    assert at(-pi / 2) == pytest.approx(2.45, abs=0.01)
    assert at(pi / 2) == pytest.approx(1.0 - BODY_SIZE_M[1] / 2, abs=0.01)
    assert at(0.0) == 0.0  # through the doorway nothing is within 6 m
    assert physics.scene.bodies[FRIDGE].type == "Fridge"


@settings(max_examples=25, deadline=None)
@given(x=st.floats(1.5, 4.4), y=st.floats(1.5, 3.5), yaw_rad=st.floats(-pi, pi))
def test_the_lidar_agrees_with_rays_through_the_physics(x, y, yaw_rad):
    physics = Physics(make_small_home(), [RobotStart("dog-1", (x, y), yaw_rad), RobotStart("dog-2", (8.0, 2.5), 0.3)])
    ranges = Lidar(physics, "dog-1").sweep()
    angles = [yaw_rad + ANGLE_MIN_RAD + k * ANGLE_STEP_RAD for k in range(BEAMS)]
    ends = [(x + RANGE_M * cos(a), y + RANGE_M * sin(a), HEIGHT_M) for a in angles]
    shares = physics.cast("dog-1", [(x, y, HEIGHT_M)] * BEAMS, ends)
    rays = [RANGE_M * share if share < 1.0 else 0.0 for share in shares]
    # A beam that grazes an edge may fall on either side of it.
    assert sum(abs(a - b) > 0.005 for a, b in zip(ranges, rays, strict=True)) <= 2
    physics.close()


def test_legs_trot_stand_and_stop_at_walls():
    physics = Physics(make_small_home(), [RobotStart("dog-1", (2.0, 2.5), 0.0)], legs=True)
    rover = physics.robots["dog-1"]
    physics.advance(120)
    assert rover.motion().position_m == pytest.approx((2.0, 2.5), abs=0.01)
    rover.wish = Wish(forward_mps=0.5)
    physics.advance(480)
    assert 2.7 < rover.motion().position_m[0] < 3.1
    rover.wish = Wish(yaw_rate_radps=1.2)
    physics.advance(240)
    assert 0.9 < rover.motion().yaw_rad < 1.3
    assert physics.collisions == 0
    rover.wish = Wish(forward_mps=0.6)
    physics.advance(1600)
    assert rover.motion().position_m[1] < 4.95
    assert physics.collisions >= 1
    (_, _, height_m), turn = physics.bullet.getBasePositionAndOrientation(rover.body)
    assert 0.25 < height_m < 0.4
    assert abs(turn[0]) + abs(turn[1]) < 0.1
    physics.close()


def test_a_drone_flies_in_the_house_is_seen_by_lidar_and_its_touch_counts() -> None:
    drone = RobotStart("drone-1", (1.5, 2.0), 0.0)
    physics = Physics(make_small_home(), [RobotStart("dog-1", (2.5, 2.0), pi)], drones=[drone])
    asked: list[float] = []
    physics.each_step.append(asked.append)
    vehicle = physics.drones["drone-1"]
    physics.advance(240)
    assert asked == pytest.approx([k / 240.0 for k in range(240)])
    assert any(abs(box.centre_m[0] - 1.5) < 0.05 for box in physics.moving("dog-1"))
    low = physics.cast("dog-1", [(2.1, 2.0, 0.08)], [(1.0, 2.0, 0.08)])
    assert low[0] == pytest.approx((2.1 - 1.7) / 1.1, abs=0.02), "it stands in the way of a ray"
    vehicle.arm()
    vehicle.command(Trajectory((2.0, 1.5, -1.2)))
    physics.advance(6 * 240)
    assert vehicle.true_pose()[0] == pytest.approx((1.5, 2.0, 1.2), abs=0.1)
    assert physics.collisions == 0
    vehicle.disarm()
    physics.advance(240)
    vehicle.arm()
    vehicle.command(Trajectory((2.0, 2.5, -0.3)))
    physics.advance(4 * 240)
    assert physics.collisions >= 1
    physics.close()
