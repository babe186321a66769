"""Lamps and candles: lit, the shade or the flame shines."""

from collections.abc import Iterator

from sim.models.form import BLACK, STEEL, Form, Model, box, cone, cylinder, shade, sphere
from sim.scene import Part, Rgb
from sim.textures import FABRIC, METAL

WARM: Rgb = (1.0, 0.90, 0.55)
SHADES: tuple[Rgb, ...] = ((0.55, 0.52, 0.46), (0.35, 0.42, 0.45), (0.58, 0.42, 0.32))
METALS: tuple[Rgb, ...] = ((0.15, 0.15, 0.16), STEEL, (0.55, 0.42, 0.20))
SHADE_STEPS = 6


def floor_lamp(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    metal, cloth = form.pick(METALS), form.pick(SHADES)
    yield cylinder((0.0, 0.0, 0.015), (d * 0.6, w * 0.6, 0.03), metal, METAL)
    yield cylinder((0.0, 0.0, h * 0.42), (0.035, 0.035, h * 0.84), metal, METAL)
    yield from _shade(form, h * 0.80, h * 0.20, cloth)


def desk_lamp(form: Form) -> Iterator[Part]:
    """Two kinds: a little table lamp, or a jointed arm with a metal hood."""
    d, w, h = form.size_m
    metal, cloth = form.pick(METALS), form.pick(SHADES)
    if form.chance.random() < 0.6:
        yield cylinder((0.0, 0.0, h * 0.03), (d * 0.6, w * 0.6, h * 0.06), metal, METAL)
        yield sphere((0.0, 0.0, h * 0.25), (d * 0.36, w * 0.36, h * 0.42), shade(cloth, 0.7))
        yield cylinder((0.0, 0.0, h * 0.48), (0.03, 0.03, h * 0.3), metal, METAL)
        yield from _shade(form, h * 0.54, h * 0.46, cloth)
        return
    bulb, glow = (WARM, 1.0) if form.on else ((0.50, 0.50, 0.47), 0.0)
    yield cylinder((-d * 0.2, 0.0, h * 0.03), (d * 0.55, w * 0.7, h * 0.06), metal, METAL)
    yield box((-d * 0.28, 0.0, h * 0.42), (0.025, 0.025, h * 0.8), metal, METAL, pitch=-0.10)
    yield box((-d * 0.05, 0.0, h * 0.86), (d * 0.6, 0.025, 0.025), metal, METAL, pitch=-0.12)
    # The hood is translucent: cameras look down on lamps and would not see the bulb.
    hood = (1.0, 0.80, 0.45) if form.on else metal
    yield cone((d * 0.24, 0.0, h * 0.83), (d * 0.5, w * 0.8, h * 0.30), hood, METAL, glow=glow * 0.8)
    yield cylinder((d * 0.24, 0.0, h * 0.675), (d * 0.42, w * 0.68, 0.012), bulb, glow=glow)
    yield sphere((d * 0.24, 0.0, h * 0.64), (d * 0.26, w * 0.36, h * 0.14), bulb, glow=glow)


def _shade(form: Form, bottom_m: float, height_m: float, cloth: Rgb) -> Iterator[Part]:
    """A shade of cloth that shines when the lamp is on."""
    d, w, _ = form.size_m
    lit, glow = (WARM, 1.0) if form.on else (cloth, 0.0)
    for k in range(SHADE_STEPS):
        wide, z = 1.0 - 0.3 * k / (SHADE_STEPS - 1), bottom_m + height_m * (k + 0.5) / SHADE_STEPS
        yield cylinder((0.0, 0.0, z), (d * wide, w * wide, height_m / SHADE_STEPS), lit, FABRIC, glow=glow)
    edge = (1.0, 1.0, 0.85) if form.on else shade(cloth, 0.6)
    yield cylinder((0.0, 0.0, bottom_m), (d * 0.9, w * 0.9, 0.004), edge, glow=glow)
    yield cylinder((0.0, 0.0, bottom_m + height_m), (d * 0.5, w * 0.5, 0.006), edge, glow=glow)


def candle(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    wax = form.pick(((0.93, 0.90, 0.80), (0.75, 0.20, 0.22), (0.55, 0.35, 0.60), (0.30, 0.50, 0.42)))
    yield cylinder((0.0, 0.0, h * 0.02), (d, w, h * 0.04), STEEL, METAL)
    yield cylinder((0.0, 0.0, h * 0.42), (d * 0.82, w * 0.82, h * 0.78), wax)
    yield cylinder((0.0, 0.0, h * 0.85), (d * 0.1, w * 0.1, h * 0.08), BLACK)
    if form.on:
        yield cylinder((0.0, 0.0, h * 0.76), (d * 0.83, w * 0.83, h * 0.12), (1.0, 0.82, 0.45), glow=0.9)
        yield sphere((0.0, 0.0, h * 0.91), (d * 0.45, w * 0.45, h * 0.14), (1.0, 0.72, 0.15), glow=1.0)
        yield cone((0.0, 0.0, h * 0.97), (d * 0.36, w * 0.36, h * 0.12), (1.0, 0.92, 0.45), glow=1.0)


LIGHTS: dict[str, Model] = {"Candle": candle, "DeskLamp": desk_lamp, "FloorLamp": floor_lamp}
