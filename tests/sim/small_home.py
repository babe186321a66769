"""Two rooms with a doorway, a table with a mug, a fridge with an apple in it, a ball and a box on the floor."""

from math import degrees
from typing import Any

from sim.scene import Body, CctvPose, Door, Room, Scene, Vec3, Wall
from wire.catalogue import catalogue
from wire.site import Site, parse_site

APPLE, TABLE, MUG, FRIDGE, BALL, BOX, TELEVISION, LAPTOP, MICROWAVE, KNIFE, BREAD, PLATE = range(1, 13)


def make_small_home() -> Scene:
    """West room x 0..5, east room x 5..10, y 0..5, a doorway at (5, 2..3)."""
    rooms = (
        Room("kitchen", "kitchen", "Kitchen", ((0, 0), (5, 0), (5, 5), (0, 5)), 0, (0.9, 0.9, 0.9)),
        Room("living", "living room", "LivingRoom", ((5, 0), (10, 0), (10, 5), (5, 5)), 0, (0.9, 0.9, 0.9)),
    )
    corners = (
        ((0.0, 0.0), (10.0, 0.0)),
        ((10.0, 0.0), (10.0, 5.0)),
        ((10.0, 5.0), (0.0, 5.0)),
        ((0.0, 5.0), (0.0, 0.0)),
    )
    middle = (((5.0, 0.0), (5.0, 2.0)), ((5.0, 3.0), (5.0, 5.0)))
    walls = tuple(Wall(a, b, 0.1, 2.6, ("kitchen", "living")) for a, b in corners + middle)
    door = Door("door-1", ("kitchen", "living"), (5.0, 2.0), (5.0, 3.0), 2.1)
    camera = CctvPose("cam-1", "kitchen", (0.2, 0.2, 2.3), 0.785, 0.5, 640, 480, 320.0)
    starts = (((2.0, 2.5), 0.0), ((8.0, 2.5), 3.1415926), ((3.5, 4.2), 0.0))
    return Scene(7, rooms, walls, (door,), {b.key: b for b in _bodies()}, (camera,), starts)


def _bodies() -> list[Body]:
    return [
        _body(TABLE, "DiningTable", (7.5, 4.2, 0.0), (0.8, 1.4, 0.75)),
        _body(MUG, "Mug", (7.4, 3.95, 0.75), parent=TABLE, isDirty=True),
        _body(FRIDGE, "Fridge", (1.0, 4.5, 0.0), (0.7, 0.8, 1.8), yaw_rad=-1.5707963, isOpen=False),
        _body(APPLE, "Apple", (1.0, 4.4, 0.7), parent=FRIDGE, isSliced=False),
        _body(BALL, "BasketBall", (3.5, 1.0, 0.0)),
        _body(BOX, "Box", (9.2, 0.8, 0.0), isOpen=False),
        _body(TELEVISION, "Television", (9.6, 2.5, 0.0), (0.2, 1.1, 0.7), isToggled=False),
        _body(LAPTOP, "Laptop", (7.6, 4.6, 0.75), parent=TABLE, isOpen=False, isToggled=False),
        _body(MICROWAVE, "Microwave", (3.5, 4.8, 0.0), (0.35, 0.5, 0.35), isOpen=False, isToggled=False),
        _body(KNIFE, "Knife", (7.25, 4.2, 0.75), parent=TABLE),
        _body(BREAD, "Bread", (7.3, 4.75, 0.75), parent=TABLE, isSliced=False),
        _body(PLATE, "Plate", (0.7, 0.7, 0.0), isDirty=False),
    ]


def _body(
    key: int,
    kind: str,
    position_m: Vec3,
    size_m: Vec3 | None = None,
    yaw_rad: float = 0.0,
    parent: int | None = None,
    **props: bool,
) -> Body:
    return Body(key, kind, position_m, yaw_rad, size_m or catalogue()[kind].size_m, key, dict(props), parent)


def make_small_site(*robots: str, **sim: Any) -> Site:
    """A site file for the small home, with the first robots at its starts."""
    scene = make_small_home()
    starts = zip(robots, scene.robot_starts, strict=False)
    return parse_site(
        {
            "name": "small",
            "room": [
                {"id": r.id, "name": r.name, "kind": r.kind, "polygon_m": [list(map(float, p)) for p in r.polygon_m]}
                for r in scene.rooms
            ],
            "camera": [
                {
                    "id": c.id,
                    "position_enu_m": list(c.position_m),
                    "yaw_deg": degrees(c.yaw_rad),
                    "tilt_down_deg": degrees(c.tilt_down_rad),
                    "width_px": c.width_px,
                    "height_px": c.height_px,
                    "focal_px": c.focal_px,
                }
                for c in scene.cameras
            ],
            "robot": [
                {"id": id, "kind": "quadruped", "start_m": list(at), "start_yaw_deg": degrees(yaw_rad)}
                for id, (at, yaw_rad) in starts
            ],
            "process": [],
            "sim": {"seed": scene.seed, **sim},
        },
        "small.toml",
    )
