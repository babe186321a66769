"""Ways over the floor map: A* with a price for nearness to obstacles, pulled straight into a few legs."""

from collections.abc import Mapping
from heapq import heappop, heappush
from itertools import pairwise
from math import hypot

import numpy as np

from devices.quadruped.map import CELL_M, Cell, FloorMap, Grid, Mask
from wire.model import Vec2

NEEDED_M = 0.42
"""Clearance of a place where the robot can stand and turn: its radius and some noise."""
WANTED_M = 0.75
NEARNESS_PRICE = 3.0
CHEAP = 2.0
"""Pulling straight may lead through places up to this price even where the winding way was cheaper."""
PATIENCE = 8
"""So many cells further without a straight line, and no further one is tried."""
ESCAPE_M, ESCAPE_PRICE, ESCAPE_NEEDED_M = 0.6, 10.0, 0.2
"""A robot that stands too near to something may leave, at a price, through what is not the obstacle itself."""
_STEPS = tuple((r, c, CELL_M * hypot(r, c)) for r in (-1, 0, 1) for c in (-1, 0, 1) if r or c)


def prices(floor: FloorMap, start_m: Vec2, others_m: tuple[Vec2, ...] = (), other_radius_m: float = 0.4) -> Grid:
    """What a metre through each cell costs; infinite where the robot does not fit."""
    clearance = floor.clearance_m
    for other_m in others_m:
        clearance = np.minimum(clearance, np.maximum(floor.distance_m(other_m) - other_radius_m, 0.0))
    price = 1.0 + NEARNESS_PRICE * np.clip((WANTED_M - clearance) / (WANTED_M - NEEDED_M), 0.0, 1.0)
    start = floor.cell(start_m)
    stands_tight = clearance[start.row, start.column] < NEEDED_M
    escape = (floor.distance_m(start_m) < ESCAPE_M) & (clearance >= ESCAPE_NEEDED_M) & stands_tight
    tight = np.where(escape, ESCAPE_PRICE, np.inf)
    result: Grid = np.where(clearance >= NEEDED_M, price, tight).astype(np.float32)
    return result


def reachable(floor: FloorMap, price: Grid, start_m: Vec2) -> Mask:
    """Cells to which any way leads at these prices."""
    fits, first = np.isfinite(price), floor.cell(start_m)
    fits[first.row, first.column] = True
    wide = np.zeros((floor.rows + 2, floor.columns + 2), np.bool_)
    reached = wide[1:-1, 1:-1]
    reached[first.row, first.column] = True
    count = 0
    while count != (count := int(reached.sum())):
        wide[1:-1] |= wide[:-2] | wide[2:]
        wide[:, 1:-1] |= wide[:, :-2] | wide[:, 2:]
        reached &= fits
        wide[0] = wide[-1] = wide[:, 0] = wide[:, -1] = False
    return reached


def search(floor: FloorMap, price: Grid, start_m: Vec2, goals: Mapping[Cell, float]) -> list[Vec2] | None:
    """The cheapest way to any of the goals, each with a price of its own; cell centres, or None without a way."""
    if not goals:
        return None
    columns = floor.columns
    ends = {cell.row * columns + cell.column: extra for cell, extra in goals.items()}
    estimate = _estimates(floor, goals)
    cost = price.ravel().tolist()
    first = floor.cell(start_m)
    begin = first.row * columns + first.column
    paid = {begin: 0.0}
    came: dict[int, int] = {}
    heap: list[tuple[float, float, int]] = [(estimate[begin], 0.0, begin)]
    sink, size = -1, len(cost)
    while heap:
        _, so_far, here = heappop(heap)
        if here == sink:
            return _trace(floor, came, came[sink])
        if so_far > paid[here]:
            continue
        if here in ends and so_far + ends[here] < paid.get(sink, np.inf):
            paid[sink], came[sink] = so_far + ends[here], here
            heappush(heap, (paid[sink], paid[sink], sink))
        column = here % columns
        for down, right, length_m in _STEPS:
            there = here + down * columns + right
            if not (0 <= there < size and 0 <= column + right < columns):
                continue
            total = so_far + cost[there] * length_m
            if total < paid.get(there, np.inf):
                paid[there], came[there] = total, here
                heappush(heap, (total + estimate[there], total, there))
    return None


def pull(floor: FloorMap, price: Grid, way_m: list[Vec2]) -> list[Vec2]:
    """The same way in few straight legs that keep about as much clearance, without the first point."""
    legs: list[Vec2] = []
    here = 0
    while here < len(way_m) - 1:
        there = here + 1
        dearest = float(price[_at(floor, way_m[there])])
        for further in range(here + 2, len(way_m)):
            dearest = max(dearest, float(price[_at(floor, way_m[further])]))
            if float(floor.along(price, way_m[here], way_m[further]).max()) <= max(dearest, CHEAP) + 1e-6:
                there = further
            elif further - there > PATIENCE:
                break
        legs.append(way_m[there])
        here = there
    return legs


def length_m(points_m: list[Vec2]) -> float:
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points_m))


def _at(floor: FloorMap, point_m: Vec2) -> tuple[int, int]:
    cell = floor.cell(point_m)
    return (cell.row, cell.column)


def _estimates(floor: FloorMap, goals: Mapping[Cell, float]) -> list[float]:
    """Never more than the true price of the rest: straight to the goals' bounding circle."""
    points = np.array([floor.centre_m(cell) for cell in goals])
    middle = points.mean(axis=0)
    radius = float(np.hypot(*(points - middle).T).max())
    cheapest = min(goals.values())
    rest = np.maximum(floor.distance_m((float(middle[0]), float(middle[1]))) - radius, 0.0) + cheapest
    estimates: list[float] = rest.ravel().tolist()
    return estimates


def _trace(floor: FloorMap, came: dict[int, int], end: int) -> list[Vec2]:
    way = [end]
    while way[-1] in came:
        way.append(came[way[-1]])
    return [floor.centre_m(Cell(*divmod(index, floor.columns))) for index in reversed(way)]
