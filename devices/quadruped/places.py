"""Where to stand: cells from which a place is reached or a thing can be worked on, with what each costs extra."""

from collections.abc import Mapping
from math import inf

import numpy as np

from devices.quadruped.map import Cell, FloorMap, Grid, Mask
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
    away = floor.distance_m(point_m)
    free = floor.clearance_m >= NEEDED_M
    slack = max(POINT_SLACK_M, float(away[free].min()) + 0.2) if free.any() else POINT_SLACK_M
    return _cells(floor, free & (away < slack), POINT_PRICE * away)


def in_room(floor: FloorMap, room: Room, doors: tuple[Door, ...]) -> Mapping[Cell, float]:
    """Inside a room, out of its doorways."""
    price = np.zeros_like(floor.walls_m)
    for door in doors:
        middle = ((door.start_m[0] + door.end_m[0]) / 2.0, (door.start_m[1] + door.end_m[1]) / 2.0)
        price += DOORWAY_PRICE * np.maximum(DOORWAY_M - floor.distance_m(middle), 0.0)
    inside = floor.inside(room.polygon_m) & (floor.clearance_m >= NEEDED_M)
    return _cells(floor, inside & (price <= float(price[inside].min(initial=np.inf)) + DOORWAY_PRICE), price)


def away_from(floor: FloorMap, others_m: tuple[Vec2, ...]) -> Mapping[Cell, float]:
    """Anywhere out of the way of others, the further from them the better."""
    away = np.full_like(floor.walls_m, REFUGE_M)
    for other_m in others_m:
        away = np.minimum(away, floor.distance_m(other_m))
    return _cells(floor, (floor.clearance_m >= NEEDED_M) & (away >= REFUGE_LEAST_M), REFUGE_PRICE * (REFUGE_M - away))


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
    away, half = floor.distance_m(point_m), half_width_m(type)
    closest_m = half + SWING_M if door_swings else 0.0
    fits = (floor.clearance_m >= NEEDED_M) & (away <= min(REACH_M + half, farthest_m)) & (away >= closest_m)
    price: Grid = (COMFORT_PRICE * np.abs(away - half - COMFORT_M)).astype(np.float32)
    price += np.where(away > REACH_M + half - REACH_SPARE_M, FAR_PRICE, 0.0)
    return _facing(floor, fits, price, point_m, room, not_from_m)


def in_view(
    floor: FloorMap,
    point_m: Vec2,
    between_m: tuple[float, float],
    room: Room | None = None,
    not_from_m: tuple[Vec2, ...] = (),
) -> Mapping[Cell, float]:
    """At a distance from which a thing is seen well; not near where it was not seen from."""
    away = floor.distance_m(point_m)
    ring = (floor.clearance_m >= NEEDED_M) & (away >= between_m[0]) & (away <= between_m[1])
    return _facing(floor, ring, np.zeros_like(away), point_m, room, not_from_m)


def _facing(
    floor: FloorMap, chosen: Mask, price: Grid, point_m: Vec2, room: Room | None, not_from_m: tuple[Vec2, ...]
) -> Mapping[Cell, float]:
    """Those cells that no wall parts from the thing, in its own room where that is known and has any."""
    for tried_m in not_from_m:
        chosen = chosen & (floor.distance_m(tried_m) > OTHER_SIDE_M)
    if room is not None and (inside := chosen & floor.inside(room.polygon_m)).any():
        chosen = inside
    cells = _cells(floor, chosen, price)
    return {cell: extra for cell, extra in cells.items() if floor.clear_of_walls(floor.centre_m(cell), point_m)}


def within_reach(position_m: Vec2, point_m: Vec2, type: str) -> bool:
    """Whether the hand gets to a thing from where the body stands."""
    return distance_m(position_m, point_m) <= REACH_M + half_width_m(type) + STANDING_M


def half_width_m(type: str) -> float:
    """From a thing's middle to the nearer of its faces, as things of its type commonly are."""
    row = catalogue().get(type)
    return min(row.size_m[0], row.size_m[1]) / 2.0 if row else 0.0


def _cells(floor: FloorMap, chosen: Mask, price: Grid) -> Mapping[Cell, float]:
    """The chosen cells and their prices, the cheapest first and not too many."""
    rows, columns = np.nonzero(chosen)
    extra = price[rows, columns]
    order = np.argsort(extra, kind="stable")[:MOST_PLACES]
    return {Cell(int(rows[i]), int(columns[i])): float(extra[i]) for i in order}
