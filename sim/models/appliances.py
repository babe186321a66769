"""Kitchen and bathroom appliances: what opens and what runs."""

from collections.abc import Iterator
from math import cos, pi, sin

from sim.models.form import BLACK, GLASS, STEEL, WHITE, Form, Model, box, cylinder, hollow, shade, sphere, tray
from sim.models.surfaces import COFFEE_TRAY, FRIDGE_SHELVES, TOILET_SEAT, sink_floor_m
from sim.scene import Part, Rgb
from sim.textures import METAL, PLAIN

FRIDGES: tuple[Rgb, ...] = (
    (0.90, 0.91, 0.92),
    (0.66, 0.68, 0.70),
    (0.30, 0.31, 0.33),
    (0.75, 0.20, 0.17),
    (0.62, 0.78, 0.76),
)
APPLIANCES: tuple[Rgb, ...] = ((0.18, 0.18, 0.19), (0.72, 0.73, 0.74), (0.90, 0.90, 0.88))
LIT: Rgb = (1.0, 0.95, 0.80)
DOOR_M = 0.06
SWING_RAD = 105.0 * pi / 180.0


def swung_door(form: Form, bottom_m: float, height_m: float, thick_m: float, rgb: Rgb, texture: int = PLAIN) -> Part:
    """A door hinged at the left edge of the front, standing open."""
    d, w, _ = form.size_m
    ahead, aside = sin(SWING_RAD), -cos(SWING_RAD)
    centre = (d / 2.0 - thick_m / 2.0 + ahead * w / 2.0, w / 2.0 + aside * w / 2.0, bottom_m + height_m / 2.0)
    return box(centre, (w, thick_m, height_m), rgb, texture, yaw=SWING_RAD - pi / 2.0)


def fridge(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    skin = form.pick(FRIDGES, 0.03)
    split_m = h * 0.67
    if form.open:
        yield from (_back(part) for part in hollow((d - DOOR_M, w, h), 0.045, skin, WHITE, METAL))
        yield box((-d / 2.0 + DOOR_M, 0.0, h / 2.0), (0.02, w - 0.12, h - 0.14), LIT, glow=0.7)
        for part in FRIDGE_SHELVES:
            yield box((-DOOR_M / 2.0, 0.0, h * part - 0.01), (d * 0.72, w - 0.09, 0.02), (0.80, 0.90, 0.95), glow=0.35)
        yield swung_door(form, 0.0, h, DOOR_M, skin, METAL)
        return
    yield box((-DOOR_M / 2.0, 0.0, h / 2.0), (d - DOOR_M, w, h), shade(skin, 0.85), METAL)
    yield box((d / 2.0 - DOOR_M / 2.0, 0.0, split_m / 2.0 + 0.03), (DOOR_M, w, split_m - 0.07), skin, METAL)
    yield box((d / 2.0 - DOOR_M / 2.0, 0.0, (split_m + h) / 2.0), (DOOR_M, w, h - split_m - 0.02), skin, METAL)
    for low, high in ((h * 0.36, h * 0.62), (h * 0.71, h * 0.90)):
        yield box((d / 2.0 + 0.012, -w * 0.40, (low + high) / 2.0), (0.03, 0.03, high - low), shade(STEEL, 0.6), METAL)
    yield box((-DOOR_M, 0.0, 0.02), (d * 0.8, w * 0.9, 0.04), BLACK)


def _back(part: Part) -> Part:
    """Moved back by the thickness of the door."""
    x, y, z = part.centre_m
    return Part(part.shape, (x - DOOR_M / 2.0, y, z), part.size_m, part.rgb, texture=part.texture)


def microwave(form: Form) -> Iterator[Part]:
    """Door to the left, panel with its clock to the right; running, the window and the panel shine."""
    d, w, h = form.size_m
    skin = form.pick(APPLIANCES)
    panel_y, glass_y, glass_w = -w * 0.39, w * 0.10, w * 0.62
    if form.open:
        yield from hollow((d - 0.03, w, h), 0.025, skin, (0.86, 0.84, 0.76))
        yield box((d / 2.0 - 0.02, panel_y, h / 2.0), (0.03, w * 0.22, h), BLACK)
        yield swung_door(form, 0.01, h - 0.02, 0.03, shade(skin, 0.8))
    else:
        yield box((-0.015, 0.0, h / 2.0), (d - 0.03, w, h), skin)
        yield box((d / 2.0 - 0.02, w * 0.11, h / 2.0), (0.03, w * 0.78, h * 0.98), shade(skin, 0.9))
        glow = 0.9 if form.on else 0.0
        yield box(
            (d / 2.0 - 0.004, glass_y, h * 0.52),
            (0.008, glass_w, h * 0.62),
            (1.0, 0.75, 0.25) if form.on else GLASS,
            glow=glow,
        )
        yield box((d / 2.0 + 0.004, -w * 0.255, h / 2.0), (0.03, 0.025, h * 0.75), STEEL, METAL)
        yield box((d / 2.0 - 0.02, panel_y, h / 2.0), (0.03, w * 0.22, h * 0.98), BLACK)
    clock = (0.30, 1.0, 0.55) if form.on else (0.05, 0.16, 0.10)
    yield box((d / 2.0 - 0.002, panel_y, h * 0.80), (0.006, w * 0.15, h * 0.14), clock, glow=1.0 if form.on else 0.0)
    for row in range(3):
        yield box((d / 2.0 - 0.002, panel_y, h * (0.22 + 0.15 * row)), (0.006, w * 0.14, h * 0.08), (0.45, 0.46, 0.48))


def coffee_machine(form: Form) -> Iterator[Part]:
    """A tower with a head over a tray; running, a red lamp, a lit display and coffee falling."""
    d, w, h = form.size_m
    skin = form.pick(((0.10, 0.10, 0.11), (0.60, 0.61, 0.63), (0.62, 0.10, 0.10)))
    tray_m = h * COFFEE_TRAY
    yield box((0.0, 0.0, tray_m / 2.0), (d, w * 0.9, tray_m), shade(skin, 0.7))
    yield box((d * 0.22, 0.0, tray_m), (d * 0.5, w * 0.7, 0.008), STEEL, METAL)
    yield box((-d * 0.28, 0.0, h / 2.0), (d * 0.42, w * 0.9, h), skin)
    yield box((d * 0.1, 0.0, h * 0.82), (d * 0.7, w * 0.9, h * 0.34), skin)
    yield cylinder((d * 0.22, 0.0, h * 0.61), (0.06, 0.06, h * 0.10), STEEL, METAL)
    yield cylinder((-d * 0.25, w * 0.3, h * 0.97), (w * 0.2, w * 0.2, h * 0.05), STEEL, METAL)
    lamp, face = ((1.0, 0.15, 0.10), (0.35, 0.85, 1.0)) if form.on else ((0.25, 0.05, 0.05), (0.06, 0.09, 0.11))
    glow = 1.0 if form.on else 0.0
    yield box((d * 0.452, 0.0, h * 0.85), (0.01, w * 0.5, h * 0.16), face, glow=glow)
    yield sphere((d * 0.45, w * 0.33, h * 0.85), (0.05, 0.05, 0.05), lamp, glow=glow)
    if form.on:
        yield cylinder((d * 0.22, 0.0, h * 0.34), (0.035, 0.035, h * 0.44), (0.30, 0.15, 0.05), glow=0.2)


def toaster(form: Form) -> Iterator[Part]:
    """Running, its slots glow and the lever is down."""
    d, w, h = form.size_m
    skin = form.pick(((0.75, 0.76, 0.78), (0.78, 0.16, 0.13), (0.15, 0.15, 0.16), (0.55, 0.75, 0.72)))
    yield box((0.0, 0.0, 0.01), (d * 0.94, w * 0.9, 0.02), BLACK)
    yield box((0.0, 0.0, h * 0.48), (d * 0.96, w, h * 0.84), skin, METAL)
    yield box((0.0, 0.0, h * 0.93), (d * 0.90, w * 0.84, h * 0.12), shade(skin, 0.9), METAL)
    for side in (-1.0, 1.0):
        slot = (1.0, 0.42, 0.08) if form.on else BLACK
        yield box((0.0, side * w * 0.18, h * 0.985), (d * 0.76, w * 0.16, h * 0.03), slot, glow=1.0 if form.on else 0.0)
    yield box((d * 0.485, 0.0, h * (0.30 if form.on else 0.70)), (d * 0.04, w * 0.25, h * 0.10), BLACK)
    yield sphere(
        (d * 0.485, w * 0.3, h * 0.3),
        (0.04, 0.04, 0.04),
        (1.0, 0.35, 0.1) if form.on else (0.2, 0.2, 0.2),
        glow=float(form.on),
    )


def sink(form: Form) -> Iterator[Part]:
    """A basin with a tap; low ones stand on a counter, tall ones on a pedestal."""
    d, w, h = form.size_m
    stone = WHITE if h > 0.5 else form.pick(((0.93, 0.93, 0.92), (0.66, 0.68, 0.70)), 0.03)
    texture = METAL if stone[0] < 0.8 else PLAIN
    floor_m = sink_floor_m(h) - 0.02
    rim_m = floor_m + 0.14
    if h > 0.5:
        yield cylinder((-0.05, 0.0, floor_m / 2.0), (0.22, 0.24, floor_m), stone)
        yield box((0.0, 0.0, floor_m - 0.03), (d * 0.6, w * 0.6, 0.08), stone)
    yield from tray((d, w, rim_m - floor_m), floor_m, 0.035, stone, shade(stone, 0.82), texture)
    yield box((-d / 2.0 + 0.055, 0.0, rim_m - 0.01), (0.11, w, 0.02), stone, texture)
    yield cylinder((0.05, 0.0, floor_m + 0.036), (0.06, 0.06, 0.004), BLACK)
    tap = (-d / 2.0 + 0.05, 0.0, (rim_m + h) / 2.0)
    yield cylinder(tap, (0.035, 0.035, max(0.02, h - rim_m)), STEEL, METAL)
    yield box((-d / 2.0 + 0.13, 0.0, h - 0.015), (0.18, 0.03, 0.03), STEEL, METAL)


def toilet(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    stone = form.pick(((0.95, 0.95, 0.94), (0.90, 0.88, 0.82)), 0.02)
    seat_m = TOILET_SEAT * h
    yield box((-d * 0.39, 0.0, h * 0.68), (d * 0.2, w * 0.9, h * 0.58), stone)
    yield box((-d * 0.39, 0.0, h - 0.015), (d * 0.22, w * 0.94, 0.03), shade(stone, 0.96))
    yield cylinder((d * 0.02, 0.0, seat_m * 0.45), (d * 0.5, w * 0.6, seat_m * 0.9), stone)
    yield sphere((d * 0.14, 0.0, seat_m * 0.78), (d * 0.7, w * 0.96, seat_m * 0.42), stone)
    yield cylinder((d * 0.14, 0.0, seat_m - 0.02), (d * 0.68, w * 0.94, 0.03), shade(stone, 0.9))
    if form.open:
        yield cylinder((d * 0.16, 0.0, seat_m - 0.004), (d * 0.5, w * 0.64, 0.006), (0.25, 0.40, 0.50))
        yield box((-d * 0.25, 0.0, seat_m + d * 0.30), (0.03, w * 0.84, d * 0.58), shade(stone, 0.86), pitch=-0.12)
    else:
        yield cylinder((d * 0.14, 0.0, seat_m + 0.012), (d * 0.68, w * 0.94, 0.03), shade(stone, 1.02))
    yield cylinder((-d * 0.39, 0.0, h - 0.001), (0.05, 0.05, 0.012), STEEL, METAL)


APPLIANCE_MODELS: dict[str, Model] = {
    "CoffeeMachine": coffee_machine,
    "Fridge": fridge,
    "Microwave": microwave,
    "Sink": sink,
    "Toaster": toaster,
    "Toilet": toilet,
}
