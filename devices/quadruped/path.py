"""Ways over the floor map: A* with a price for nearness to obstacles, pulled straight into a few legs."""

from array import array
from collections.abc import Mapping
from heapq import heappop, heappush
from itertools import pairwise
from math import dist, hypot, inf

from devices.quadruped.grid import CELL_M, Cell, Grid, Mask
from devices.quadruped.map import REACH_M, FloorMap
from wire.model import Vec2

NEEDED_M = 0.42 - 1e-6
"""Clearance of a place where the robot can stand and turn: its radius and some noise; grids are of single precision."""
WANTED_M = 0.75
NEARNESS_PRICE = 3.0
CHEAP = 2.0
"""Pulling straight may lead through places up to this price even where the winding way was cheaper."""
PATIENCE = 8
"""So many cells further without a straight line, and no further one is tried."""
ESCAPE_M, ESCAPE_PRICE, ESCAPE_NEEDED_M = 0.6, 10.0, 0.2
"""A robot that stands too near to something may leave, at a price, through what is not the obstacle itself."""


def prices(floor: FloorMap, start_m: Vec2, others_m: tuple[Vec2, ...] = (), other_radius_m: float = 0.4) -> Grid:
    """What a metre through each cell costs; infinite where the robot does not fit."""
    clearance = floor.clearance_m
    if others_m:
        clearance = array("f", clearance)
        for other_m in others_m:
            for cell, away_m in floor.around(other_m, other_radius_m + REACH_M):
                clearance[cell] = min(clearance[cell], max(away_m - other_radius_m, 0.0))
    price = array("f", map(_price, clearance))
    if clearance[floor.cell(start_m)] < NEEDED_M:
        for cell, away_m in floor.around(start_m, ESCAPE_M):
            if away_m < ESCAPE_M and ESCAPE_NEEDED_M <= clearance[cell] < NEEDED_M:
                price[cell] = ESCAPE_PRICE
    return price


def _price(gap_m: float) -> float:
    if gap_m >= WANTED_M:
        return 1.0
    return 1.0 + NEARNESS_PRICE * (WANTED_M - gap_m) / (WANTED_M - NEEDED_M) if gap_m >= NEEDED_M else inf


def reachable(floor: FloorMap, price: Grid, start_m: Vec2) -> Mask:
    """Cells to which any way leads at these prices."""
    first = floor.cell(start_m)
    reached = bytearray(floor.size)
    reached[first] = 1
    frontier = [first]
    steps = _steps(floor)
    while frontier:
        here = frontier.pop()
        column = here % floor.columns
        for step, right, _ in steps:
            there = here + step
            if not (0 <= there < floor.size and 0 <= column + right < floor.columns):
                continue
            if not reached[there] and price[there] < inf:
                reached[there] = 1
                frontier.append(there)
    return reached


def search(floor: FloorMap, price: Grid, start_m: Vec2, goals: Mapping[Cell, float]) -> list[Vec2] | None:
    """The cheapest way to any of the goals, each with a price of its own; cell centres, or None without a way."""
    if not goals:
        return None
    estimate, cost = _estimates(floor, goals), price.tolist()
    begin = floor.cell(start_m)
    paid = {begin: 0.0}
    came: dict[int, int] = {}
    heap: list[tuple[float, float, int]] = [(estimate[begin], 0.0, begin)]
    sink, size, columns, steps = -1, floor.size, floor.columns, _steps(floor)
    while heap:
        _, so_far, here = heappop(heap)
        if here == sink:
            return _trace(floor, came, came[sink])
        if so_far > paid[here]:
            continue
        if here in goals and so_far + goals[here] < paid.get(sink, inf):
            paid[sink], came[sink] = so_far + goals[here], here
            heappush(heap, (paid[sink], paid[sink], sink))
        column = here % columns
        for step, right, length_m in steps:
            there = here + step
            if not (0 <= there < size and 0 <= column + right < columns):
                continue
            total = so_far + cost[there] * length_m
            if total < paid.get(there, inf):
                paid[there], came[there] = total, here
                heappush(heap, (total + estimate[there], total, there))
    return None


def pull(floor: FloorMap, price: Grid, way_m: list[Vec2]) -> list[Vec2]:
    """The same way in few straight legs that keep about as much clearance, without the first point."""
    legs: list[Vec2] = []
    here = 0
    while here < len(way_m) - 1:
        there = here + 1
        dearest = price[floor.cell(way_m[there])]
        for further in range(here + 2, len(way_m)):
            dearest = max(dearest, price[floor.cell(way_m[further])])
            most = max(dearest, CHEAP) + 1e-6
            if all(price[cell] <= most for cell in floor.along(way_m[here], way_m[further])):
                there = further
            elif further - there > PATIENCE:
                break
        legs.append(way_m[there])
        here = there
    return legs


def length_m(points_m: list[Vec2]) -> float:
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points_m))


def _steps(floor: FloorMap) -> list[tuple[int, int, float]]:
    """To the eight cells around one: what to add to its number, of that how many columns, and how far it is."""
    around = [(down, right) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right]
    return [(down * floor.columns + right, right, CELL_M * hypot(down, right)) for down, right in around]


def _estimates(floor: FloorMap, goals: Mapping[Cell, float]) -> list[float]:
    """Never more than the true price of the rest: straight to the goals' bounding circle."""
    points = [floor.centre_m(cell) for cell in goals]
    middle = (sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points))
    radius_m = max(dist(point, middle) for point in points)
    cheapest = min(goals.values())
    return [max(away_m - radius_m, 0.0) + cheapest for away_m in floor.distance_m(middle)]


def _trace(floor: FloorMap, came: dict[int, int], end: int) -> list[Vec2]:
    way = [end]
    while way[-1] in came:
        way.append(came[way[-1]])
    return [floor.centre_m(cell) for cell in reversed(way)]
