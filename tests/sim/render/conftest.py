"""Two rooms with a few things in them, made by hand."""

from math import pi

import pytest

from sim import textures
from sim.render.instances import PartsOf
from sim.scene import Body, CctvPose, Door, Part, Room, Scene, Wall


def _parts(body: Body) -> list[Part]:
    """A box, cylinder, sphere or cone as large as the body; a television is a box with a screen that can be lit."""
    depth, width, height = body.size_m
    middle = (0.0, 0.0, height / 2.0)
    if body.type == "Television":
        lit = body.props.get("isToggled", False)
        screen = Part(
            "box",
            (depth / 2.0, 0.0, height / 2.0),
            (0.02, width * 0.95, height * 0.9),
            (1.0, 1.0, 1.0) if lit else (0.05, 0.05, 0.05),
            texture=textures.SCREEN if lit else textures.PLAIN,
            emission=1.0 if lit else 0.0,
        )
        return [Part("box", middle, body.size_m, (0.1, 0.1, 0.1)), screen]
    shapes = {"Box": "box", "Vase": "cylinder", "Ball": "sphere", "Cone": "cone"}
    rgb = ((body.look * 37 % 100) / 100.0, (body.look * 61 % 100) / 100.0, (body.look * 83 % 100) / 100.0)
    return [Part(shapes[body.type], middle, body.size_m, rgb, texture=body.look % 8)]  # type: ignore[arg-type]


def _bodies() -> dict[int, Body]:
    rows = [
        ("Television", (0.3, 2.0, 0.6), 0.0, (0.08, 1.1, 0.65)),
        ("Box", (3.2, 3.3, 0.0), 0.5, (0.6, 0.9, 0.7)),
        ("Vase", (2.2, 1.0, 0.0), 0.0, (0.3, 0.3, 0.8)),
        ("Ball", (1.5, 2.5, 0.0), 0.0, (0.4, 0.4, 0.4)),
        ("Cone", (1.2, 0.8, 0.0), 0.0, (0.4, 0.4, 0.6)),
        ("Box", (6.2, 1.0, 0.0), -0.4, (0.8, 1.4, 0.5)),
        ("Ball", (7.0, 3.0, 0.0), 0.0, (0.5, 0.7, 0.3)),
        ("Vase", (5.0, 3.4, 0.0), 0.0, (0.25, 0.4, 1.2)),
    ]
    return {
        key: Body(key, kind, position, yaw, size, look=key * 3 + 1)
        for key, (kind, position, yaw, size) in enumerate(rows, start=1)
    }


def _camera(name: str, room: str, x: float, y: float, yaw_rad: float) -> CctvPose:
    return CctvPose(name, room, (x, y, 2.3), yaw_rad, 0.55, 640, 480, 320.0)


@pytest.fixture
def parts_of() -> PartsOf:
    return _parts


@pytest.fixture
def home() -> Scene:
    corners = ((0.0, 0.0), (4.0, 0.0), (8.0, 0.0), (8.0, 4.0), (4.0, 4.0), (0.0, 4.0))
    outer = [
        Wall(a, b, 0.1, 2.6, ("a",) if max(a[0], b[0]) <= 4.0 else ("b",))
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    inner = Wall((4.0, 0.0), (4.0, 4.0), 0.1, 2.6, ("a", "b"))
    return Scene(
        seed=0,
        rooms=(
            Room(
                "a", "Living room", "LivingRoom", (corners[0], corners[1], corners[4], corners[5]), 1, (0.85, 0.80, 0.7)
            ),
            Room("b", "Kitchen", "Kitchen", (corners[1], corners[2], corners[3], corners[4]), 2, (0.7, 0.8, 0.85)),
        ),
        walls=(*outer, inner),
        doors=(Door("d", ("a", "b"), (4.0, 1.6), (4.0, 2.6), 2.05),),
        bodies=_bodies(),
        cameras=(_camera("cam-1", "a", 3.8, 0.2, 0.75 * pi), _camera("cam-2", "b", 7.8, 3.8, -0.75 * pi)),
        robot_starts=(((2.5, 2.0), 0.0),),
    )
