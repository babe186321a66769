"""Food, whole and cut into slices that lie apart."""

from collections.abc import Iterator
from math import cos, pi, sin, sqrt

from sim.models.form import Form, Model, box, cone, cylinder, shade, sphere
from sim.scene import Part, Rgb
from sim.textures import LEAVES


def _slices(form: Form, count: int, skin: Rgb, flesh: Rgb, squareness: float = 0.0) -> Iterator[Part]:
    """Upright rounds along x with gaps between them, flesh on both faces. `squareness` 1 is a loaf, 0 a ball."""
    d, w, h = form.size_m
    pitch_m = d / count
    thick_m = pitch_m * 0.5
    for k in range(count):
        along = (k + 0.5) / count * 2.0 - 1.0
        across = max(squareness, sqrt(1.0 - 0.8 * along * along))
        x, z = along * d / 2.0, h * across / 2.0
        yield cylinder((x, 0.0, z), (h * across, w * across, thick_m), skin, pitch=pi / 2.0)
        yield cylinder((x, 0.0, z), (h * across * 0.86, w * across * 0.86, thick_m * 1.12), flesh, pitch=pi / 2.0)


def apple(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    skin = form.pick(((0.85, 0.10, 0.12), (0.45, 0.75, 0.15), (0.80, 0.16, 0.10)))
    if form.sliced:
        yield from _slices(form, 4, skin, (0.97, 0.93, 0.72))
        return
    yield sphere((0.0, 0.0, h * 0.44), (d, w, h * 0.88), skin)
    yield sphere((d * 0.1, 0.0, h * 0.52), (d * 0.86, w * 0.86, h * 0.72), shade(skin, 1.15))
    yield cylinder((0.0, 0.0, h * 0.9), (d * 0.08, w * 0.08, h * 0.2), (0.30, 0.18, 0.08))
    yield sphere((d * 0.14, 0.0, h * 0.93), (d * 0.34, w * 0.16, h * 0.07), (0.20, 0.55, 0.15), LEAVES)


def tomato(form: Form) -> Iterator[Part]:
    """Flatter than an apple, deep red, with a green star."""
    d, w, h = form.size_m
    skin = form.pick(((0.80, 0.07, 0.04), (0.88, 0.16, 0.05)), 0.04)
    if form.sliced:
        yield from _slices(form, 5, skin, (0.95, 0.42, 0.30))
        return
    yield sphere((0.0, 0.0, h * 0.46), (d, w, h * 0.92), skin)
    for k in range(3):
        yield box((0.0, 0.0, h * 0.92), (d * 0.56, w * 0.10, h * 0.05), (0.15, 0.50, 0.12), yaw=k * pi / 3.0)
    yield cylinder((0.0, 0.0, h * 0.95), (d * 0.08, w * 0.08, h * 0.1), (0.15, 0.45, 0.12))


def potato(form: Form) -> Iterator[Part]:
    d, w, h = form.size_m
    skin = form.pick(((0.62, 0.46, 0.28), (0.70, 0.55, 0.34), (0.55, 0.38, 0.25)))
    if form.sliced:
        yield from _slices(form, 5, skin, (0.95, 0.88, 0.60))
        return
    yield sphere((0.0, 0.0, h * 0.5), (d, w, h), skin)
    yield sphere((d * 0.16, w * 0.04, h * 0.5), (d * 0.64, w * 0.90, h * 0.94), shade(skin, 1.06))
    for x, y, z in ((0.30, 0.2, 0.80), (-0.1, -0.25, 0.88), (-0.28, 0.15, 0.80), (0.1, 0.32, 0.80)):
        yield sphere((d * x, w * y, h * z), (d * 0.08, w * 0.10, h * 0.08), shade(skin, 0.5))


def lettuce(form: Form) -> Iterator[Part]:
    """A head of ruffled leaves."""
    d, w, h = form.size_m
    leaf = form.pick(((0.35, 0.65, 0.20), (0.45, 0.72, 0.28), (0.28, 0.55, 0.18)))
    if form.sliced:
        yield from _slices(form, 5, leaf, (0.85, 0.93, 0.60))
        return
    yield sphere((0.0, 0.0, h * 0.48), (d * 0.82, w * 0.92, h * 0.9), shade(leaf, 1.2), LEAVES)
    for k in range(6):
        angle = k * pi / 3.0
        centre = (d * 0.24 * cos(angle), w * 0.24 * sin(angle), h * (0.46 + 0.12 * (k % 2)))
        yield sphere(centre, (d * 0.5, w * 0.5, h * 0.74), shade(leaf, 0.75 + 0.12 * (k % 3)), LEAVES, yaw=angle)
    yield cylinder((-d * 0.45, 0.0, h * 0.42), (h * 0.26, w * 0.26, d * 0.1), (0.88, 0.92, 0.75), pitch=pi / 2.0)


def bread(form: Form) -> Iterator[Part]:
    """A tan loaf with a domed crust."""
    d, w, h = form.size_m
    crust = form.pick(((0.70, 0.45, 0.20), (0.62, 0.38, 0.17), (0.76, 0.54, 0.28)))
    if form.sliced:
        for k in range(6):
            x = (k - 2.5) * d / 6.0
            yield box((x, 0.0, h * 0.5), (d / 12.0, w, h), crust)
            yield box((x, 0.0, h * 0.5), (d / 12.0 * 1.12, w * 0.88, h * 0.9), (0.95, 0.87, 0.68))
        return
    yield box((0.0, 0.0, h * 0.36), (d * 0.96, w * 0.92, h * 0.72), crust)
    yield cylinder((0.0, 0.0, h * 0.62), (h * 0.76, w, d), shade(crust, 1.1), pitch=pi / 2.0)
    for x in (-0.3, -0.1, 0.1, 0.3):
        yield box((d * x, 0.0, h * 0.985), (d * 0.035, w * 0.6, h * 0.03), (0.92, 0.78, 0.52), yaw=0.5)
    yield cone((0.0, 0.0, h * 0.05), (d * 0.9, w * 0.85, h * 0.1), shade(crust, 0.8))


FOOD: dict[str, Model] = {"Apple": apple, "Bread": bread, "Lettuce": lettuce, "Potato": potato, "Tomato": tomato}
