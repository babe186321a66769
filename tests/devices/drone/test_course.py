"""A curve in time: within its limits, from standstill to standstill, velocity the derivative of position."""

from itertools import pairwise
from math import dist, hypot

from hypothesis import given
from hypothesis import strategies as st

from devices.drone.course import ACCEL_MPS2, CLIMB_MPS, CRUISE_MPS, LEG_M, Course, Limits, along_legs
from devices.drone.follow import LATE_M, Follower
from devices.drone.spline import through

coordinate = st.floats(-8.0, 8.0)
corners = st.lists(st.tuples(coordinate, coordinate, st.floats(0.5, 3.0)), min_size=2, max_size=5)
STEP_S = 0.05


def times(course: Course) -> list[float]:
    return [i * STEP_S for i in range(int(course.duration_s / STEP_S) + 2)]


@given(corners)
def test_it_goes_from_standstill_to_standstill_within_its_limits(points):
    course = Course(along_legs(points))
    assert course.at(0.0) == (course.points_m[0], (0.0, 0.0, 0.0))
    assert course.at(course.duration_s) == (course.end_m, (0.0, 0.0, 0.0))
    assert dist(course.end_m, points[-1]) < 1e-9
    speeds = []
    for time_s in times(course):
        _, velocity = course.at(time_s)
        speeds.append(hypot(*velocity))
        assert speeds[-1] <= CRUISE_MPS + 1e-6
        assert abs(velocity[2]) <= CLIMB_MPS + 0.1
    assert all(abs(b - a) <= ACCEL_MPS2 * STEP_S * 1.05 + 1e-6 for a, b in pairwise(speeds))


@given(corners)
def test_its_velocity_moves_it(points):
    course = Course(along_legs(points))
    at = course.points_m[0]
    for time_s in times(course)[:-1]:
        velocity = course.at(time_s + STEP_S / 2.0)[1]
        at = tuple(a + v * STEP_S for a, v in zip(at, velocity, strict=True))
    assert dist(at, course.end_m) < 0.05 + 0.02 * course.length_m


@given(corners)
def test_rounded_corners_stay_near_their_legs(points):
    course = Course(along_legs(points))
    for place in course.points_m[::5]:
        assert min(to_leg_m(place, a, b) for a, b in pairwise(points)) <= LEG_M / 2.0


def to_leg_m(p, a, b):
    along = [y - x for x, y in zip(a, b, strict=True)]
    length2 = sum(v * v for v in along)
    share = 0.0 if length2 == 0.0 else sum((y - x) * v for x, y, v in zip(a, p, along, strict=True)) / length2
    share = max(0.0, min(1.0, share))
    return dist(p, [x + share * v for x, v in zip(a, along, strict=True)])


def test_bends_are_flown_slower():
    bend = Course(through([(0.0, 0.0, 1.0), (1.0, 1.0, 1.0), (2.0, 0.0, 1.0), (3.0, 1.0, 1.0)]), Limits(speed_mps=3.0))
    straight = Course(along_legs([(0.0, 0.0, 1.0), (bend.length_m, 0.0, 1.0)]), Limits(speed_mps=3.0))
    assert bend.duration_s > 1.2 * straight.duration_s


def test_a_follower_waits_and_goes_on():
    follower = Follower(Course(along_legs([(0.0, 0.0, 1.0), (5.0, 0.0, 1.0)])), 0.0)
    here, now_s = (0.0, 0.0, 1.0), 0.0

    def fly(seconds, go):
        nonlocal here, now_s
        for _ in range(round(seconds / STEP_S)):
            now_s += STEP_S
            here, velocity = follower.step(now_s, here, go)
        return velocity

    assert fly(3.0, True)[0] > 0.9
    expected = follower.stop_m
    assert fly(3.0, False) == (0.0, 0.0, 0.0)
    assert dist(here, expected) < 0.05, "it stood where it had said that it would"
    assert fly(10.0, True) == (0.0, 0.0, 0.0)
    assert follower.arrived(here)


def test_a_follower_does_not_run_away_from_a_drone_that_is_held_fast():
    follower = Follower(Course(along_legs([(0.0, 0.0, 1.0), (8.0, 0.0, 1.0)])), 0.0)
    for step in range(1, 400):
        asked, _ = follower.step(step * STEP_S, (0.0, 0.0, 1.0), True)
    assert dist(asked, (0.0, 0.0, 1.0)) < LATE_M + 0.6
    assert follower.late_s > 5.0
    assert not follower.arrived((0.0, 0.0, 1.0))
