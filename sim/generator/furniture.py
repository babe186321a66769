"""Furniture, room by room: first what makes a kitchen a kitchen, then what the room's kind may have besides."""

from collections.abc import Callable
from math import cos, pi, sin
from random import Random

from sim.generator.areas import Area
from sim.generator.placing import RoomPlacing, footprint
from sim.generator.statistics import draw_size_m
from sim.scene import Body, Door, Vec2, Vec3
from wire.catalogue import RoomKind, catalogue, modelled_types

MOST_EXTRAS: dict[RoomKind, int] = {"Kitchen": 2, "LivingRoom": 5, "Bedroom": 4, "Bathroom": 2}
COMMON, RARE = 0.62, 0.28
"""Chance that a room has a thing of weight 2, of weight 1."""
PLACED_FIRST = (
    "Bed",
    "CounterTop",
    "DiningTable",
    "Fridge",
    "Sofa",
    "TVStand",
    "Toilet",
    "Sink",
    "CoffeeTable",
    "Chair",
)
ON_COUNTER = ("Sink", "Microwave", "CoffeeMachine", "Toaster")


def furnish(placing: RoomPlacing, doors: tuple[Door, ...], dining: bool) -> None:
    """Furnish one room; `dining`: the home's dining table belongs here."""
    FIRST[placing.room.kind](placing)
    if dining:
        dining_table(placing)
    extras(placing)
    if placing.room.kind != "Bathroom":
        paintings(placing, doors)


def kitchen(placing: RoomPlacing) -> None:
    placing.against_wall("Fridge")
    counters = [placing.against_wall("CounterTop") for _ in range(2)]
    waiting = [kind for kind in ON_COUNTER if kind == "Sink" or placing.rng.random() < 0.85]
    for counter in counters:
        if counter is not None:
            waiting = _line_up(placing, counter, waiting)


def _line_up(placing: RoomPlacing, counter: Body, waiting: list[str]) -> list[str]:
    """Stand appliances side by side on a counter, as far as there is room and some is left for other things."""
    sizes = {kind: draw_size_m(kind, placing.rng) for kind in waiting}
    if "Sink" in sizes:
        sizes["Sink"] = (0.46, 0.62, 0.22)
    chosen: list[str] = []
    for kind in waiting:
        if sum(sizes[k][1] + 0.06 for k in [*chosen, kind]) <= counter.size_m[1] - 0.55 and len(chosen) < 3:
            chosen.append(kind)
    slots: list[str] = chosen.copy()
    placing.rng.shuffle(slots)
    spare_m = counter.size_m[1] - sum(sizes[k][1] for k in chosen)
    gaps = sorted(placing.rng.uniform(0.0, spare_m - 0.06) for _ in slots)
    left_m, at = 0.03, -counter.size_m[1] / 2.0
    for kind, gap in zip(slots, gaps, strict=True):
        size = sizes[kind]
        y = at + left_m + gap + size[1] / 2.0
        placing.on_top(kind, size, counter, ((size[0] - counter.size_m[0]) / 2.0 + 0.03, y))
        left_m += size[1]
    return [kind for kind in waiting if kind not in chosen]


def living_room(placing: RoomPlacing) -> None:
    stand = placing.against_wall("TVStand")
    if stand is not None:
        put_television(placing, stand)
        sofa = _facing(placing, stand)
    else:
        sofa = None
    sofa = sofa or placing.against_wall("Sofa")
    if sofa is not None and placing.rng.random() < 0.7:
        size = draw_size_m("CoffeeTable", placing.rng)
        size = (min(size[0], 0.7), min(size[1], 1.2), size[2])
        ahead = sofa.size_m[0] / 2.0 + size[0] / 2.0 + placing.rng.uniform(0.35, 0.5)
        placing.at("CoffeeTable", size, _ahead(sofa, ahead), sofa.yaw_rad)


def put_television(placing: RoomPlacing, stand: Body) -> Body | None:
    depth, width, height = draw_size_m("Television", placing.rng)
    size = (min(depth, stand.size_m[0] - 0.04), min(width, stand.size_m[1]), height)
    return placing.on_top("Television", size, stand, (0.0, 0.0))


def _facing(placing: RoomPlacing, stand: Body) -> Body | None:
    """A sofa that looks at the television, not too near."""
    for _ in range(10):
        size = draw_size_m("Sofa", placing.rng)
        x, y = _ahead(stand, placing.rng.uniform(2.3, 3.6))
        aside = placing.rng.uniform(-0.4, 0.4)
        x, y = x - sin(stand.yaw_rad) * aside, y + cos(stand.yaw_rad) * aside
        sofa = placing.at("Sofa", size, (x, y), _turned(stand.yaw_rad))
        if sofa is not None:
            return sofa
    return placing.against_wall("Sofa", yaw_rad=_turned(stand.yaw_rad))


def bedroom(placing: RoomPlacing) -> None:
    bed = placing.against_wall("Bed")
    if bed is not None and placing.rng.random() < 0.8:
        size = draw_size_m("SideTable", placing.rng)
        side = placing.rng.choice((-1.0, 1.0)) * ((bed.size_m[1] + size[1]) / 2.0 + 0.05)
        back = (size[0] - bed.size_m[0]) / 2.0
        c, s = cos(bed.yaw_rad), sin(bed.yaw_rad)
        x, y, _ = bed.position_m
        placing.at("SideTable", size, (x + c * back - s * side, y + s * back + c * side), bed.yaw_rad)
    dresser = placing.against_wall("Dresser")
    if dresser is not None and placing.rng.random() < 0.35:
        put_television(placing, dresser)


def bathroom(placing: RoomPlacing) -> None:
    placing.against_wall("Toilet")
    sink = placing.against_wall("Sink", (0.46, round(placing.rng.uniform(0.55, 0.70), 3), 0.95))
    if sink is None:
        placing.against_wall("Sink", (0.40, 0.5, 0.95))


FIRST: dict[RoomKind, Callable[[RoomPlacing], None]] = {
    "Kitchen": kitchen,
    "LivingRoom": living_room,
    "Bedroom": bedroom,
    "Bathroom": bathroom,
}


def dining_table(placing: RoomPlacing) -> None:
    """In the middle or at a wall, with chairs around it."""
    rng, inner = placing.rng, placing.inner
    for _ in range(14):
        size, yaw = draw_size_m("DiningTable", rng), rng.choice((0.0, pi / 2.0))
        x = rng.uniform(inner.x0 + 0.5, inner.x1 - 0.5)
        y = rng.uniform(inner.y0 + 0.5, inner.y1 - 0.5)
        table = placing.at("DiningTable", size, (x, y), yaw)
        if table is None:
            continue
        chair = draw_size_m("Chair", rng)
        for side, along in ((1.0, 0.24), (-1.0, -0.24), (1.0, -0.24), (-1.0, 0.24)):
            if rng.random() < 0.75:
                _pull_up(placing, table, chair, side, along * size[1])
        return


def _pull_up(placing: RoomPlacing, table: Body, chair: Vec3, side: float, along_m: float) -> None:
    away = side * (table.size_m[0] / 2.0 + chair[0] / 2.0 + 0.02)
    c, s = cos(table.yaw_rad), sin(table.yaw_rad)
    x, y, _ = table.position_m
    yaw = _turned(table.yaw_rad) if side > 0.0 else table.yaw_rad
    placing.at("Chair", chair, (x + c * away - s * along_m, y + s * away + c * along_m), yaw, tuck=True)


def extras(placing: RoomPlacing) -> None:
    """Things that the kind of room may have, by the catalogue's weights."""
    rng, kind = placing.rng, placing.room.kind
    floor_kinds = [n for n in modelled_types() if n not in PLACED_FIRST and _stands_on_floor(n)]
    wanted = [n for n in floor_kinds if rng.random() < _chance(n, kind)]
    rng.shuffle(wanted)
    left = MOST_EXTRAS[kind]
    for name in sorted(wanted, key=lambda n: n != "GarbageCan"):
        if left and any(b.type == name for b in placing.bodies.values()) is False:
            body = placing.against_wall(name)
            left -= body is not None
            if body is not None and name == "Desk":
                _pull_up(placing, body, draw_size_m("Chair", rng), 1.0, 0.0)
            if body is not None and name == "TVStand":
                put_television(placing, body)


def _stands_on_floor(name: str) -> bool:
    row = catalogue()[name]
    return bool({"onFloor", "onEdge"} & set(row.placement))


def _chance(name: str, kind: RoomKind) -> float:
    weight = catalogue()[name].room_weights.get(kind, 0.0)
    return COMMON if weight >= 2.0 else RARE if weight >= 1.0 else 0.0


def paintings(placing: RoomPlacing, doors: tuple[Door, ...]) -> None:
    """On walls, above low furniture, away from doors."""
    rng, inner = placing.rng, placing.inner
    for _ in range(rng.choice((0, 1, 1, 2))):
        size, yaw = draw_size_m("Painting", rng), rng.choice((0.0, pi, pi / 2.0, -pi / 2.0))
        along = rng.uniform(0.15, 0.85)
        back = size[0] / 2.0 + 0.005
        x = inner.x0 + along * inner.width_m
        y = inner.y0 + along * inner.depth_m
        x = {0.0: inner.x0 + back, pi: inner.x1 - back}.get(yaw, x)
        y = {pi / 2.0: inner.y0 + back, -pi / 2.0: inner.y1 - back}.get(yaw, y)
        area, bottom_m = footprint((x, y), size, yaw), rng.uniform(1.3, 1.5)
        if inner.holds(area) and not _in_the_way(area.grown(0.08), bottom_m, placing, doors):
            placing.hang("Painting", size, (x, y, bottom_m), yaw)


def _in_the_way(area: Area, bottom_m: float, placing: RoomPlacing, doors: tuple[Door, ...]) -> bool:
    gaps = [Area(d.start_m[0], d.start_m[1], d.end_m[0], d.end_m[1]).grown(0.12) for d in doors]
    tall = [
        footprint((b.position_m[0], b.position_m[1]), b.size_m, b.yaw_rad)
        for b in placing.bodies.values()
        if b.position_m[2] + b.size_m[2] > bottom_m - 0.02
    ]
    return any(area.overlaps(other) for other in gaps + tall)


def _ahead(body: Body, ahead_m: float) -> Vec2:
    x, y, _ = body.position_m
    return (x + cos(body.yaw_rad) * ahead_m, y + sin(body.yaw_rad) * ahead_m)


def _turned(yaw_rad: float) -> float:
    """The opposite direction, exactly one of the four that walls have."""
    return {0.0: pi, pi: 0.0, pi / 2.0: -pi / 2.0, -pi / 2.0: pi / 2.0}[yaw_rad]


def dining_room(rooms: list[RoomPlacing], rng: Random) -> RoomPlacing:
    """Where the home's dining table goes: a kitchen with space, else the largest living room."""
    kitchens = [p for p in rooms if p.room.kind == "Kitchen" and p.inner.floor_m2 > 17.0]
    living = max((p for p in rooms if p.room.kind == "LivingRoom"), key=lambda p: p.inner.floor_m2)
    return rng.choice([*kitchens, living])
