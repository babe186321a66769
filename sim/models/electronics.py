"""Screens and gadgets. Off, a screen is dark glass; on, it shows a bright picture."""

from collections.abc import Iterator

from sim.models.form import BLACK, GLASS, STEEL, WHITE, Form, Model, box, cylinder, shade
from sim.scene import Part, Rgb
from sim.textures import METAL, PAGES, SCREEN

BARS: tuple[Rgb, ...] = (
    (0.95, 0.95, 0.95),
    (0.95, 0.90, 0.10),
    (0.10, 0.85, 0.90),
    (0.15, 0.80, 0.20),
    (0.90, 0.15, 0.70),
    (0.90, 0.12, 0.12),
)


def television(form: Form) -> Iterator[Part]:
    """A flat screen on a foot. On: a picture, for some looks with a bright band of colours below it."""
    d, w, h = form.size_m
    frame = form.pick(((0.06, 0.06, 0.07), (0.16, 0.16, 0.17)), 0.03)
    foot_m, thick_m = 0.09 * h, min(0.07, d * 0.4)
    bars = form.chance.random() < 0.5
    yield box((0.0, 0.0, 0.01), (d, w * 0.45, 0.02), shade(frame, 1.5))
    yield box((0.0, 0.0, foot_m / 2.0 + 0.01), (0.05, w * 0.12, foot_m), frame)
    middle = (h + foot_m) / 2.0
    yield box((0.0, 0.0, middle), (thick_m, w, h - foot_m), frame)
    x, glass_h = thick_m / 2.0 + 0.003, h - foot_m - 0.05
    if not form.on:
        yield box((x, 0.0, middle), (0.008, w - 0.05, glass_h), GLASS)
        yield box((x + 0.003, w * 0.18, middle + glass_h * 0.1), (0.006, w * 0.05, glass_h * 0.7), (0.11, 0.12, 0.14))
        return
    yield box((x, 0.0, middle), (0.008, w - 0.05, glass_h), (1.0, 1.0, 1.0), SCREEN, glow=1.0)
    for k, colour in enumerate(BARS if bars else ()):
        y = (k - 2.5) * (w - 0.06) / len(BARS)
        yield box((x + 0.003, y, middle - glass_h * 0.42), (0.006, w / len(BARS), glass_h * 0.14), colour, glow=1.0)


def laptop(form: Form) -> Iterator[Part]:
    """Lid up or down; running, the screen shows windows."""
    d, w, h = form.size_m
    skin = form.pick(((0.70, 0.71, 0.73), (0.25, 0.26, 0.28), (0.55, 0.56, 0.60)), 0.03)
    base_d = d * 0.86
    yield box((d * 0.07, 0.0, 0.009), (base_d, w, 0.018), skin, METAL)
    if not form.open:
        yield box((d * 0.07, 0.0, 0.024), (base_d, w, 0.012), shade(skin, 0.92), METAL)
        yield cylinder((d * 0.07, 0.0, 0.031), (0.05, 0.05, 0.003), shade(skin, 1.3))
        light = (0.2, 0.6, 1.0) if form.on else (0.10, 0.10, 0.10)
        yield box((d * 0.07 + base_d / 2.0, 0.0, 0.012), (0.005, 0.03, 0.006), light, glow=float(form.on))
        return
    yield box((d * 0.02, 0.0, 0.0195), (base_d * 0.5, w * 0.88, 0.004), BLACK)
    yield box((d * 0.36, 0.0, 0.0195), (base_d * 0.28, w * 0.32, 0.003), shade(skin, 0.8))
    lid_h, lean = h - 0.02, -0.16
    yield box((-d * 0.40, 0.0, 0.02 + lid_h * 0.49), (0.012, w, lid_h * 0.98), skin, METAL, pitch=lean)
    shown: Rgb = (0.30, 0.55, 0.95) if form.on else GLASS
    glow = 0.9 if form.on else 0.0
    yield box(
        (-d * 0.40 + 0.008, 0.0, 0.02 + lid_h * 0.50), (0.004, w * 0.94, lid_h * 0.86), shown, pitch=lean, glow=glow
    )
    if form.on:
        yield box(
            (-d * 0.40 + 0.011, w * 0.12, 0.02 + lid_h * 0.52),
            (0.004, w * 0.56, lid_h * 0.62),
            WHITE,
            PAGES,
            pitch=lean,
            glow=glow,
        )
        yield box(
            (-d * 0.40 + 0.011, -w * 0.31, 0.02 + lid_h * 0.55),
            (0.004, w * 0.22, lid_h * 0.5),
            (0.95, 0.55, 0.15),
            pitch=lean,
            glow=glow,
        )


def cell_phone(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    skin = form.pick(((0.08, 0.08, 0.09), (0.75, 0.60, 0.55), (0.20, 0.30, 0.50)), 0.03)
    yield box((0.0, 0.0, h * 0.4), (d, w, h * 0.8), skin)
    yield box(
        (0.0, 0.0, h * 0.85),
        (d * 0.92, w * 0.92, h * 0.2),
        (0.25, 0.65, 1.0) if form.on else GLASS,
        glow=float(form.on),
    )
    for row in range(3):
        for side in (-1.0, 0.0, 1.0):
            icon = BARS[row + 1] if form.on else (0.10, 0.11, 0.12)
            yield box(
                (d * (0.22 - 0.18 * row), side * w * 0.26, h * 0.96),
                (d * 0.10, w * 0.18, h * 0.06),
                icon,
                glow=float(form.on),
            )


def remote_control(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    skin = form.pick(((0.08, 0.08, 0.09), (0.25, 0.26, 0.28)), 0.03)
    yield box((0.0, 0.0, h * 0.42), (d, w, h * 0.84), skin)
    yield cylinder((d * 0.40, w * 0.22, h * 0.9), (w * 0.3, w * 0.3, h * 0.2), (0.85, 0.10, 0.10))
    yield cylinder((d * 0.16, 0.0, h * 0.9), (w * 0.72, w * 0.72, h * 0.2), (0.75, 0.76, 0.78))
    for row in range(3):
        for side in (-1.0, 0.0, 1.0):
            yield box(
                (-d * (0.05 + 0.13 * row), side * w * 0.28, h * 0.9), (d * 0.07, w * 0.2, h * 0.2), (0.70, 0.71, 0.73)
            )


def alarm_clock(form: Form) -> Iterator[Part]:
    """A round face between two bells on two feet."""
    d, w, h = form.size_m
    skin = form.pick(((0.75, 0.15, 0.15), (0.20, 0.45, 0.60), (0.85, 0.75, 0.30), (0.12, 0.12, 0.13)))
    dial = min(w, h * 0.84)
    yield Part("cylinder", (0.0, 0.0, h * 0.46), (dial, dial, d * 0.8), skin, pitch_rad=1.5707963)
    yield Part("cylinder", (d * 0.42, 0.0, h * 0.46), (dial * 0.84, dial * 0.84, d * 0.1), WHITE, pitch_rad=1.5707963)
    yield box((d * 0.48, 0.0, h * 0.55), (d * 0.04, dial * 0.06, dial * 0.32), BLACK)
    yield box((d * 0.48, dial * 0.11, h * 0.46), (d * 0.04, dial * 0.26, dial * 0.06), BLACK)
    for side in (-1.0, 1.0):
        yield Part(
            "sphere", (0.0, side * dial * 0.30, h * 0.87), (d * 0.7, dial * 0.42, h * 0.24), STEEL, texture=METAL
        )
        yield cylinder((0.0, side * dial * 0.32, h * 0.07), (d * 0.25, d * 0.25, h * 0.14), STEEL, METAL)
    yield box((0.0, 0.0, h * 0.95), (d * 0.2, dial * 0.1, h * 0.1), BLACK)


ELECTRONICS: dict[str, Model] = {
    "AlarmClock": alarm_clock,
    "CellPhone": cell_phone,
    "Laptop": laptop,
    "RemoteControl": remote_control,
    "Television": television,
}
