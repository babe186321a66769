"""What lettered and coloured cubes look like: a box, and on its top the letter's strokes as thin boxes."""

from collections.abc import Iterator, Sequence
from math import atan2, dist

from sim.models import parts
from sim.models.form import Form, box
from sim.scene import Body, Part, Rgb
from sim.textures import BOARD, PLAIN
from sim.training.cubes.glyphs import strokes

EDGE_M = 0.25
COLOURS: dict[str, Rgb] = {
    "red": (0.78, 0.12, 0.12),
    "green": (0.14, 0.58, 0.20),
    "blue": (0.12, 0.22, 0.75),
    "yellow": (0.86, 0.78, 0.14),
    "orange": (0.90, 0.46, 0.08),
    "purple": (0.45, 0.16, 0.56),
}
PAPERS: tuple[Rgb, ...] = ((0.93, 0.92, 0.88), (0.85, 0.84, 0.82), (0.88, 0.80, 0.66), (0.76, 0.79, 0.82))
INKS: tuple[Rgb, ...] = ((0.06, 0.06, 0.07), (0.08, 0.08, 0.25), (0.25, 0.05, 0.05), (0.16, 0.16, 0.17))
INK_M = 0.004
"""How far the ink stands out: enough for both renderers, too little to be seen."""


def cube_parts(body: Body) -> Sequence[Part]:
    """Of a cube named `cube_A` or `cube_red`; of everything else what it looks like at home."""
    name = body.type.removeprefix("cube_")
    if name == body.type:
        return parts(body)
    return tuple(_coloured(Form(body), COLOURS[name]) if name in COLOURS else _lettered(Form(body), name))


def _coloured(form: Form, rgb: Rgb) -> Iterator[Part]:
    edge = form.height_m
    yield box((0.0, 0.0, edge / 2.0), (edge, edge, edge), form.pick((rgb,), 0.08))


def _lettered(form: Form, letter: str) -> Iterator[Part]:
    edge, chance = form.height_m, form.chance
    paper, ink = form.pick(PAPERS), form.pick(INKS)
    yield box((0.0, 0.0, edge / 2.0), (edge, edge, edge), paper, chance.choice((PLAIN, PLAIN, BOARD)))
    high, thick = edge * chance.uniform(0.62, 0.78), edge * chance.uniform(0.07, 0.13)
    wide, slant = high * chance.uniform(0.75, 0.95), chance.uniform(-0.12, 0.12)
    for (x0, y0), (x1, y1) in strokes(letter):
        a = ((x0 - 0.5 + slant * (y0 - 0.5)) * wide, (y0 - 0.5) * high)
        b = ((x1 - 0.5 + slant * (y1 - 0.5)) * wide, (y1 - 0.5) * high)
        turn = atan2(b[1] - a[1], b[0] - a[0])
        # longer by its thickness, so that pieces meet without notches
        middle = ((a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, edge + INK_M / 2.0)
        yield box(middle, (dist(a, b) + thick * 0.9, thick, INK_M), ink, yaw=turn)
