"""Things to sit or lie on."""

from collections.abc import Iterator

from sim.models.form import FABRICS, PAINTS, STAIN, WHITE, Form, Model, box, cylinder, legs, shade
from sim.models.surfaces import ARM_CHAIR_SEAT, BED_TOP, CHAIR_SEAT, SOFA_SEAT
from sim.scene import Part
from sim.textures import FABRIC, WOOD


def arm_chair(form: Form) -> Iterator[Part]:
    yield from _padded(form, form.pick(FABRICS), ARM_CHAIR_SEAT, 1)


def sofa(form: Form) -> Iterator[Part]:
    yield from _padded(form, form.pick(FABRICS), SOFA_SEAT, 3 if form.width_m > 2.1 else 2)


def _padded(form: Form, cloth: tuple[float, float, float], seat: float, cushions: int) -> Iterator[Part]:
    d, w, h = form.size_m
    arm_m, back_m, seat_m = 0.10 * d + 0.06, 0.22 * d, seat * h
    yield box((0.0, 0.0, seat_m * 0.35), (d * 0.96, w * 0.98, seat_m * 0.6), shade(cloth, 0.75), FABRIC)
    yield box((-d / 2.0 + back_m / 2.0, 0.0, h / 2.0 + 0.04), (back_m, w, h - 0.08), cloth, FABRIC)
    for side in (-1.0, 1.0):
        yield box((0.0, side * (w - arm_m) / 2.0, h * 0.36), (d, arm_m, h * 0.62), shade(cloth, 0.9), FABRIC)
    each_m = (w - 2.0 * arm_m) / cushions
    for k in range(cushions):
        y = (k - (cushions - 1) / 2.0) * each_m
        yield box((back_m / 2.0, y, seat_m - 0.07), (d - back_m, each_m - 0.015, 0.14), shade(cloth, 1.12), FABRIC)
        yield box(
            (-d / 2.0 + back_m + 0.05, y, h * 0.68),
            (0.10, each_m - 0.03, h * 0.42),
            shade(cloth, 1.05),
            FABRIC,
            pitch=-0.15,
        )


def chair(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    frame, seat_m = form.pick(PAINTS), CHAIR_SEAT * h
    padded = form.chance.random() < 0.5
    seat = form.pick(FABRICS) if padded else frame
    yield from legs(form.size_m, seat_m - 0.03, 0.04, frame, WOOD)
    yield box((0.0, 0.0, seat_m - 0.025), (d, w, 0.05), seat, FABRIC if padded else WOOD)
    for side in (-1.0, 1.0):
        yield box(
            (-d / 2.0 + 0.025, side * (w / 2.0 - 0.025), (seat_m + h) / 2.0), (0.04, 0.04, h - seat_m), frame, WOOD
        )
    for z in (0.62, 0.9):
        yield box((-d / 2.0 + 0.025, 0.0, seat_m + (h - seat_m) * z), (0.03, w - 0.05, 0.2 * (h - seat_m)), frame, WOOD)


def bed(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    frame, cover = form.pick(PAINTS), form.pick(FABRICS)
    top_m = BED_TOP * h
    yield box((-d / 2.0 + 0.04, 0.0, h / 2.0), (0.08, w, h), frame, WOOD)
    yield box((0.0, 0.0, top_m * 0.32), (d - 0.02, w * 0.99, top_m * 0.4), frame, WOOD)
    yield box((0.03, 0.0, top_m * 0.72), (d - 0.12, w * 0.96, top_m * 0.5), WHITE, FABRIC)
    yield box((d * 0.16, 0.0, top_m * 0.73), (d * 0.66, w * 0.99, top_m * 0.54), cover, FABRIC)
    yield box((-d * 0.18, 0.0, top_m * 0.985), (d * 0.08, w * 0.99, top_m * 0.06), shade(cover, 1.35), FABRIC)
    if form.dirty:
        for x, y, r in ((0.12, -0.2, 0.42), (0.30, 0.22, 0.34), (0.02, 0.28, 0.24), (0.36, -0.26, 0.22)):
            yield cylinder((d * x, w * y, top_m + 0.003), (r, r * 0.8, 0.006), STAIN)


SEATING: dict[str, Model] = {"ArmChair": arm_chair, "Bed": bed, "Chair": chair, "Sofa": sofa}
