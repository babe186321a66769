"""The floor map, ways over it, and how much of a room has been seen."""

from itertools import pairwise
from math import cos, hypot, inf, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from devices.quadruped import path, places
from devices.quadruped.coverage import Coverage
from devices.quadruped.follow import Follower
from devices.quadruped.grid import Grid
from devices.quadruped.look import Look
from devices.quadruped.map import FloorMap, without_doors
from tests.devices.driver import two_rooms
from wire.messages.driver import LaserScan
from wire.site import Door, Wall

SITE = two_rooms()
Point = st.tuples(st.floats(0.5, 7.5), st.floats(0.5, 3.5))


def floor_with(*points_m: tuple[float, float]) -> FloorMap:
    floor = FloorMap(SITE)
    for _ in range(3):
        floor.mark(points_m, 1.0)
    return floor


def scan(x: float, y: float, *ranges_m: float) -> LaserScan:
    """Beams straight ahead (east) and around."""
    return LaserScan(
        robot="dog-1",
        seq=0,
        stamp_s=1.0,
        position_enu_m=(x, y, 0.25),
        yaw_rad=0.0,
        angle_min_rad=0.0,
        angle_step_rad=0.05,
        range_max_m=6.0,
        ranges_m=ranges_m,
    )


def test_clearance_is_the_distance_to_the_nearest_surface() -> None:
    floor = floor_with((2.0, 2.0))
    cell = floor.cell((1.45, 2.05))
    x, y = floor.centre_m(cell)
    assert floor.clearance_m[cell] == pytest.approx(hypot(x - 2.0, y - 2.0), abs=1e-3)
    beside_wall = floor.cell((3.55, 0.85))
    gap = 4.0 - 0.05 - floor.centre_m(beside_wall)[0]
    assert floor.walls_m[beside_wall] == pytest.approx(gap, abs=1e-3)


def test_what_a_standing_robot_sees_again_and_again_stays_known() -> None:
    floor, cell = FloorMap(SITE), FloorMap(SITE).cell((2.0, 2.0))
    for number in range(100):
        same = scan(1.0, 2.0, 1.0).model_copy(update={"seq": number, "stamp_s": 0.2 * number})
        floor.see(same)
    floor.forget(0.2 * 99 - 2.0)
    assert floor.clearance_m[cell] < 0.1
    for number in range(100, 113):
        gone = scan(1.0, 2.0, 3.0).model_copy(update={"seq": number, "stamp_s": 0.2 * number})
        floor.see(gone)
    assert floor.clearance_m[cell] > 0.5, "a beam that goes on further is news at once"


def test_a_wall_drawn_through_a_door_has_a_gap() -> None:
    wall = Wall(start_m=(0.0, 0.0), end_m=(0.0, 5.0))
    door = Door(id="d", rooms=("a", "b"), start_m=(0.0, 3.0), end_m=(0.0, 2.0))
    assert without_doors(wall, [door]) == [((0.0, 0.0), (0.0, 2.0)), ((0.0, 3.0), (0.0, 5.0))]
    beyond = Door(id="f", rooms=("a", "b"), start_m=(0.0, 6.0), end_m=(0.0, 7.0))
    assert without_doors(wall, [door, beyond]) == without_doors(wall, [door])
    elsewhere = Door(id="e", rooms=("a", "b"), start_m=(1.0, 3.0), end_m=(1.0, 2.0))
    assert without_doors(wall, [elsewhere]) == [((0.0, 0.0), (0.0, 5.0))]


def test_what_moves_away_is_forgotten() -> None:
    floor = FloorMap(SITE)
    for _ in range(4):
        floor.see(scan(1.0, 2.0, 1.0))
    assert floor.room_m((1.0, 2.0), (3.0, 2.0)) < 0.1
    for _ in range(12):
        floor.see(scan(1.0, 2.0, 2.95))
    assert floor.room_m((1.0, 2.0), (2.5, 2.0)) > 0.4


def test_walls_and_other_robots_are_no_furniture() -> None:
    floor = FloorMap(SITE)
    for _ in range(4):
        floor.see(scan(1.0, 3.5, 2.97))
        floor.see(scan(1.0, 2.0, 1.0), others_m=[(2.3, 2.0)])
    assert floor.room_m((1.0, 2.0), (3.0, 2.0)) == 1.0


def test_a_robot_seen_before_it_was_told_of_leaves_no_mark() -> None:
    floor = FloorMap(SITE)
    for _ in range(4):
        floor.see(scan(1.0, 2.0, 1.0))
    assert floor.room_m((1.0, 2.0), (3.0, 2.0)) < 0.1
    floor.see(scan(1.0, 2.0, 1.0), others_m=[(2.3, 2.0)])
    assert floor.room_m((1.0, 2.0), (3.0, 2.0)) == 1.0


def test_furniture_beside_another_robot_stays() -> None:
    floor = floor_with((2.0, 2.0))
    floor.see(scan(1.0, 3.0, 0.0), others_m=[(2.5, 2.0)])
    assert floor.room_m((1.0, 2.0), (3.0, 2.0)) < 0.1


def test_as_near_as_can_be_to_a_point_where_nothing_fits() -> None:
    floor = floor_with(*[(x, y) for x in np.arange(0.1, 2.6, 0.2) for y in np.arange(0.1, 4.0, 0.2)])
    cells = places.near_point(floor, (0.3, 2.0))
    assert cells
    assert min(floor.centre_m(cell)[0] for cell in cells) < 3.2


@settings(max_examples=60, deadline=None)
@given(start=Point, end=Point, things=st.lists(Point, max_size=6))
def test_a_way_keeps_its_distance_and_leads_to_the_goal(start: tuple, end: tuple, things: list) -> None:
    floor = floor_with(*things)
    price = path.prices(floor, start)
    way = path.search(floor, price, start, places.near_point(floor, end))
    if way is None:
        return
    legs = path.pull(floor, price, way)
    stands_tight = floor.clearance_m[floor.cell(start)] < path.NEEDED_M
    here = way[0]
    for corner in legs:
        gap_m = min(floor.clearance_m[cell] for cell in floor.along(here, corner))
        assert stands_tight or gap_m >= path.NEEDED_M
        assert floor.clear_of_walls(here, corner)
        here = corner
    assert path.length_m([way[0], *legs]) <= path.length_m(way) + 1e-6
    assert len(legs) <= len(way)
    assert not legs or legs[-1] == way[-1]


@settings(max_examples=25, deadline=None)
@given(start=Point, end=Point)
def test_a_way_is_the_cheapest_there_is(start: tuple, end: tuple) -> None:
    floor = floor_with((2.0, 2.6), (5.5, 1.2))
    price = path.prices(floor, start)
    goals = places.near_point(floor, end)
    way = path.search(floor, price, start, goals)
    cheapest = _dijkstra(floor, price, start)
    best = min(cheapest.get(divmod(c, floor.columns), inf) + extra for c, extra in goals.items())
    if way is None:
        assert best == inf
        return
    paid = sum(price[floor.cell(b)] * hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(way))
    assert paid + goals[floor.cell(way[-1])] == pytest.approx(best, rel=1e-3)


def _dijkstra(floor: FloorMap, price: Grid, start: tuple) -> dict:
    first = divmod(floor.cell(start), floor.columns)
    cost, frontier = {first: 0.0}, [first]
    while frontier:
        changed = []
        for row, column in frontier:
            for down, right in [(r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if r or c]:
                there = (row + down, column + right)
                if not (0 <= there[0] < floor.rows and 0 <= there[1] < floor.columns):
                    continue
                total = cost[row, column] + price[there[0] * floor.columns + there[1]] * 0.1 * hypot(down, right)
                if total < cost.get(there, inf) - 1e-9:
                    cost[there] = total
                    changed.append(there)
        frontier = changed
    return cost


@settings(max_examples=25, deadline=None)
@given(start=Point, things=st.lists(Point, max_size=6))
def test_reachable_is_what_a_way_leads_to(start: tuple, things: list) -> None:
    floor = floor_with(*things)
    price = path.prices(floor, start)
    reached = path.reachable(floor, price, start)
    for cell in [floor.cell((x, y)) for x in (1.0, 3.0, 5.0, 7.0) for y in (1.0, 3.0)]:
        assert bool(reached[cell]) == (path.search(floor, price, start, {cell: 0.0}) is not None)


def test_a_doorway_is_passed_straight() -> None:
    floor = FloorMap(SITE)
    price = path.prices(floor, (1.0, 3.0))
    way = path.search(floor, price, (1.0, 3.0), places.near_point(floor, (7.0, 3.0)))
    assert way is not None
    legs = path.pull(floor, price, way)
    assert len(legs) <= 4


def test_a_robot_in_the_door_closes_it() -> None:
    floor = FloorMap(SITE)
    price = path.prices(floor, (1.0, 2.0), others_m=((4.0, 2.0),))
    assert path.search(floor, price, (1.0, 2.0), places.near_point(floor, (7.0, 2.0))) is None


def test_places_beside_a_thing_are_in_its_room_and_in_reach() -> None:
    floor = FloorMap(SITE)
    cells = places.beside(floor, (4.3, 3.5), "Mug", SITE.room[1])
    assert cells
    for cell in cells:
        x, y = floor.centre_m(cell)
        assert x > 4.0
        assert hypot(x - 4.3, y - 3.5) <= 1.3


@settings(max_examples=40, deadline=None)
@given(start=Point, yaw=st.floats(-pi, pi), corners=st.lists(Point, min_size=1, max_size=4))
def test_the_follower_arrives(start: tuple, yaw: float, corners: list) -> None:
    follower = Follower(start, corners)
    x, y = start
    for _ in range(3000):
        forward, turn = follower.steer((x, y), yaw, 0.8)
        if follower.arrived:
            break
        assert 0.0 <= forward <= 0.8
        assert abs(turn) <= 1.5
        yaw += 0.05 * turn
        x, y = x + 0.05 * forward * np.cos(yaw), y + 0.05 * forward * np.sin(yaw)
    assert follower.arrived
    assert hypot(x - corners[-1][0], y - corners[-1][1]) < 0.35


def test_looking_covers_the_room_once() -> None:
    floor = FloorMap(SITE)
    coverage = Coverage(floor, SITE.room[0].polygon_m)
    assert coverage.left == 1.0
    surfaces = np.array([(x, y, 0.0) for x in np.arange(0.1, 4.0, 0.1) for y in np.arange(0.1, 2.0, 0.1)], np.float32)
    before = coverage.gain((2.0, 2.0), 0.0)
    coverage.take(Look(1.0, (2.0, 2.0), 0.0, 2.7 * pi, (), surfaces))
    assert 0.4 < coverage.left < 0.6
    assert coverage.gain((2.0, 2.0), 0.0) < before
    best = coverage.best_place((2.0, 1.0), [])
    assert best is not None
    assert best[1] > 0.3


def test_looks_only_from_where_it_can_get_to() -> None:
    floor = floor_with(*[(1.7, y) for y in np.arange(0.05, 4.0, 0.1)])
    coverage = Coverage(floor, SITE.room[0].polygon_m)
    best = coverage.best_place((0.9, 2.0), [])
    assert best is not None
    assert best[0][0] < 1.7
    everywhere = [(0.9, y) for y in np.arange(0.5, 4.0, 0.4)]
    assert coverage.best_place((0.9, 2.0), everywhere) is None


def test_the_other_room_is_not_seen_through_the_wall() -> None:
    floor = FloorMap(SITE)
    coverage = Coverage(floor, SITE.room[1].polygon_m)
    assert coverage.gain((3.0, 0.8), 0.0) < 0.12
    assert coverage.gain((6.0, 2.0), 0.0) > 0.8


@settings(max_examples=60, deadline=None)
@given(start=Point, yaw=st.floats(-pi, pi), things=st.lists(Point, min_size=1, max_size=8))
def test_beams_clear_the_cells_they_pass_and_no_others(start: tuple, yaw: float, things: list) -> None:
    floor = floor_with(*things)
    solid = [thing for thing in things if floor.room_m(thing, thing) == 0.0]
    beams = scan(*start, *[0.0] * 40).model_copy(update={"yaw_rad": yaw})
    for _ in range(12):
        floor.see(beams)
    passed = {
        floor.cell((start[0] + 0.1 * k * cos(yaw + 0.05 * beam), start[1] + 0.1 * k * sin(yaw + 0.05 * beam)))
        for beam in range(40)
        for k in range(59)
    }
    for thing in solid:
        assert (floor.room_m(thing, thing) == 0.0) == (floor.cell(thing) not in passed)
