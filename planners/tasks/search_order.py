"""In which order robots look through rooms: the least expected time until the thing is found.

Each next room is the one with the greatest probability per second of walking and looking, over all robots; then every
robot's own order is improved by reversing and moving pieces of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

TOLERANCE = 1e-9


@dataclass(frozen=True)
class Hunt:
    """`start_s[r][k]`: robot r, when free, to room k; `way_s[i][k]` between rooms; `look_s[k]` to search one."""

    probability: tuple[float, ...]
    look_s: tuple[float, ...]
    free_s: tuple[float, ...]
    start_s: tuple[tuple[float, ...], ...]
    way_s: tuple[tuple[float, ...], ...]


def expected_s(hunt: Hunt, robot: int, order: Sequence[int]) -> float:
    """Probability-weighted time at which the rooms of one robot are done."""
    clock, total, before = hunt.free_s[robot], 0.0, None
    for room in order:
        clock += hunt.start_s[robot][room] if before is None else hunt.way_s[before][room]
        clock += hunt.look_s[room]
        total += hunt.probability[room] * clock
        before = room
    return total


def search_order(hunt: Hunt) -> list[list[int]]:
    """Rooms for each robot, in order; every room once."""
    orders: list[list[int]] = [[] for _ in hunt.free_s]
    clock = list(hunt.free_s)
    left = set(range(len(hunt.probability)))
    while left and orders:
        _, robot, room = max(
            (hunt.probability[room] / (_arrival(hunt, orders, clock, robot, room)), -robot, -room)
            for robot in range(len(orders))
            for room in left
        )
        robot, room = -robot, -room
        clock[robot] = _arrival(hunt, orders, clock, robot, room)
        orders[robot].append(room)
        left.discard(room)
    return [_improved(hunt, robot, order) for robot, order in enumerate(orders)]


def _arrival(hunt: Hunt, orders: list[list[int]], clock: list[float], robot: int, room: int) -> float:
    order = orders[robot]
    way = hunt.way_s[order[-1]][room] if order else hunt.start_s[robot][room]
    return clock[robot] + way + hunt.look_s[room]


def _improved(hunt: Hunt, robot: int, order: list[int]) -> list[int]:
    """2-opt and or-opt until nothing is gained."""
    best, cost = order, expected_s(hunt, robot, order)
    gained = True
    while gained:
        gained = False
        for candidate in _neighbours(best):
            found = expected_s(hunt, robot, candidate)
            if found < cost - TOLERANCE:
                best, cost, gained = candidate, found, True
                break
    return best


def _neighbours(order: list[int]) -> list[list[int]]:
    count = len(order)
    found = []
    for i in range(count):
        for j in range(i + 1, count):
            found.append(order[:i] + order[i : j + 1][::-1] + order[j + 1 :])
            found.append(order[:i] + order[i + 1 : j + 1] + [order[i]] + order[j + 1 :])
            found.append([*order[:i], order[j], *order[i:j], *order[j + 1 :]])
    return found
