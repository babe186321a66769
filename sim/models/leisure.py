"""Books, balls, plants, pictures and other things for looking at or leaning on."""

from collections.abc import Iterator
from math import cos, pi, sin

from sim.models.form import FABRICS, WOODS, Form, Model, box, cone, cylinder, shade, sphere
from sim.scene import Part, Rgb
from sim.textures import FABRIC, LEAVES, PAGES, WOOD

COVERS: tuple[Rgb, ...] = (
    (0.70, 0.12, 0.14),
    (0.12, 0.25, 0.55),
    (0.10, 0.42, 0.25),
    (0.85, 0.60, 0.12),
    (0.35, 0.15, 0.40),
)
PAPER: Rgb = (0.95, 0.93, 0.86)


def book(form: Form) -> Iterator[Part]:
    """Lying; closed it shows its cover, open it shows two white pages."""
    d, w, h = form.size_m
    cover = form.pick(COVERS)
    if form.open:
        for side in (-1.0, 1.0):
            yield box((0.0, side * w / 2.0, h * 0.12), (d, w, h * 0.2), cover)
            yield box((0.0, side * w * 0.49, h * 0.42), (d * 0.95, w * 0.93, h * 0.5), PAPER, PAGES)
        yield box((0.0, 0.0, h * 0.45), (d * 0.95, w * 0.04, h * 0.5), (0.45, 0.42, 0.38))
        return
    yield box((0.0, 0.0, h * 0.06), (d, w, h * 0.12), cover)
    yield box((0.0, -w * 0.02, h * 0.5), (d * 0.95, w * 0.94, h * 0.78), PAPER)
    yield box((0.0, 0.0, h * 0.94), (d, w, h * 0.12), cover)
    yield box((0.0, w * 0.485, h * 0.5), (d, w * 0.03, h), shade(cover, 0.8))
    yield box((-d * 0.2, 0.0, h * 0.995), (d * 0.12, w * 0.6, h * 0.02), (0.95, 0.88, 0.55))
    yield box((d * 0.14, 0.0, h * 0.995), (d * 0.3, w * 0.5, h * 0.02), shade(cover, 1.6))


def newspaper(form: Form) -> Iterator[Part]:
    """Folded: grey paper, a headline and columns of print."""
    d, w, h = form.size_m
    paper = form.pick(((0.84, 0.83, 0.80), (0.80, 0.79, 0.73)), 0.02)
    yield box((0.0, 0.0, h * 0.25), (d, w, h * 0.46), shade(paper, 0.92))
    yield box((0.01 * d, 0.0, h * 0.74), (d * 0.98, w * 0.985, h * 0.44), paper, PAGES)
    yield box((-d * 0.38, 0.0, h * 0.975), (d * 0.14, w * 0.86, h * 0.04), (0.10, 0.10, 0.11))
    yield box((d * 0.06, -w * 0.26, h * 0.975), (d * 0.44, w * 0.32, h * 0.04), (0.42, 0.44, 0.46))
    for y in (0.04, 0.20, 0.36):
        yield box((d * 0.10, w * y, h * 0.975), (d * 0.62, w * 0.11, h * 0.03), (0.62, 0.61, 0.59))


def basket_ball(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    skin = form.pick(((0.88, 0.42, 0.12), (0.80, 0.36, 0.12)), 0.03)
    yield sphere((0.0, 0.0, h / 2.0), (d * 0.985, w * 0.985, h * 0.985), skin)
    seam = (0.08, 0.06, 0.05)
    yield cylinder((0.0, 0.0, h / 2.0), (d, w, h * 0.035), seam)
    yield cylinder((0.0, 0.0, h / 2.0), (d, w, h * 0.035), seam, pitch=pi / 2.0)
    yield cylinder((0.0, 0.0, h / 2.0), (d, w, h * 0.035), seam, yaw=pi / 2.0, pitch=pi / 2.0)


def teddy_bear(form: Form) -> Iterator[Part]:
    """Sitting, facing forward."""
    d, w, h = form.size_m
    fur = form.pick(((0.62, 0.42, 0.24), (0.75, 0.58, 0.38), (0.45, 0.30, 0.20)))
    light, dark = shade(fur, 1.4), (0.06, 0.04, 0.04)
    yield sphere((-d * 0.08, 0.0, h * 0.32), (d * 0.66, w * 0.56, h * 0.60), fur, FABRIC)
    yield sphere((d * 0.08, 0.0, h * 0.30), (d * 0.42, w * 0.38, h * 0.40), light, FABRIC)
    yield sphere((0.0, 0.0, h * 0.74), (d * 0.60, w * 0.50, h * 0.44), fur, FABRIC)
    yield sphere((d * 0.26, 0.0, h * 0.69), (d * 0.28, w * 0.22, h * 0.18), light, FABRIC)
    yield sphere((d * 0.38, 0.0, h * 0.72), (d * 0.08, w * 0.08, h * 0.06), dark)
    for side in (-1.0, 1.0):
        yield sphere((0.0, side * w * 0.20, h * 0.93), (d * 0.18, w * 0.17, h * 0.15), fur, FABRIC)
        yield sphere((d * 0.28, side * w * 0.10, h * 0.80), (d * 0.06, w * 0.05, h * 0.05), dark)
        yield sphere((d * 0.08, side * w * 0.36, h * 0.38), (d * 0.40, w * 0.24, h * 0.20), fur, FABRIC)
        yield sphere((d * 0.26, side * w * 0.24, h * 0.12), (d * 0.46, w * 0.26, h * 0.24), fur, FABRIC)


def pillow(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    cloth = form.pick((*FABRICS, (0.93, 0.92, 0.90), (0.85, 0.65, 0.25)))
    yield box((0.0, 0.0, h * 0.42), (d * 0.9, w * 0.9, h * 0.40), cloth, FABRIC)
    yield sphere((0.0, 0.0, h * 0.5), (d * 0.98, w * 0.98, h), cloth, FABRIC)
    yield box((0.0, 0.0, h * 0.42), (d, w, h * 0.08), shade(cloth, 0.7), FABRIC)
    yield cylinder((0.0, 0.0, h * 0.985), (0.04, 0.04, 0.008), shade(cloth, 0.6))


def painting(form: Form) -> Iterator[Part]:
    """A frame with a landscape."""
    d, w, h = form.size_m
    frame = form.pick(WOODS)
    sky, land = (
        form.pick(((0.55, 0.72, 0.88), (0.90, 0.65, 0.45), (0.75, 0.80, 0.78))),
        form.pick(((0.30, 0.48, 0.25), (0.62, 0.52, 0.30), (0.20, 0.35, 0.45))),
    )
    sun_y = form.chance.uniform(-0.25, 0.25)
    yield box((-d * 0.1, 0.0, h / 2.0), (d * 0.8, w, h), frame, WOOD)
    yield box((d * 0.32, 0.0, h / 2.0), (d * 0.1, w - 0.10, h - 0.10), (0.94, 0.92, 0.87))
    yield box((d * 0.38, 0.0, h / 2.0), (d * 0.1, w - 0.20, h - 0.20), sky)
    yield box((d * 0.42, 0.0, h * 0.32), (d * 0.1, w - 0.20, h * 0.64 - 0.20), land)
    yield cylinder((d * 0.42, w * sun_y, h * 0.68), (h * 0.16, h * 0.16, d * 0.1), (0.98, 0.90, 0.50), pitch=pi / 2.0)
    yield box((d * 0.45, w * 0.12, h * 0.40), (d * 0.08, w * 0.16, h * 0.26), shade(land, 0.6))


def house_plant(form: Form) -> Iterator[Part]:
    """A pot of earth and a bush of leaves."""
    d, w, h = form.size_m
    clay = form.pick(((0.70, 0.38, 0.25), (0.88, 0.87, 0.84), (0.30, 0.33, 0.36)))
    leaf = form.pick(((0.18, 0.42, 0.16), (0.25, 0.50, 0.20), (0.14, 0.36, 0.20)))
    pot_m = h * 0.34
    yield cylinder((0.0, 0.0, pot_m * 0.45), (d * 0.56, w * 0.56, pot_m * 0.9), clay)
    yield cylinder((0.0, 0.0, pot_m * 0.92), (d * 0.66, w * 0.66, pot_m * 0.16), shade(clay, 0.9))
    yield cylinder((0.0, 0.0, pot_m * 1.0), (d * 0.56, w * 0.56, 0.008), (0.18, 0.12, 0.08))
    yield cylinder((0.0, 0.0, h * 0.48), (d * 0.07, w * 0.07, h * 0.36), (0.35, 0.25, 0.15))
    yield sphere((0.0, 0.0, h * 0.72), (d * 0.66, w * 0.66, h * 0.50), leaf, LEAVES)
    for k in range(5):
        angle = 2.0 * pi * k / 5.0 + 0.3
        centre = (d * 0.27 * cos(angle), w * 0.27 * sin(angle), h * (0.58 + 0.07 * (k % 3)))
        yield sphere(centre, (d * 0.44, w * 0.40, h * 0.30), shade(leaf, 0.8 + 0.25 * (k % 3)), LEAVES, yaw=angle)
    yield cone((0.0, 0.0, h * 0.89), (d * 0.4, w * 0.4, h * 0.22), shade(leaf, 1.3), LEAVES)


LEISURE: dict[str, Model] = {
    "BasketBall": basket_ball,
    "Book": book,
    "HousePlant": house_plant,
    "Newspaper": newspaper,
    "Painting": painting,
    "Pillow": pillow,
    "TeddyBear": teddy_bear,
}
