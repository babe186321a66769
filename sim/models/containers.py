"""Cans, hampers and cartons: things that things are thrown into."""

from collections.abc import Iterator
from math import pi

from sim.models.form import STEEL, Form, Model, box, cylinder, shade, tray
from sim.scene import Part
from sim.textures import FABRIC, METAL


def garbage_can(form: Form) -> Iterator[Part]:
    """Open at the top, with a black liner folded over the rim."""
    d, w, h = form.size_m
    skin = form.pick(((0.30, 0.33, 0.36), (0.20, 0.42, 0.28), (0.70, 0.71, 0.72), (0.75, 0.72, 0.62)))
    texture = METAL if skin[0] > 0.6 else 0
    yield from tray((d * 0.94, w * 0.94, h * 0.97), 0.0, 0.025, skin, (0.08, 0.08, 0.09), texture)
    for side in (-1.0, 1.0):
        yield box((side * (d - 0.03) / 2.0, 0.0, h - 0.04), (0.03, w, 0.08), (0.10, 0.10, 0.12))
        yield box((0.0, side * (w - 0.03) / 2.0, h - 0.04), (d, 0.03, 0.08), (0.10, 0.10, 0.12))
    yield box((d * 0.475, 0.0, h * 0.45), (0.012, w * 0.4, h * 0.3), shade(skin, 1.4))
    yield box((d * 0.483, 0.0, 0.03), (0.015, w * 0.3, 0.025), STEEL, METAL)


def laundry_hamper(form: Form) -> Iterator[Part]:
    """A basket with bands of cane; its lid closed, or leaning up behind a white lining."""
    d, w, h = form.size_m
    cane = form.pick(((0.80, 0.66, 0.45), (0.55, 0.40, 0.26), (0.85, 0.83, 0.78)))
    yield from tray((d * 0.95, w * 0.95, h - 0.05), 0.0, 0.03, cane, (0.88, 0.87, 0.84), FABRIC)
    for z in (0.18, 0.45, 0.72):
        for side in (-1.0, 1.0):
            yield box((side * (d / 2.0 - 0.012), 0.0, h * z), (0.024, w, h * 0.07), shade(cane, 0.65), FABRIC)
    if form.open:
        yield box((-d / 2.0 + 0.02, 0.0, h + d * 0.42), (0.03, w, d * 0.85), shade(cane, 0.85), FABRIC)
        for side in (-1.0, 1.0):
            yield box((0.0, side * (w / 2.0 - 0.045), h - 0.05), (d * 0.86, 0.03, 0.10), (0.92, 0.92, 0.90), FABRIC)
    else:
        yield box((0.0, 0.0, h - 0.025), (d, w, 0.05), shade(cane, 0.85), FABRIC)
        yield box((d * 0.30, 0.0, h - 0.004), (0.04, w * 0.25, 0.01), shade(cane, 0.4))


def carton(form: Form) -> Iterator[Part]:
    """Brown cardboard; taped shut, or with four flaps standing out."""
    d, w, h = form.size_m
    card = form.pick(((0.72, 0.54, 0.34), (0.66, 0.48, 0.30), (0.78, 0.62, 0.42)))
    yield from tray((d, w, h - 0.012), 0.0, 0.012, card, shade(card, 0.55))
    if form.open:
        for side in (-1.0, 1.0):
            yield box(
                (side * (d / 2.0 + d * 0.12), 0.0, h + 0.06),
                (d * 0.36, w * 0.96, 0.01),
                shade(card, 1.1),
                pitch=-side * 0.7,
            )
            yield box(
                (0.0, side * (w / 2.0 + w * 0.10), h + 0.06),
                (w * 0.34, d * 0.96, 0.01),
                shade(card, 1.1),
                yaw=pi / 2.0,
                pitch=-side * 0.7,
            )
    else:
        yield box((0.0, 0.0, h - 0.006), (d, w, 0.012), shade(card, 1.05))
        yield box((0.0, 0.0, h - 0.001), (d, 0.06, 0.006), (0.88, 0.80, 0.58))
        yield box((d / 2.0 - 0.001, 0.0, h * 0.82), (0.006, 0.06, h * 0.36), (0.88, 0.80, 0.58))
    yield box((d / 2.0, -w * 0.28, h * 0.35), (0.004, w * 0.25, h * 0.3), (0.93, 0.92, 0.88))


def vase(form: Form) -> Iterator[Part]:
    """Glazed, with a narrow neck."""
    d, w, h = form.size_m
    glaze = form.pick(
        ((0.16, 0.30, 0.62), (0.10, 0.50, 0.50), (0.72, 0.36, 0.20), (0.90, 0.88, 0.84), (0.45, 0.20, 0.45))
    )
    yield cylinder((0.0, 0.0, h * 0.04), (d * 0.5, w * 0.5, h * 0.08), shade(glaze, 0.7))
    yield cylinder((0.0, 0.0, h * 0.75), (d * 0.36, w * 0.36, h * 0.42), glaze)
    yield Part("sphere", (0.0, 0.0, h * 0.38), (d, w, h * 0.68), glaze)
    yield cylinder((0.0, 0.0, h * 0.40), (d * 1.0, w * 1.0, h * 0.05), shade(glaze, 1.5))
    yield cylinder((0.0, 0.0, h * 0.97), (d * 0.55, w * 0.55, h * 0.06), glaze)
    yield cylinder((0.0, 0.0, h * 0.998), (d * 0.4, w * 0.4, h * 0.01), (0.05, 0.05, 0.05))


CONTAINERS: dict[str, Model] = {
    "Box": carton,
    "GarbageCan": garbage_can,
    "LaundryHamper": laundry_hamper,
    "Vase": vase,
}
