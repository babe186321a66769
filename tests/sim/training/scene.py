"""A table with a mug and a lit television, as the renderer draws them."""

from devices.vision.lens import Lens
from sim.models import parts
from sim.render import Camera, make_renderer
from sim.scene import Body, Room, Scene, Wall
from sim.training.labels import Labels, Thing, label_picture

LENS = Lens(640, 480, 320.0, (0.3, 2.5, 2.3), 0.0, 0.6)
TABLE, MUG, TELEVISION = 1, 2, 3


def make_scene() -> Scene:
    corners = ((0.0, 0.0), (6.0, 0.0), (6.0, 5.0), (0.0, 5.0))
    walls = tuple(Wall(a, b, 0.1, 2.6, ("r",)) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    bodies = [
        Body(TABLE, "DiningTable", (3.0, 2.5, 0.0), 0.0, (0.9, 1.4, 0.75), 1),
        Body(MUG, "Mug", (2.8, 2.3, 0.75), 0.4, (0.10, 0.13, 0.11), 2, {"isDirty": True}),
        Body(TELEVISION, "Television", (5.0, 4.0, 0.6), 3.1, (0.2, 1.1, 0.7), 3, {"isToggled": True}),
    ]
    room = Room("r", "room", "LivingRoom", corners, 1, (0.9, 0.9, 0.85))
    return Scene(1, (room,), walls, (), {b.key: b for b in bodies}, (), ())


def things(scene: Scene) -> dict[int, Thing]:
    return {k: Thing(b.type, b.position_m, b.yaw_rad, b.size_m, b.props) for k, b in scene.bodies.items()}


def draw(lens: Lens = LENS):
    """Picture and labels."""
    scene = make_scene()
    renderer = make_renderer(scene, "auto", parts)
    size = (lens.width_px, lens.height_px, lens.focal_px)
    camera = Camera(lens.position_enu_m, lens.yaw_rad, lens.tilt_down_rad, *size)
    picture = renderer.render(camera, with_ids=True, with_depth=True)
    renderer.close()
    assert picture.ids is not None
    assert picture.depth_m is not None
    labels: Labels = label_picture(picture.ids, picture.depth_m, lens, things(scene))
    return picture, labels
