"""Where to stand: cells from which a place is reached or a thing can be worked on, with what each costs extra."""

from collections.abc import Iterable, Mapping
from math import dist, inf
from operator import itemgetter

from devices.quadruped.grid import Cell
from devices.quadruped.map import FloorMap
from devices.quadruped.path import NEEDED_M
from wire.catalogue import catalogue
from wire.frames import distance_m
from wire.model import Vec2
from wire.site import Door, Room

POINT_SLACK_M, POINT_PRICE = 0.6, 6.0
DOORWAY_M, DOORWAY_PRICE = 1.2, 5.0
REACH_M = 1.2
"""Of the hand: from the body's centre to the nearest point of the thing, on the floor plane."""
REACH_SPARE_M, STANDING_M = 0.12, 0.12
FAR_PRICE = 3.0
COMFORT_M, COMFORT_PRICE = 0.75, 2.0
SWING_M = 0.72
"""From the middle of what opens, beyond its half width: the door of a fridge swings out in front of it."""
OTHER_SIDE_M = 0.6
REFUGE_M, REFUGE_LEAST_M, REFUGE_PRICE = 3.0, 1.3, 1.5
MOST_PLACES = 400


def near_point(floor: FloorMap, point_m: Vec2) -> Mapping[Cell, float]:
    """As near to a point as the robot can stand."""
    free = [(cell, dist(floor.centre_m(cell), point_m)) for cell in _standing(floor)]
    slack_m = max(POINT_SLACK_M, min((away_m for _, away_m in free), default=0.0) + 0.2)
    return _cheapest((cell, POINT_PRICE * away_m) for cell, away_m in free if away_m < slack_m)


def in_room(floor: FloorMap, room: Room, doors: tuple[Door, ...]) -> Mapping[Cell, float]:
    """Inside a room, out of its doorways."""
    inside = floor.inside(room.polygon_m)
    price = {cell: 0.0 for cell in _standing(floor) if inside[cell]}
    for door in doors:
        middle = ((door.start_m[0] + door.end_m[0]) / 2.0, (door.start_m[1] + door.end_m[1]) / 2.0)
        for cell, away_m in floor.around(middle, DOORWAY_M):
            if cell in price:
                price[cell] += DOORWAY_PRICE * (DOORWAY_M - away_m)
    most = min(price.values(), default=inf) + DOORWAY_PRICE
    return _cheapest((cell, extra) for cell, extra in price.items() if extra <= most)


def away_from(floor: FloorMap, others_m: tuple[Vec2, ...]) -> Mapping[Cell, float]:
    """Anywhere out of the way of others, the further from them the better."""
    price: dict[Cell, float] = {}
    for cell in _standing(floor):
        centre_m = floor.centre_m(cell)
        away_m = min(REFUGE_M, *(dist(centre_m, other_m) for other_m in others_m))
        if away_m >= REFUGE_LEAST_M:
            price[cell] = REFUGE_PRICE * (REFUGE_M - away_m)
    return _cheapest(price.items())


def beside(
    floor: FloorMap,
    point_m: Vec2,
    type: str,
    room: Room | None = None,
    not_from_m: tuple[Vec2, ...] = (),
    door_swings: bool = False,
    farthest_m: float = inf,
) -> Mapping[Cell, float]:
    """In reach of a thing and in sight of it, at a comfortable distance; not where it was tried from before."""
    half_m, clearance_m = half_width_m(type), floor.clearance_m
    closest_m = half_m + SWING_M if door_swings else 0.0
    price = {
        cell: COMFORT_PRICE * abs(away_m - half_m - COMFORT_M)
        + (FAR_PRICE if away_m > REACH_M + half_m - REACH_SPARE_M else 0.0)
        for cell, away_m in floor.around(point_m, min(REACH_M + half_m, farthest_m))
        if away_m >= closest_m and clearance_m[cell] >= NEEDED_M
    }
    return _facing(floor, price, point_m, room, not_from_m)


def in_view(
    floor: FloorMap,
    point_m: Vec2,
    between_m: tuple[float, float],
    room: Room | None = None,
    not_from_m: tuple[Vec2, ...] = (),
) -> Mapping[Cell, float]:
    """At a distance from which a thing is seen well; not near where it was not seen from."""
    (nearest_m, farthest_m), clearance_m = between_m, floor.clearance_m
    ring = (cell for cell, away_m in floor.around(point_m, farthest_m) if away_m >= nearest_m)
    price = {cell: 0.0 for cell in ring if clearance_m[cell] >= NEEDED_M}
    return _facing(floor, price, point_m, room, not_from_m)


def _facing(
    floor: FloorMap, price: dict[Cell, float], point_m: Vec2, room: Room | None, not_from_m: tuple[Vec2, ...]
) -> Mapping[Cell, float]:
    """Those cells that no wall parts from the thing, in its own room where that is known and has any."""
    for tried_m in not_from_m:
        for cell, _ in floor.around(tried_m, OTHER_SIDE_M):
            price.pop(cell, None)
    if room is not None:
        inside = floor.inside(room.polygon_m)
        price = {cell: extra for cell, extra in price.items() if inside[cell]} or price
    cells = _cheapest(price.items())
    return {cell: extra for cell, extra in cells.items() if floor.clear_of_walls(floor.centre_m(cell), point_m)}


def within_reach(position_m: Vec2, point_m: Vec2, type: str) -> bool:
    """Whether the hand gets to a thing from where the body stands."""
    return distance_m(position_m, point_m) <= REACH_M + half_width_m(type) + STANDING_M


def half_width_m(type: str) -> float:
    """From a thing's middle to the nearer of its faces, as things of its type commonly are."""
    row = catalogue().get(type)
    return min(row.size_m[0], row.size_m[1]) / 2.0 if row else 0.0


def _standing(floor: FloorMap) -> list[Cell]:
    """Where the robot fits."""
    return [cell for cell, gap_m in enumerate(floor.clearance_m) if gap_m >= NEEDED_M]


def _cheapest(prices: Iterable[tuple[Cell, float]]) -> Mapping[Cell, float]:
    """The cells and their prices, the cheapest first and not too many."""
    return dict(sorted(prices, key=itemgetter(1))[:MOST_PLACES])
