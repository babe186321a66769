"""A way through the building for a drone: level at one height through its doors, up or down at its ends.

A* over the squares of the airspace (Hart, Nilsson and Raphael 1968), pulled straight where that brings it no nearer to
a wall.
"""

from collections.abc import Generator, Iterator
from heapq import heappop, heappush
from math import ceil, dist, hypot, inf, sqrt
from typing import TypeVar

from devices.drone.airspace import CELL_M, LEAST_HEIGHT_M, NEEDED_M, WANTED_M, Airspace, Cell
from wire.model import Vec2, Vec3

Point = TypeVar("Point", Vec2, Vec3)

NEAR_WALL_PRICE = 2.0
"""So many times as dear is a step at the least distance from a wall."""
START_FREE_M = 0.5
"""What stands around the start does not block the way out of it: the drone is there already."""
SAME_M = 0.05
"""Corners nearer to each other than this are one."""
CELLS_A_STEP = 1500
"""Some 15 ms of work."""
Seeking = Generator[None, None, list[Point] | None]
_STEPS = tuple((i, j, hypot(i, j)) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j)


def find_way(
    space: Airspace, start_m: Vec3, goal_m: Vec3, travel_m: float, level_m: float | None = None
) -> Seeking[Vec3]:
    """Corner points from start to goal, both included; None when there is no way. Yields now and then: a large building
    takes seconds.

    At the level that it has been given, if any, else at the goal's height, where that is possible all the way; otherwise
    at `travel_m`, otherwise below every lintel.
    """
    lintels = [space.top_m(middle_m(door.start_m, door.end_m)) for door in space.doors]
    given = [level_m] if level_m is not None else []
    for height_m in dict.fromkeys([*given, goal_m[2], travel_m, *sorted(lintels)[:1]]):
        level = (yield from _level_way(space, start_m, goal_m, height_m)) if height_m >= LEAST_HEIGHT_M else None
        if level is not None:
            corners = [(x, y, height_m) for x, y in level]
            return _without_repeats([start_m, *corners, goal_m])
    return None


def middle_m(a_m: Vec2, b_m: Vec2) -> Vec2:
    return ((a_m[0] + b_m[0]) / 2.0, (a_m[1] + b_m[1]) / 2.0)


def nearest_open(space: Airspace, point_m: Vec3, within_m: float) -> Vec3 | None:
    """The place nearest to a point at its height where a drone may be, a little off the walls where there is room."""
    height_m, open_cells = point_m[2], space.open_cells(point_m[2])
    reach = ceil(within_m / CELL_M)
    x, y = space.cell(point_m)
    best: tuple[float, Vec2] | None = None
    for cell in ((x + i, y + j) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1)):
        if cell not in open_cells:
            continue
        centre = space.centre_m(cell)
        price = dist(centre, point_m[:2]) + 0.5 * (WANTED_M - min(WANTED_M, space.wall_m(cell)))
        if dist(centre, point_m[:2]) <= within_m and (best is None or (price, centre) < best):
            best = (price, centre)
    return (*best[1], height_m) if best is not None else None


def _level_way(space: Airspace, start_m: Vec3, goal_m: Vec3, height_m: float) -> Seeking[Vec2]:
    open_cells = space.open_cells(height_m, start_m)
    begin, end = space.cell(start_m), space.cell(goal_m)
    if end not in open_cells or height_m > space.top_m(start_m):
        return None
    came: dict[Cell, Cell] = {begin: begin}
    price: dict[Cell, float] = {begin: 0.0}
    todo: list[tuple[float, Cell]] = [(0.0, begin)]
    done: set[Cell] = set()
    if _is_clear(space, start_m[:2], goal_m[:2], WANTED_M, open_cells):
        return [start_m[:2], goal_m[:2]]
    open_cells |= _around(space, begin)
    while todo:
        _, here = heappop(todo)
        if here == end:
            return _pull(space, _back(came, end), start_m[:2], goal_m[:2], open_cells)
        if here in done:
            continue
        done.add(here)
        if len(done) % CELLS_A_STEP == 0:
            yield
        for i, j, step in _STEPS:
            cell = (here[0] + i, here[1] + j)
            if cell in done or cell not in open_cells:
                continue
            room = max(0.0, min(1.0, (space.wall_m(cell) - NEEDED_M) / (WANTED_M - NEEDED_M)))
            cost = price[here] + step * (1.0 + (NEAR_WALL_PRICE - 1.0) * (1.0 - room))
            if cost < price.get(cell, inf):
                price[cell], came[cell] = cost, here
                heappush(todo, (cost + hypot(end[0] - cell[0], end[1] - cell[1]), cell))
    return None


def _back(came: dict[Cell, Cell], end: Cell) -> list[Cell]:
    cells = [end]
    while came[cells[-1]] != cells[-1]:
        cells.append(came[cells[-1]])
    return cells[::-1]


def _around(space: Airspace, begin: Cell) -> set[Cell]:
    reach = range(-ceil(START_FREE_M / CELL_M), ceil(START_FREE_M / CELL_M) + 1)
    near = {(begin[0] + i, begin[1] + j) for i in reach for j in reach if hypot(i, j) * CELL_M < START_FREE_M}
    return {cell for cell in near if space.wall_m(cell) > 0.0}


def _pull(space: Airspace, cells: list[Cell], start_m: Vec2, goal_m: Vec2, open_cells: set[Cell]) -> list[Vec2]:
    """Leave out every corner without which the way comes no nearer to walls and nothing high."""
    points = [start_m, *(space.centre_m(cell) for cell in cells[1:-1]), goal_m]
    rooms = [space.wall_m(cell) for cell in cells]
    rooms += [rooms[-1]] * (len(points) - len(rooms))
    kept, at = [points[0]], 0
    while at < len(points) - 1:
        to = len(points) - 1
        while to > at + 1 and not _is_clear(space, points[at], points[to], min(rooms[at : to + 1]), open_cells):
            to -= 1
        at = to
        kept.append(points[at])
    return kept


def _is_clear(space: Airspace, a_m: Vec2, b_m: Vec2, room_m: float, open_cells: set[Cell]) -> bool:
    cells = (space.cell(point) for point in _between(a_m, b_m))
    return all(cell in open_cells and space.wall_m(cell) >= room_m - 1e-9 for cell in cells)


def _between(a_m: Vec2, b_m: Vec2) -> Iterator[Vec2]:
    dx, dy = b_m[0] - a_m[0], b_m[1] - a_m[1]
    count = max(1, ceil(2.0 * sqrt(dx * dx + dy * dy) / CELL_M))
    return ((a_m[0] + k / count * dx, a_m[1] + k / count * dy) for k in range(count + 1))


def _without_repeats(points_m: list[Vec3]) -> list[Vec3]:
    kept = [points_m[0]]
    for point in points_m[1:]:
        if dist(point, kept[-1]) > SAME_M:
            kept.append(point)
    if kept[-1] != points_m[-1]:
        kept[-1:] = [points_m[-1]] if len(kept) > 1 else [kept[0], points_m[-1]]
    return kept
