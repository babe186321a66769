"""The floor plan: a rectangle sliced into rooms, and doors so that every room can be reached."""

from dataclasses import dataclass
from itertools import combinations
from math import sqrt
from random import Random

from sim.generator.areas import Area
from sim.generator.statistics import (
    DOOR_HEIGHT_M,
    DOUBLE_DOOR_M,
    DOUBLE_DOOR_SHARE,
    HOUSES,
    LONGEST_BY_WIDTH,
    NARROWEST_M,
    OPEN_KITCHEN_SHARE,
    ROOM_NAME,
    ROOM_SHARE,
    SINGLE_DOOR_M,
    House,
)
from sim.scene import Door, Vec2
from wire.catalogue import RoomKind

JAMB_M = 0.3
"""Wall left between a door and the nearest corner."""
DOOR_COST: dict[frozenset[str], float] = {
    frozenset(("Kitchen", "LivingRoom")): 0.0,
    frozenset(("LivingRoom",)): 0.5,
    frozenset(("LivingRoom", "Bedroom")): 1.0,
    frozenset(("LivingRoom", "Bathroom")): 1.5,
    frozenset(("Bedroom", "Bathroom")): 2.0,
    frozenset(("Kitchen", "Bedroom")): 2.5,
    frozenset(("Bedroom",)): 3.0,
    frozenset(("Kitchen", "Bathroom")): 4.0,
    frozenset(("Bathroom",)): 9.0,
}


@dataclass(frozen=True)
class PlannedRoom:
    id: str
    name: str
    kind: RoomKind
    area: Area
    """Up to the middles of its walls."""


@dataclass(frozen=True)
class Edge:
    """A stretch of wall that two rooms share."""

    rooms: tuple[int, int]
    start_m: Vec2
    end_m: Vec2

    @property
    def length_m(self) -> float:
        return self.end_m[0] - self.start_m[0] + self.end_m[1] - self.start_m[1]


@dataclass(frozen=True)
class FloorPlan:
    rooms: tuple[PlannedRoom, ...]
    edges: tuple[Edge, ...]
    doors: tuple[Door, ...]


def draw_house(rng: Random) -> House:
    """Which rooms a home has, and how much floor."""
    return rng.choices(HOUSES, [weight for weight, _, _ in HOUSES])[0]


def draw_plan(house: House, rng: Random) -> FloorPlan:
    """Draw until rooms are roomy and every one has a door."""
    while True:
        rooms = _draw_rooms(house, rng)
        edges = tuple(e for pair in combinations(range(len(rooms)), 2) if (e := _shared(rooms, pair)) is not None)
        chosen = _choose_edges(rooms, edges, rng)
        if chosen is not None:
            doors = tuple(_door(k + 1, edge, rooms, rng) for k, edge in enumerate(chosen))
            return FloorPlan(rooms, edges, doors)


def _draw_rooms(house: House, rng: Random) -> tuple[PlannedRoom, ...]:
    _, kinds, (least, most) = house
    while True:
        floor_m2, aspect = rng.uniform(least, most), rng.uniform(1.0, 1.5)
        whole = Area(0.0, 0.0, _round(sqrt(floor_m2 * aspect)), _round(sqrt(floor_m2 / aspect)))
        rest = list(kinds[2:])
        rng.shuffle(rest)
        sliced = _slice(whole, [*kinds[:2], *rest], rng)
        if all(_roomy(area) for _, area in sliced):
            return _named(sliced)


def _slice(area: Area, kinds: list[RoomKind], rng: Random) -> list[tuple[RoomKind, Area]]:
    """Cut across the longer side into two groups of rooms, by their shares, and go on with each."""
    if len(kinds) == 1:
        return [(kinds[0], area)]
    shares = [ROOM_SHARE[kind] * rng.uniform(0.85, 1.2) for kind in kinds]
    half = sum(shares) / 2.0
    at = min(range(1, len(kinds)), key=lambda k: abs(sum(shares[:k]) - half) + rng.uniform(0.0, 0.3))
    part = sum(shares[:at]) / sum(shares)
    first, second = kinds[:at], kinds[at:]
    if rng.random() < 0.5:
        first, second, part = second, first, 1.0 - part
    if area.width_m * rng.uniform(0.9, 1.1) > area.depth_m:
        x = _round(area.x0 + area.width_m * part)
        halves = Area(area.x0, area.y0, x, area.y1), Area(x, area.y0, area.x1, area.y1)
    else:
        y = _round(area.y0 + area.depth_m * part)
        halves = Area(area.x0, area.y0, area.x1, y), Area(area.x0, y, area.x1, area.y1)
    return _slice(halves[0], first, rng) + _slice(halves[1], second, rng)


def _roomy(area: Area) -> bool:
    short, long = sorted((area.width_m, area.depth_m))
    return short >= NARROWEST_M and long <= LONGEST_BY_WIDTH * short


def _named(sliced: list[tuple[RoomKind, Area]]) -> tuple[PlannedRoom, ...]:
    """Rooms in a fixed order; numbered where there are several of a kind."""
    rooms = []
    for kind in ROOM_NAME:
        of_kind = [area for k, area in sliced if k == kind]
        for number, area in enumerate(of_kind, start=1):
            room_id, name = ROOM_NAME[kind]
            if len(of_kind) > 1 or kind == "Bedroom":
                room_id, name = f"{room_id}-{number}", f"{name} {number}"
            rooms.append(PlannedRoom(room_id, name, kind, area))
    return tuple(rooms)


def _shared(rooms: tuple[PlannedRoom, ...], pair: tuple[int, int]) -> Edge | None:
    a, b = rooms[pair[0]].area, rooms[pair[1]].area
    low_x, high_x = max(a.x0, b.x0), min(a.x1, b.x1)
    low_y, high_y = max(a.y0, b.y0), min(a.y1, b.y1)
    if abs(high_x - low_x) < 1e-6 and high_y - low_y > 0.01:
        return Edge(pair, (low_x, low_y), (low_x, high_y))
    if abs(high_y - low_y) < 1e-6 and high_x - low_x > 0.01:
        return Edge(pair, (low_x, low_y), (high_x, low_y))
    return None


def _choose_edges(rooms: tuple[PlannedRoom, ...], edges: tuple[Edge, ...], rng: Random) -> list[Edge] | None:
    """The cheapest tree of doors, and up to two more; None when some room stays closed."""
    wide = [e for e in edges if e.length_m >= SINGLE_DOOR_M[1] + 2.0 * JAMB_M]
    cost = {e: DOOR_COST[frozenset(rooms[r].kind for r in e.rooms)] + rng.uniform(0.0, 1.2) for e in wide}
    group = list(range(len(rooms)))
    tree = []
    for edge in sorted(wide, key=lambda e: cost[e]):
        a, b = (group[r] for r in edge.rooms)
        if a != b:
            tree.append(edge)
            group = [a if g == b else g for g in group]
    if len(tree) < len(rooms) - 1:
        return None
    others = [e for e in wide if e not in tree and cost[e] < 3.2]
    return tree + rng.sample(others, min(len(others), rng.randint(0, 2)))


def _door(number: int, edge: Edge, rooms: tuple[PlannedRoom, ...], rng: Random) -> Door:
    kinds = {rooms[r].kind for r in edge.rooms}
    share = OPEN_KITCHEN_SHARE if kinds == {"Kitchen", "LivingRoom"} else DOUBLE_DOOR_SHARE
    spare_m = edge.length_m - 2.0 * JAMB_M
    double = "Bathroom" not in kinds and rng.random() < share and spare_m > DOUBLE_DOOR_M[1]
    width_m = round(rng.uniform(*(DOUBLE_DOOR_M if double else SINGLE_DOOR_M)), 2)
    at_m = JAMB_M + round(rng.uniform(0.0, spare_m - width_m), 2)
    (x, y), along_x = edge.start_m, edge.end_m[0] > edge.start_m[0]
    start = (x + at_m, y) if along_x else (x, y + at_m)
    end = (x + at_m + width_m, y) if along_x else (x, y + at_m + width_m)
    a, b = (rooms[r].id for r in edge.rooms)
    rounded = [(round(px, 3), round(py, 3)) for px, py in (start, end)]
    return Door(f"door-{number}", (a, b), rounded[0], rounded[1], round(rng.uniform(*DOOR_HEIGHT_M), 2))


def _round(value_m: float) -> float:
    return round(round(value_m / 0.05) * 0.05, 2)
