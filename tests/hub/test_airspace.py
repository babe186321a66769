"""Drones in three rooms: nobody meets or is flown into from above or below, all arrive; and what floor and air have to
do with each other."""

import random
from itertools import pairwise
from math import dist

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hub.airspace import SEPARATION_M, AirRuling, Airspace, Flyer, levels
from hub.floor import FloorPlan
from hub.movers import Mover
from tests.hub.scenes import flat
from tests.hub.test_traffic import spread
from tests.hub.toys import STEP_M, way
from wire.model import Vec2, Vec3

LEVELS_M = (1.5, 2.1)
BODY_M, BODY_HEIGHT_M = 0.6, 0.3
"""Two bodies touch when their middles are nearer than this beside and above each other."""
DOOR_HEIGHT_M = 1.6


def free(point_m: Vec2, radius_m: float) -> bool:
    return False


def airspace(levels_m: tuple[float, ...] = LEVELS_M) -> Airspace:
    return Airspace(FloorPlan(flat()), levels_m, free, free)


class Drone:
    """Flies exactly as it is told: up or down to its level, along its way, up or down at the end."""

    def __init__(self, id: str, at: Vec2, goal: Vec3) -> None:
        self.id, self.at, self.goal = id, (*at, 1.5), goal
        self.level, self.aside, self.arrived = 1.5, None, False
        self.path: list[Vec3] = []
        self.begun = False

    def plan(self) -> None:
        flat_way = way(flat(), self.at[:2], self.goal[:2])
        level = min(self.level, DOOR_HEIGHT_M) if len(flat_way) > 1 else self.level
        self.path = [(*self.at[:2], level), *((x, y, level) for x, y in flat_way), self.goal]
        self.begun = True

    def obey(self, order: AirRuling) -> None:
        self.level = order.height_m or 1.5
        aside = order.ruling.step_aside_m
        if not self.begun or (aside is None and self.aside is not None):
            self.plan()
            self.path = [] if self.arrived else self.path
        self.aside = aside

    def move(self, go: bool) -> None:
        path = [(*self.aside, self.at[2])] if self.aside is not None else self.path
        if not go or not path:
            return
        gap = dist(path[0], self.at)
        if gap <= STEP_M:
            self.at = path[0]
            if self.aside is None:
                path.pop(0)
        else:
            self.at = tuple(a + STEP_M / gap * (b - a) for a, b in zip(self.at, path[0], strict=True))
        self.arrived = self.arrived or (self.aside is None and not self.path)

    @property
    def flyer(self) -> Flyer:
        path = [(*self.aside, self.at[2])] if self.aside is not None else self.path
        return Flyer(self.id, self.at, tuple(path), airborne=True, busy=not self.arrived)


def play(drones: list[Drone], space: Airspace, steps: int = 5000) -> tuple[float, int]:
    """(least gap between two bodies at one height, steps until all have arrived once)."""
    least, orders = 9.0, {}
    for step in range(steps):
        if step % 4 == 0:
            orders = space.rule([d.flyer for d in drones], [], step * 0.05)
            for drone in drones:
                drone.obey(orders[drone.id])
        for drone in drones:
            drone.move(orders[drone.id].ruling.go)
        for i, a in enumerate(drones):
            for b in drones[:i]:
                if abs(a.at[2] - b.at[2]) < BODY_HEIGHT_M:
                    least = min(least, dist(a.at[:2], b.at[:2]) - BODY_M)
        if all(d.arrived for d in drones):
            return least, step
    return least, steps


def team(rng: random.Random, count: int) -> list[Drone]:
    starts, goals = spread(rng, count), spread(rng, count)
    return [Drone(f"drone-{i}", starts[i], (*goals[i], rng.choice((1.5, 1.8, 2.1)))) for i in range(count)]


@pytest.mark.parametrize("count", [2, 3, 4])
@pytest.mark.parametrize("levels_m", [LEVELS_M, LEVELS_M[:1]], ids=["two levels", "one level"])
def test_teams_in_the_air(count: int, levels_m: tuple[float, ...]) -> None:
    for seed in range(6):
        drones = team(random.Random(100 * count + seed), count)
        least, steps = play(drones, airspace(levels_m))
        assert least > 0.0, (seed, least)
        assert steps < 5000, (seed, [(d.id, d.at, d.path, d.aside) for d in drones])


@given(seed=st.integers(0, 100_000), count=st.integers(2, 3), one=st.booleans())
@settings(max_examples=25, deadline=None)
def test_any_team_in_the_air(seed: int, count: int, one: bool) -> None:
    least, steps = play(team(random.Random(seed), count), airspace(LEVELS_M[:1] if one else LEVELS_M))
    assert least > 0.0
    assert steps < 5000


def up(id: str, at: Vec3, *path: Vec3, **more: object) -> Flyer:
    return Flyer(id, at, path, airborne=True, **more)


def down(id: str, at: Vec2, **more: object) -> Flyer:
    return Flyer(id, (*at, 0.0), (), airborne=False, **more)


def test_everybody_travels_at_a_level_of_its_own_and_one_alone_as_it_likes() -> None:
    space = airspace()
    assert space.rule([down("a", (1.0, 1.0))], [], 0.0)["a"].height_m is None
    orders = space.rule([down(id, (1.0 + x, 1.0)) for x, id in enumerate("abc")], [], 0.2)
    assert [orders[id].height_m for id in "abc"] == [1.5, 2.1, 1.5]
    orders = space.rule([down(id, (1.0, 1.0)) for id in "bcd"], [], 0.4)
    assert [orders[id].height_m for id in "bcd"] == [2.1, 1.5, 1.5]  # kept by those who stay


@pytest.mark.parametrize(
    ("ceiling_m", "wanted"), [(2.1, (1.5, 2.1)), (1.2, (1.5,)), (3.3, (1.5, 2.1, 2.7, 3.3)), (2.0, (1.5,))]
)
def test_levels_fit_under_the_ceiling(ceiling_m: float, wanted: tuple[float, ...]) -> None:
    found = levels(1.5, ceiling_m)
    assert found == wanted
    assert all(b - a > SEPARATION_M - 1e-6 for a, b in pairwise(found))


def test_ways_that_cross_at_two_levels_do_not_wait_for_each_other() -> None:
    east = up("a", (0.8, 2.0, 1.5), (3.2, 2.0, 1.5))
    north = up("b", (2.0, 0.8, 2.1), (2.0, 3.2, 2.1))
    orders = airspace().rule([east, north], [], 0.0)
    assert all(order.ruling.go for order in orders.values())
    level = up("b", (2.0, 0.9, 1.6), (2.0, 3.2, 1.6))
    close = up("a", (1.2, 2.0, 1.5), (3.2, 2.0, 1.5))
    orders = airspace().rule([close, level], [], 0.0)
    assert [orders[id].ruling.go for id in "ab"] == [True, False]


def test_a_door_lets_one_through_at_a_time_whatever_the_level() -> None:
    east = up("a", (3.2, 2.0, 1.5), (4.8, 2.0, 1.5))
    west = up("b", (4.9, 2.0, 2.1), (3.2, 2.0, 2.1))
    orders = airspace().rule([east, west], [], 0.0)
    assert sorted(order.ruling.go for order in orders.values()) == [False, True]


def test_who_hovers_over_one_that_wants_up_makes_room() -> None:
    climbing, idle = up("b", (2.0, 2.0, 1.5), (2.0, 2.0, 2.1), busy=True), up("a", (2.2, 2.0, 2.1))
    space = airspace()
    orders = space.rule([climbing, idle], [], 0.0)
    assert not orders["b"].ruling.go
    assert orders["b"].ruling.held_by == "a"
    spot = orders["a"].ruling.step_aside_m
    assert spot is not None
    assert dist(spot, (2.0, 2.0)) > BODY_M
    orders = space.rule([climbing, up("a", (*spot, 2.1))], [], 2.0)
    assert orders["b"].ruling.go


def test_of_two_that_would_change_places_one_makes_room() -> None:
    first, later = up("a", (2.0, 2.0, 1.5), (2.0, 2.0, 2.1)), up("b", (2.1, 2.0, 2.1), (2.1, 2.0, 1.5))
    orders = airspace().rule([first, later], [], 0.0)
    assert not orders["a"].ruling.go
    assert orders["b"].ruling.step_aside_m is not None


def test_a_drone_takes_off_into_nobody() -> None:
    below = down("a", (2.0, 2.0), busy=True)
    assert not airspace().rule([below, up("b", (6.0, 2.0, 1.5))], [], 0.0)["a"].column_taken
    passing = up("b", (1.0, 2.0, 1.5), (3.2, 2.0, 1.5))
    orders = airspace().rule([below, passing], [], 0.0)
    assert orders["a"].column_taken
    assert orders["b"].ruling.go
    orders = airspace().rule([below, up("b", (2.1, 2.1, 1.5))], [], 0.0)
    assert orders["a"].column_taken
    assert orders["b"].ruling.step_aside_m is not None


def test_a_drone_comes_down_on_nobody() -> None:
    over = up("a", (2.0, 2.0, 1.5), busy=True)
    clear = airspace().rule([over], [Mover("dog-1", (6.0, 2.0), ())], 0.0)["a"]
    assert (clear.column_taken, clear.land_at_m) == (False, None)
    passing = airspace().rule([over], [Mover("dog-1", (0.6, 2.0), ((3.4, 2.0),))], 0.0)["a"]
    assert (passing.column_taken, passing.land_at_m) == (True, None)  # it will be gone
    standing = airspace().rule([over], [Mover("dog-1", (2.1, 2.0), ())], 0.0)["a"]
    assert standing.column_taken
    assert standing.land_at_m is not None
    assert dist(standing.land_at_m, (2.1, 2.0)) > 0.38 + 0.3


def test_nobody_lands_in_a_door_or_on_furniture_but_where_it_stood() -> None:
    table = Airspace(FloorPlan(flat()), LEVELS_M, free, lambda point, radius: dist(point, (2.0, 2.0)) < 0.8)
    order = table.rule([up("a", (2.0, 2.0, 1.5))], [], 0.0)["a"]
    assert order.column_taken
    assert order.land_at_m is not None
    assert dist(order.land_at_m, (2.0, 2.0)) >= 0.8
    in_door = airspace().rule([up("a", (4.2, 2.0, 1.5))], [], 0.0)["a"]
    assert in_door.column_taken
    home = airspace().rule([up("a", (4.2, 2.0, 1.5), home_m=(4.2, 2.1))], [], 0.0)["a"]
    assert not home.column_taken


def test_the_same_looks_give_the_same_orders() -> None:
    def looks() -> list[dict[str, AirRuling]]:
        space, drones = airspace(), team(random.Random(5), 4)
        return [space.rule([d.flyer for d in drones], [], 0.2 * k) for k in range(20)]

    assert looks() == looks()


def resting_team(seed: int) -> list[Drone]:
    """Four of them, of whom some want nothing from the start."""
    rng = random.Random(seed)
    drones = team(rng, 4)
    for drone in drones:
        if rng.random() < 0.4:
            drone.goal, drone.arrived, drone.begun = drone.at, True, True
    return drones


@pytest.mark.parametrize("seed", [239, 314, 448, 769, *range(20)])
def test_those_who_want_nothing_make_room_for_those_who_have_nowhere_to_go(seed: int) -> None:
    """The first seeds once were knots: of one boxed in by idle ones, and of some sent past others to places they kept to."""
    for levels_m in (LEVELS_M, LEVELS_M[:1]):
        drones = resting_team(seed)
        least, steps = play(drones, airspace(levels_m), 3000)
        assert least > 0.0
        assert steps < 3000, [(d.id, d.at, d.path, d.aside) for d in drones]
