"""Tables, desks, counters and chests: furniture with a top."""

from collections.abc import Iterator

from sim.models.form import BLACK, PAINTS, STEEL, WOODS, Form, Model, box, cylinder, legs, shade
from sim.models.surfaces import BOARD_M, shelf_heights_m
from sim.scene import Part
from sim.textures import MARBLE, METAL, WOOD


def dining_table(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    wood = form.pick(WOODS)
    if form.chance.random() < 0.3:
        yield box((0.0, 0.0, h - 0.025), (d, w, 0.05), wood, WOOD)
        yield box((0.0, 0.0, h * 0.25), (0.05, w * 0.6, 0.08), shade(wood, 0.8), WOOD)
        for side in (-1.0, 1.0):
            yield box((0.0, side * w * 0.32, h / 2.0), (0.10, 0.10, h - 0.06), shade(wood, 0.85), WOOD)
            yield box((0.0, side * w * 0.32, 0.03), (d * 0.8, 0.10, 0.06), shade(wood, 0.8), WOOD)
        return
    yield box((0.0, 0.0, h - 0.02), (d, w, 0.04), wood, WOOD)
    yield box((0.0, 0.0, h - 0.08), (d * 0.86, w * 0.9, 0.08), shade(wood, 0.8), WOOD)
    yield from legs(form.size_m, h - 0.04, 0.07, shade(wood, 0.85), WOOD)


def coffee_table(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    wood, frame = form.pick(WOODS), form.pick(PAINTS)
    yield box((0.0, 0.0, h - 0.025), (d, w, 0.05), wood, WOOD)
    yield box((0.0, 0.0, h * 0.3), (d * 0.86, w * 0.9, 0.025), shade(wood, 0.85), WOOD)
    yield from legs(form.size_m, h - 0.05, 0.06, frame, WOOD)


def side_table(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    wood = form.pick(PAINTS)
    yield box((0.0, 0.0, h - 0.015), (d, w, 0.03), wood, WOOD)
    yield box((0.0, 0.0, h - 0.11), (d * 0.9, w * 0.9, 0.16), shade(wood, 0.85), WOOD)
    yield box((d * 0.46, 0.0, h - 0.11), (0.012, w * 0.8, 0.11), wood, WOOD)
    yield cylinder((d * 0.48, 0.0, h - 0.11), (0.03, 0.03, 0.03), STEEL, METAL)
    yield from legs(form.size_m, h - 0.03, 0.04, shade(wood, 0.9), WOOD)


def desk(form: Form) -> Iterator[Part]:
    """A top on two sides, drawers under one end, a board at the back."""
    d, w, h = form.size_m
    wood, side = form.pick(WOODS), form.pick(PAINTS)
    yield box((0.0, 0.0, h - 0.015), (d, w, 0.03), wood, WOOD)
    for end in (-1.0, 1.0):
        yield box((0.0, end * (w / 2.0 - 0.02), (h - 0.03) / 2.0), (d * 0.96, 0.04, h - 0.03), side, WOOD)
    yield box((-d / 2.0 + 0.02, 0.0, h * 0.7), (0.02, w - 0.06, h * 0.5), shade(side, 0.9), WOOD)
    yield box((0.0, w / 2.0 - 0.24, h * 0.66), (d * 0.9, 0.40, h * 0.6), side, WOOD)
    for z in (0.48, 0.66, 0.84):
        yield box((d * 0.455, w / 2.0 - 0.24, h * z), (0.012, 0.36, h * 0.15), shade(wood, 1.1), WOOD)


def counter_top(form: Form) -> Iterator[Part]:
    """Kitchen cupboards under a slab of stone."""
    d, w, h = form.size_m
    front = form.pick(((0.90, 0.89, 0.86), (0.35, 0.45, 0.50), (0.62, 0.46, 0.30), (0.42, 0.50, 0.42)))
    slab = form.pick(((0.80, 0.79, 0.77), (0.30, 0.30, 0.31), (0.66, 0.58, 0.50)))
    yield box((-0.03, 0.0, 0.05), (d - 0.06, w, 0.10), BLACK)
    yield box((-0.01, 0.0, h / 2.0 + 0.03), (d - 0.02, w, h - 0.14), shade(front, 0.8))
    yield box((0.0, 0.0, h - 0.02), (d, w, 0.04), slab, MARBLE)
    count = max(2, min(5, round(w / 0.6)))
    for k in range(count):
        y = (k - (count - 1) / 2.0) * w / count
        yield box((d / 2.0 - 0.014, y, h * 0.42), (0.014, w / count - 0.02, h * 0.58), front)
        yield box((d / 2.0 - 0.014, y, h * 0.84), (0.014, w / count - 0.02, h * 0.18), front)
        yield box((d / 2.0 - 0.004, y, h * 0.80), (0.008, w / count * 0.4, 0.015), STEEL, METAL)


def dresser(form: Form) -> Iterator[Part]:
    """A chest of drawers."""
    d, w, h = form.size_m
    wood = form.pick(PAINTS)
    yield box((-0.01, 0.0, h / 2.0 + 0.03), (d - 0.02, w - 0.02, h - 0.08), shade(wood, 0.75), WOOD)
    yield box((0.0, 0.0, h - 0.015), (d, w, 0.03), wood, WOOD)
    columns, rows = (2 if w > 1.0 else 1), (4 if h > 0.95 else 3)
    for row in range(rows):
        for column in range(columns):
            y = (column - (columns - 1) / 2.0) * (w - 0.04) / columns
            z = 0.08 + (h - 0.13) * (row + 0.5) / rows
            yield box((d / 2.0 - 0.015, y, z), (0.015, (w - 0.10) / columns, (h - 0.13) / rows - 0.02), wood, WOOD)
            yield box((d / 2.0 - 0.004, y, z), (0.008, 0.14, 0.02), STEEL, METAL)


def tv_stand(form: Form) -> Iterator[Part]:
    """Low and wide, with an open middle."""
    d, w, h = form.size_m
    wood = form.pick(PAINTS)
    dark = shade(wood, 0.45)
    yield box((0.0, 0.0, h - 0.02), (d, w, 0.04), wood, WOOD)
    yield box((0.0, 0.0, 0.06), (d * 0.96, w * 0.98, 0.04), wood, WOOD)
    yield box((-d / 2.0 + 0.02, 0.0, h / 2.0), (0.02, w * 0.96, h - 0.1), dark)
    yield box((-0.02, 0.0, h * 0.52), (d * 0.9, w * 0.34, 0.02), wood, WOOD)
    for side in (-1.0, 1.0):
        yield box((-0.01, side * w * 0.33, h / 2.0 + 0.02), (d * 0.92, w * 0.31, h - 0.1), shade(wood, 0.85), WOOD)
        yield box((d * 0.46, side * w * 0.20, h / 2.0), (0.012, 0.02, 0.12), STEEL, METAL)


def shelving_unit(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    wood = form.pick(PAINTS)
    for side in (-1.0, 1.0):
        yield box((0.0, side * (w / 2.0 - 0.015), h / 2.0), (d, 0.03, h), wood, WOOD)
    yield box((-d / 2.0 + 0.008, 0.0, h / 2.0), (0.016, w, h), shade(wood, 0.7), WOOD)
    for z in shelf_heights_m(h):
        yield box((0.0, 0.0, z - BOARD_M / 2.0), (d, w - 0.05, BOARD_M), wood, WOOD)


TABLES: dict[str, Model] = {
    "CoffeeTable": coffee_table,
    "CounterTop": counter_top,
    "Desk": desk,
    "DiningTable": dining_table,
    "Dresser": dresser,
    "ShelvingUnit": shelving_unit,
    "SideTable": side_table,
    "TVStand": tv_stand,
}
