"""Dishes, pans and bottles. Dirty ones carry brown stains."""

from collections.abc import Iterator
from math import cos, pi, sin

from sim.models.form import BLACK, STAIN, STEEL, Form, Model, box, cone, cylinder, shade, sphere
from sim.scene import Part, Rgb, Vec3
from sim.textures import METAL, WOOD

CHINA: tuple[Rgb, ...] = (
    (0.92, 0.92, 0.91),
    (0.45, 0.62, 0.78),
    (0.85, 0.72, 0.48),
    (0.50, 0.68, 0.55),
    (0.80, 0.45, 0.42),
)
DARK: tuple[Rgb, ...] = ((0.13, 0.13, 0.14), (0.55, 0.56, 0.58), (0.45, 0.12, 0.10))


def _stains(centre_m: Vec3, across_m: float, count: int = 5) -> Iterator[Part]:
    """Blotches on a round face."""
    x, y, z = centre_m
    yield cylinder(centre_m, (across_m * 0.52, across_m * 0.46, 0.004), STAIN)
    for k in range(count - 1):
        angle, size = 2.0 * pi * k / (count - 1) + 0.4, across_m * (0.30 - 0.04 * k)
        yield cylinder(
            (x + across_m * 0.30 * cos(angle), y + across_m * 0.30 * sin(angle), z),
            (size, size * 0.8, 0.005),
            shade(STAIN, 0.8 + 0.2 * k),
        )


def plate(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    china = form.pick(CHINA)
    yield cylinder((0.0, 0.0, h * 0.2), (d * 0.6, w * 0.6, h * 0.4), shade(china, 0.85))
    yield cylinder((0.0, 0.0, h * 0.7), (d, w, h * 0.5), china)
    yield cylinder((0.0, 0.0, h * 0.955), (d * 0.68, w * 0.68, h * 0.06), shade(china, 0.82))
    if form.dirty:
        yield from _stains((0.0, 0.0, h * 0.98), d * 0.85)


def bowl(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    china = form.pick(CHINA)
    yield cylinder((0.0, 0.0, h * 0.06), (d * 0.45, w * 0.45, h * 0.12), shade(china, 0.8))
    yield cylinder((0.0, 0.0, h * 0.20), (d * 0.56, w * 0.56, h * 0.22), china)
    yield cone((0.0, 0.0, h * 0.5), (d, w, h * 0.96), china, pitch=pi)
    yield cylinder((0.0, 0.0, h * 0.42), (d * 0.76, w * 0.76, h * 0.3), china)
    yield cylinder((0.0, 0.0, h * 0.78), (d * 0.96, w * 0.96, h * 0.42), china)
    yield cylinder((0.0, 0.0, h * 0.992), (d * 0.86, w * 0.86, h * 0.01), shade(china, 0.6))
    if form.dirty:
        yield from _stains((0.0, 0.0, h * 0.995), d * 0.8)


def mug(form: Form) -> Iterator[Part]:
    """A cup with a handle to its left; dirty, it has a ring of coffee and a run down the side."""
    d, w, h = form.size_m
    glaze = form.pick(
        ((0.90, 0.90, 0.88), (0.20, 0.40, 0.70), (0.80, 0.25, 0.20), (0.25, 0.50, 0.35), (0.90, 0.70, 0.20))
    )
    y, thick = -(w - d) / 2.0, d * 0.14
    yield cylinder((0.0, y, h / 2.0), (d, d, h), glaze)
    yield cylinder((0.0, y, h * 0.997), (d * 0.84, d * 0.84, h * 0.01), shade(glaze, 0.45))
    yield box((0.0, w / 2.0 - thick / 2.0, h * 0.52), (thick, thick, h * 0.5), shade(glaze, 0.85))
    for z in (0.30, 0.74):
        yield box((0.0, w / 2.0 - (w - d) * 0.55, h * z), (thick, (w - d) * 1.1, h * 0.11), shade(glaze, 0.85))
    if form.dirty:
        yield cylinder((0.0, y, h * 0.998), (d * 0.8, d * 0.8, h * 0.012), STAIN)
        yield cylinder((0.0, y, h * 0.92), (d * 1.015, d * 1.015, h * 0.12), shade(STAIN, 1.3))
        yield box((d * 0.46, y, h * 0.62), (d * 0.12, d * 0.18, h * 0.55), STAIN)
        yield box((d * 0.30, y - d * 0.32, h * 0.68), (d * 0.22, d * 0.20, h * 0.42), STAIN)


def pan(form: Form) -> Iterator[Part]:
    """Flat and round, with one long handle to the front."""
    d, w, h = form.size_m
    iron = form.pick(DARK, 0.03)
    across = min(w, d * 0.7)
    x = -d / 2.0 + across / 2.0
    yield cylinder((x, 0.0, h * 0.45), (across * 0.9, across * 0.9, h * 0.9), iron, METAL)
    yield cylinder((x, 0.0, h * 0.75), (across, across, h * 0.5), iron, METAL)
    yield cylinder((x, 0.0, h * 0.995), (across * 0.9, across * 0.9, h * 0.02), shade(iron, 0.55))
    yield box((d / 2.0 - (d - across) / 2.0, 0.0, h * 0.8), (d - across + 0.02, 0.03, h * 0.3), BLACK)
    if form.dirty:
        yield from _stains((x, 0.0, h), across)


def pot(form: Form) -> Iterator[Part]:
    """Deep and round, with two ears."""
    d, w, h = form.size_m
    steel = form.pick(((0.66, 0.67, 0.69), (0.70, 0.18, 0.14), (0.20, 0.32, 0.45), (0.14, 0.14, 0.15)))
    across = min(d, w) * 0.84
    yield cylinder((0.0, 0.0, h * 0.47), (across, across, h * 0.94), steel, METAL)
    yield cylinder((0.0, 0.0, h * 0.965), (across * 1.06, across * 1.06, h * 0.06), shade(steel, 1.2), METAL)
    yield cylinder((0.0, 0.0, h * 0.995), (across * 0.94, across * 0.94, h * 0.012), shade(steel, 0.35))
    for side in (-1.0, 1.0):
        yield box((0.0, side * (across + w) / 4.0, h * 0.8), (across * 0.3, (w - across) / 2.0 + 0.01, h * 0.12), BLACK)
    if form.dirty:
        yield from _stains((0.0, 0.0, h), across)
        yield box((across * 0.46, 0.0, h * 0.7), (across * 0.1, across * 0.2, h * 0.5), STAIN)


def kettle(form: Form) -> Iterator[Part]:
    """Round-bellied with a spout to the front and a bow over the lid; open, the lid stands up at the back."""
    d, w, h = form.size_m
    steel = form.pick(((0.72, 0.73, 0.75), (0.75, 0.20, 0.16), (0.30, 0.50, 0.52)))
    yield cylinder((-0.02, 0.0, h * 0.10), (d * 0.78, w * 0.9, h * 0.2), shade(steel, 0.8), METAL)
    yield sphere((-0.02, 0.0, h * 0.36), (d * 0.80, w * 0.96, h * 0.68), steel, METAL)
    yield cylinder((d * 0.36, 0.0, h * 0.48), (0.035, 0.035, h * 0.45), steel, METAL, pitch=0.7)
    for side in (-1.0, 1.0):
        yield box((-0.02, side * w * 0.30, h * 0.76), (0.02, 0.015, h * 0.36), BLACK)
    yield box((-0.02, 0.0, h * 0.96), (0.03, w * 0.62, h * 0.08), BLACK)
    if form.open:
        yield cylinder((-0.02, 0.0, h * 0.69), (d * 0.46, w * 0.46, h * 0.06), (0.04, 0.04, 0.05))
        yield cylinder((-d * 0.34, 0.0, h * 0.86), (d * 0.46, w * 0.52, 0.014), shade(steel, 1.25), METAL, pitch=-1.25)
    else:
        yield cylinder((-0.02, 0.0, h * 0.69), (d * 0.42, w * 0.42, h * 0.06), shade(steel, 0.7), METAL)
        yield sphere((-0.02, 0.0, h * 0.75), (0.03, 0.03, 0.03), BLACK)


def knife(form: Form) -> Iterator[Part]:
    """Lying on its side: a wooden or black handle and a bright blade."""
    d, w, h = form.size_m
    handle = form.pick(((0.10, 0.10, 0.11), (0.45, 0.26, 0.14)))
    broad, thin = max(w, h), min(w, h)
    yield box((-d * 0.32, 0.0, thin * 0.5), (d * 0.36, broad * 0.55, thin), handle, WOOD)
    yield box((d * 0.12, 0.0, thin * 0.5), (d * 0.52, broad * 0.9, thin * 0.3), (0.86, 0.88, 0.90), METAL)
    yield box((d * 0.43, broad * 0.14, thin * 0.5), (d * 0.12, broad * 0.55, thin * 0.3), (0.86, 0.88, 0.90), METAL)
    for x in (-0.40, -0.28):
        yield cylinder((d * x, 0.0, thin * 0.98), (0.012, 0.012, 0.003), STEEL, METAL)


def wine_bottle(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    glass = form.pick(((0.06, 0.22, 0.09), (0.22, 0.06, 0.07), (0.12, 0.14, 0.08)), 0.03)
    yield cylinder((0.0, 0.0, h * 0.29), (d, w, h * 0.58), glass)
    yield sphere((0.0, 0.0, h * 0.58), (d, w, h * 0.24), glass)
    yield cylinder((0.0, 0.0, h * 0.80), (d * 0.36, w * 0.36, h * 0.36), glass)
    yield cylinder((0.0, 0.0, h * 0.93), (d * 0.42, w * 0.42, h * 0.14), (0.55, 0.08, 0.12))
    yield cylinder((0.0, 0.0, h * 0.32), (d * 1.0, w * 1.0, h * 0.26), (0.92, 0.88, 0.74))
    yield box((d * 0.48, 0.0, h * 0.34), (d * 0.06, w * 0.3, h * 0.10), (0.55, 0.12, 0.15))


def spray_bottle(form: Form) -> Iterator[Part]:
    """A trigger head on a bright bottle."""
    d, w, h = form.size_m
    liquid = form.pick(((0.20, 0.55, 0.90), (0.25, 0.78, 0.45), (0.95, 0.60, 0.15), (0.85, 0.30, 0.60)))
    body_w = max(w, d * 0.5)
    yield box((-d * 0.1, 0.0, h * 0.30), (d * 0.66, body_w, h * 0.60), liquid)
    yield box((d * 0.24, 0.0, h * 0.28), (0.004, body_w * 0.8, h * 0.3), (0.95, 0.95, 0.92))
    yield cylinder((-d * 0.1, 0.0, h * 0.68), (d * 0.3, body_w * 0.7, h * 0.18), liquid)
    yield box((0.0, 0.0, h * 0.90), (d * 0.8, w * 0.8, h * 0.16), (0.93, 0.93, 0.93))
    yield box((d * 0.42, 0.0, h * 0.92), (d * 0.14, w * 0.5, h * 0.08), (0.85, 0.15, 0.12))
    yield box((d * 0.22, 0.0, h * 0.74), (d * 0.07, w * 0.5, h * 0.18), (0.85, 0.15, 0.12), pitch=0.25)


DISHES: dict[str, Model] = {
    "Bowl": bowl,
    "Kettle": kettle,
    "Knife": knife,
    "Mug": mug,
    "Pan": pan,
    "Plate": plate,
    "Pot": pot,
    "SprayBottle": spray_bottle,
    "WineBottle": wine_bottle,
}
