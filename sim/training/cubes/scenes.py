"""Random floors with cubes, a walking robot and clutter, and the pose of a drone's camera above them: all from a seed."""

from dataclasses import dataclass
from math import cos, hypot, pi, radians, sin, tan

import numpy as np

from devices.vision.lens import Image, Lens
from sim.models.registry import MODELS
from sim.render import Camera, Renderer, make_renderer
from sim.scene import Body, Room, Scene, Vec2, Wall
from sim.textures import CARPET, MARBLE, PLAIN, TILE, WOOD
from sim.training.cubes.models import COLOURS, EDGE_M, cube_parts
from wire.catalogue import catalogue
from wire.model import Vec3

FOV_RAD = 1.2
SIZE_PX = (640, 480)
LOW_M, HIGH_M = 1.9, 2.7
TILT_SD_RAD = radians(2.0)
FLOORS = (WOOD, TILE, CARPET, MARBLE, PLAIN)
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
CLUTTER = ("Book", "Bowl", "Plate", "BasketBall", "Laptop", "Pillow", "Newspaper", "GarbageCan")
HEAD_M, BODY_M, TAIL_M = (0.36, 0.0, 0.45), (-0.05, 0.0, 0.49), (-0.30, 0.0, 0.44)
"""Points of the walking robot that stand for its parts, about its feet."""
ROBOT = "walker"
CHANCE_OF_ROBOT, CHANCE_OF_CLUTTER, CHANCE_OF_COLOUR = 0.6, 0.5, 0.35
AREA_M = 6.0


@dataclass(frozen=True)
class Truth:
    """One thing in the picture: the point of it that is meant by its place, and how it is turned in the site."""

    name: str
    point_m: Vec3
    yaw_rad: float | None
    part: str | None = None


@dataclass(frozen=True)
class Shot:
    """A picture and what is true of it."""

    rgb: Image
    lens: Lens
    truths: tuple[Truth, ...]


class CubeStudio:
    """One floor and its light; new cubes for every picture. Texture and light are the seed's alone."""

    def __init__(self, seed: int, renderer: str = "auto") -> None:
        self.seed, self.rng = seed, np.random.default_rng(seed)
        self._scene = _floor(seed, self.rng)
        assert renderer in ("auto", "gl", "bullet")
        self._renderer: Renderer = make_renderer(self._scene, renderer, cube_parts)  # type: ignore[arg-type]
        self._keys: set[int] = set()

    def shoot(self) -> Shot:
        """Put cubes anew and take a picture from somewhere above them."""
        lens = drone_lens(self.rng)
        truths, bodies = self._arrange(lens)
        for key in self._keys - {b.key for b in bodies}:
            self._renderer.update(Body(key, "cube_A", (0.0, 0.0, 0.0), 0.0, (0.1, 0.1, 0.1), 0, gone=True))
        for body in bodies:
            self._renderer.update(body)
        self._keys = {b.key for b in bodies}
        view = Camera(lens.position_enu_m, lens.yaw_rad, lens.tilt_down_rad, *SIZE_PX, lens.focal_px)
        picture = self._renderer.render(view)
        return Shot(_as_exposed(picture.rgb, self.rng), lens, tuple(t for t in truths if _inside(lens, t.point_m)))

    def close(self) -> None:
        self._renderer.close()

    def _arrange(self, lens: Lens) -> tuple[list[Truth], list[Body]]:
        rng, taken = self.rng, list[tuple[Vec2, float]]()
        truths: list[Truth] = []
        bodies: list[Body] = []
        robot = _free(lens, rng, taken, 0.42) if rng.random() < CHANCE_OF_ROBOT else None
        yaw = float(rng.uniform(-pi, pi))
        self._renderer.set_robot(ROBOT, (*robot, 0.0) if robot else (0.0, 0.0, -50.0), yaw)
        if robot is not None:
            truths += [
                Truth("robot", _about(robot, yaw, at), None, part)
                for part, at in (("head", HEAD_M), ("body", BODY_M), ("tail", TAIL_M))
            ]
        for name in _names(rng):
            place = _free(lens, rng, taken, 0.19)
            if place is not None:
                turn = float(rng.uniform(-pi, pi))
                look = int(rng.integers(1 << 30))
                size = (EDGE_M, EDGE_M, EDGE_M)
                bodies.append(Body(len(bodies) + 1, name, (*place, 0.0), turn, size, look))
                lettered = name.removeprefix("cube_") not in COLOURS
                truths.append(Truth(name, (*place, EDGE_M), turn if lettered else None))
        for _ in range(int(rng.integers(1, 4)) if rng.random() < CHANCE_OF_CLUTTER else 0):
            kind = CLUTTER[int(rng.integers(len(CLUTTER)))]
            size = catalogue()[kind].size_m
            place = _free(lens, rng, taken, hypot(size[0], size[1]) / 2.0)
            if place is not None and kind in MODELS:
                turn, look = float(rng.uniform(-pi, pi)), int(rng.integers(1 << 30))
                bodies.append(Body(len(bodies) + 1, kind, (*place, 0.0), turn, size, look))
        return truths, bodies


def drone_lens(rng: np.random.Generator) -> Lens:
    """Straight down but for the little that a drone is tilted when the picture is taken."""
    height_m = float(rng.uniform(LOW_M, HIGH_M))
    tilt = pi / 2.0 + float(rng.normal(0.0, TILT_SD_RAD))
    focal_px = SIZE_PX[0] / 2.0 / tan(FOV_RAD / 2.0)
    x, y = (float(v) for v in rng.uniform(-1.0, 1.0, 2))
    return Lens(*SIZE_PX, focal_px, (x, y, height_m), float(rng.uniform(-pi, pi)), tilt)


def _floor(seed: int, rng: np.random.Generator) -> Scene:
    half = AREA_M
    corners: tuple[Vec2, ...] = ((-half, -half), (half, -half), (half, half), (-half, half))
    shade = float(rng.uniform(0.5, 0.95))
    kind = ("Kitchen", "LivingRoom", "Bedroom", "Bathroom")[int(rng.integers(4))]
    texture = FLOORS[int(rng.integers(len(FLOORS)))]
    room = Room("floor", "floor", kind, corners, texture, (shade, shade, shade))
    wall = Wall(corners[0], corners[1], 0.1, float(rng.uniform(3.2, 5.5)), ("floor",))
    return Scene(seed, (room,), (wall,), (), {}, (), ())


def _names(rng: np.random.Generator) -> list[str]:
    """Three to nine cubes, no name twice."""
    letters = [f"cube_{c}" for c in rng.permutation(list(LETTERS))]
    colours = [f"cube_{c}" for c in rng.permutation(sorted(COLOURS))]
    count = int(rng.integers(3, 10))
    return [(colours if colours and rng.random() < CHANCE_OF_COLOUR else letters).pop() for _ in range(count)]


def _free(lens: Lens, rng: np.random.Generator, taken: list[tuple[Vec2, float]], radius_m: float) -> Vec2 | None:
    """A place in the picture, apart from what is there already."""
    for _ in range(40):
        u, v = rng.uniform(0.06, 0.94) * lens.width_px, rng.uniform(0.06, 0.94) * lens.height_px
        ray = lens.rays(u, v)[0]
        along = (lens.position_enu_m[2] - EDGE_M) / -ray[2]
        x, y = (float(lens.position_enu_m[i] + ray[i] * along) for i in (0, 1))
        if all(hypot(x - a, y - b) > radius_m + r for (a, b), r in taken):
            taken.append(((x, y), radius_m))
            return (x, y)
    return None


def _about(feet_m: Vec2, yaw: float, at: Vec3) -> Vec3:
    c, s = cos(yaw), sin(yaw)
    return (feet_m[0] + c * at[0] - s * at[1], feet_m[1] + s * at[0] + c * at[1], at[2])


def _inside(lens: Lens, point_m: Vec3) -> bool:
    u, v, depth_m = lens.pixels(point_m)[0].tolist()
    return bool(depth_m > 0.1 and 0.0 <= u < lens.width_px and 0.0 <= v < lens.height_px)


def _as_exposed(rgb: Image, rng: np.random.Generator) -> Image:
    """With the exposure, white balance and noise of a camera."""
    gains = rng.uniform(0.75, 1.2) * rng.uniform(0.94, 1.06, 3)
    noise = rng.normal(0.0, rng.uniform(1.0, 4.0), rgb.shape)
    return np.clip(rgb * gains + noise, 0.0, 255.0).astype(np.uint8)
