"""Robots through doors: nobody collides, all arrive."""

import random
from math import hypot

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hub.floor import FloorPlan
from hub.movers import Mover
from hub.parking import Parking
from hub.traffic import Traffic
from tests.hub.scenes import flat
from tests.hub.toys import STEP_M, way
from wire.model import Vec2
from wire.outline import inside

RADIUS_M = 0.38


class _Walker:
    """A robot that does what the orders say, exactly."""

    def __init__(self, id: str, at: Vec2, goal: Vec2) -> None:
        self.id, self.xy, self.goal = id, at, goal
        self.path = way(flat(), at, goal)
        self.aside: Vec2 | None = None

    def move(self, go: bool, aside: Vec2 | None) -> None:
        if aside is None and self.aside is not None:
            self.path = [] if self.arrived else way(flat(), self.xy, self.goal)
        self.aside = aside
        path = [aside] if aside is not None else self.path
        if not go or not path:
            return
        gap = hypot(path[0][0] - self.xy[0], path[0][1] - self.xy[1])
        if gap <= STEP_M:
            self.xy = path[0]
            if aside is None:
                path.pop(0)
        else:
            share = STEP_M / gap
            self.xy = (self.xy[0] + share * (path[0][0] - self.xy[0]), self.xy[1] + share * (path[0][1] - self.xy[1]))

    arrived = False


def _play(walkers: list[_Walker], steps: int = 4000, full_to_m: float = 0.0) -> tuple[float, int]:
    """(least gap between two bodies, steps until all have arrived once). West of `full_to_m` is no place to stand."""
    traffic = Traffic(FloorPlan(flat()), lambda point, radius: point[0] < full_to_m)
    least = 9.0
    rulings = {}
    for step in range(steps):
        if step % 4 == 0:
            movers = [Mover(w.id, w.xy, tuple([w.aside] if w.aside else w.path), RADIUS_M) for w in walkers]
            rulings = traffic.rule(movers, step * 0.05)
        for walker in walkers:
            ruling = rulings[walker.id]
            walker.move(ruling.go, ruling.step_aside_m)
            walker.arrived = walker.arrived or (walker.aside is None and not walker.path)
        for i, a in enumerate(walkers):
            for b in walkers[:i]:
                least = min(least, hypot(a.xy[0] - b.xy[0], a.xy[1] - b.xy[1]) - 2 * RADIUS_M)
        if all(w.arrived for w in walkers):
            return least, step
    return least, steps


def test_two_head_on_through_one_door() -> None:
    walkers = [_Walker("a", (2.0, 2.0), (6.0, 2.0)), _Walker("b", (6.0, 2.0), (2.0, 2.0))]
    least, steps = _play(walkers)
    assert least > 0.0
    assert steps < 1500


def test_an_idle_robot_in_a_door_steps_aside() -> None:
    walkers = [_Walker("a", (2.0, 2.0), (6.0, 2.0)), _Walker("b", (4.3, 2.0), (4.3, 2.0))]
    walkers[1].path, walkers[1].arrived = [], True
    least, steps = _play(walkers)
    assert least > 0.0
    assert steps < 1200


def test_an_idle_robot_leaves_a_full_room() -> None:
    walkers = [_Walker("a", (0.6, 2.2), (3.4, 2.2)), _Walker("b", (2.6, 1.9), (2.6, 1.9))]
    walkers[1].path, walkers[1].arrived = [], True
    least, steps = _play(walkers, full_to_m=4.0)
    assert least > 0.0
    assert steps < 1200
    assert walkers[1].xy[0] > 4.0


def spread(rng: random.Random, count: int) -> list[Vec2]:
    spots: list[Vec2] = []
    while len(spots) < count:
        spot = (rng.uniform(0.6, 11.4), rng.uniform(0.6, 3.4))
        if min(abs(spot[0] - 4.0), abs(spot[0] - 8.0)) < 1.0:
            continue
        if all(hypot(spot[0] - s[0], spot[1] - s[1]) > 1.1 for s in spots):
            spots.append(spot)
    return spots


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6])
def test_teams_through_doors(count: int) -> None:
    for seed in range(8):
        rng = random.Random(100 * count + seed)
        starts, goals = spread(rng, count), spread(rng, count)
        walkers = [_Walker(f"dog-{i}", starts[i], goals[i]) for i in range(count)]
        least, steps = _play(walkers)
        assert least > 0.0, (seed, least)
        assert steps < 4000, (seed, [(w.id, w.xy, w.path, w.aside) for w in walkers])


@given(seed=st.integers(0, 100_000), count=st.integers(2, 4))
@settings(max_examples=15, deadline=None)
def test_random_teams(seed: int, count: int) -> None:
    rng = random.Random(seed)
    starts, goals = spread(rng, count), spread(rng, count)
    least, steps = _play([_Walker(f"dog-{i}", starts[i], goals[i]) for i in range(count)])
    assert least > 0.0
    assert steps < 4000


@given(x=st.floats(0.5, 11.5), y=st.floats(0.5, 3.5))
@settings(max_examples=60, deadline=None)
def test_robots_step_aside_within_the_building(x: float, y: float) -> None:
    plan = FloorPlan(flat())
    mover, first = Mover("dog-1", (x, y), ()), Mover("dog-2", (6.0, 2.0), ((x, y),))
    spot = Parking(plan, lambda point, radius: False).find(mover, [(first, first.way)], [first])
    assert spot is None or any(inside(spot, polygon) for polygon in plan.polygons.values())


def test_a_robot_in_a_full_room_steps_aside_into_the_next() -> None:
    traffic = Traffic(FloorPlan(flat()), lambda point, radius: point[0] < 4.0)
    idle, first = Mover("dog-1", (2.0, 1.6), ()), Mover("dog-2", (0.6, 0.6), ((3.4, 2.6),))
    ruling = traffic.rule([idle, first], 0.0)["dog-1"]
    assert ruling.step_aside_m is not None
    assert ruling.step_aside_m[0] > 4.0


def test_a_queue_that_moves_on_is_no_knot() -> None:
    traffic = Traffic(FloorPlan(flat()), lambda point, radius: False)
    for look in range(55):
        front = Mover("dog-1", (1.6 + 0.01 * look, 2.0), ((7.0, 2.0),))
        back = Mover("dog-2", (0.6, 2.0), ((7.0, 2.0),))
        ruling = traffic.rule([front, back], 0.2 * look)["dog-1"]
        assert ruling.go, ruling
        assert ruling.step_aside_m is None, ruling
