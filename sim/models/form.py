"""What a model is built with: the body's size, state and chance, and one call for each primitive."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from random import Random

from sim.scene import Body, Part, Rgb, Vec3
from sim.textures import PLAIN

Model = Callable[["Form"], Iterator[Part]]

BLACK: Rgb = (0.05, 0.05, 0.06)
GLASS: Rgb = (0.07, 0.08, 0.10)
STEEL: Rgb = (0.62, 0.64, 0.66)
WHITE: Rgb = (0.93, 0.93, 0.92)
STAIN: Rgb = (0.27, 0.15, 0.06)
WOODS: tuple[Rgb, ...] = ((0.72, 0.52, 0.33), (0.52, 0.33, 0.19), (0.36, 0.22, 0.13), (0.85, 0.70, 0.50))
PAINTS: tuple[Rgb, ...] = ((0.92, 0.91, 0.88), (0.30, 0.32, 0.35), *WOODS)
FABRICS: tuple[Rgb, ...] = (
    (0.55, 0.57, 0.60),
    (0.25, 0.33, 0.48),
    (0.60, 0.30, 0.25),
    (0.72, 0.63, 0.50),
    (0.28, 0.42, 0.36),
    (0.45, 0.38, 0.33),
)


@dataclass(frozen=True)
class Form:
    """A body about to be modelled. Its chance depends on its look alone, never on its state."""

    body: Body

    @property
    def depth_m(self) -> float:
        return self.body.size_m[0]

    @property
    def width_m(self) -> float:
        return self.body.size_m[1]

    @property
    def height_m(self) -> float:
        return self.body.size_m[2]

    @property
    def size_m(self) -> Vec3:
        return self.body.size_m

    @cached_property
    def chance(self) -> Random:
        return Random(self.body.look)

    @property
    def open(self) -> bool:
        return self.body.props.get("isOpen", False)

    @property
    def on(self) -> bool:
        return self.body.props.get("isToggled", False)

    @property
    def dirty(self) -> bool:
        return self.body.props.get("isDirty", False)

    @property
    def sliced(self) -> bool:
        return self.body.props.get("isSliced", False)

    def pick(self, colours: Sequence[Rgb], spread: float = 0.06) -> Rgb:
        """One of the colours, a little lighter or darker, a little off its hue."""
        shade = 1.0 + self.chance.uniform(-2.0, 2.0) * spread
        r, g, b = (c * shade + self.chance.uniform(-spread, spread) * 0.3 for c in self.chance.choice(colours))
        return (_clip(r), _clip(g), _clip(b))


def shade(rgb: Rgb, factor: float) -> Rgb:
    """The same colour, lighter or darker."""
    return (_clip(rgb[0] * factor), _clip(rgb[1] * factor), _clip(rgb[2] * factor))


def _clip(value: float) -> float:
    return min(0.98, max(0.02, value))


def box(
    centre_m: Vec3,
    size_m: Vec3,
    rgb: Rgb,
    texture: int = PLAIN,
    *,
    yaw: float = 0.0,
    pitch: float = 0.0,
    glow: float = 0.0,
) -> Part:
    return Part("box", centre_m, size_m, rgb, yaw, pitch, texture, glow)


def cylinder(
    centre_m: Vec3,
    size_m: Vec3,
    rgb: Rgb,
    texture: int = PLAIN,
    *,
    yaw: float = 0.0,
    pitch: float = 0.0,
    glow: float = 0.0,
) -> Part:
    return Part("cylinder", centre_m, size_m, rgb, yaw, pitch, texture, glow)


def sphere(
    centre_m: Vec3,
    size_m: Vec3,
    rgb: Rgb,
    texture: int = PLAIN,
    *,
    yaw: float = 0.0,
    pitch: float = 0.0,
    glow: float = 0.0,
) -> Part:
    return Part("sphere", centre_m, size_m, rgb, yaw, pitch, texture, glow)


def cone(
    centre_m: Vec3,
    size_m: Vec3,
    rgb: Rgb,
    texture: int = PLAIN,
    *,
    yaw: float = 0.0,
    pitch: float = 0.0,
    glow: float = 0.0,
) -> Part:
    return Part("cone", centre_m, size_m, rgb, yaw, pitch, texture, glow)


def legs(size_m: Vec3, height_m: float, thick_m: float, rgb: Rgb, texture: int = PLAIN) -> Iterator[Part]:
    """Four legs at the corners of a footprint."""
    x, y = size_m[0] / 2.0 - thick_m, size_m[1] / 2.0 - thick_m
    for sx in (-x, x):
        for sy in (-y, y):
            yield box((sx, sy, height_m / 2.0), (thick_m, thick_m, height_m), rgb, texture)


def hollow(size_m: Vec3, wall_m: float, rgb: Rgb, inside: Rgb, texture: int = PLAIN) -> Iterator[Part]:
    """A box without its front: back, sides, top and bottom, darker or lighter inside."""
    d, w, h = size_m
    # The back is a little smaller than what surrounds it: faces in one plane would flicker through each other.
    yield box((-d / 2.0 + wall_m / 2.0, 0.0, h / 2.0), (wall_m, w - 0.01, h - 0.01), inside)
    for side in (-1.0, 1.0):
        yield box((0.0, side * (w - wall_m) / 2.0, h / 2.0), (d, wall_m, h), rgb, texture)
    for z in (wall_m / 2.0, h - wall_m / 2.0):
        yield box((0.0, 0.0, z), (d, w, wall_m), rgb, texture)


def tray(size_m: Vec3, base_z_m: float, wall_m: float, rgb: Rgb, inside: Rgb, texture: int = PLAIN) -> Iterator[Part]:
    """A box without its lid: bottom and four sides."""
    d, w, h = size_m
    yield box((0.0, 0.0, base_z_m + wall_m / 2.0), (d, w, wall_m), inside)
    for side in (-1.0, 1.0):
        yield box((side * (d - wall_m) / 2.0, 0.0, base_z_m + h / 2.0), (wall_m, w, h), rgb, texture)
        yield box((0.0, side * (w - wall_m) / 2.0, base_z_m + h / 2.0), (d, wall_m, h), rgb, texture)
