"""The whole home seen by a robot: what floor it can walk, and whether everything is within its reach."""

from sim.boxes import body_box
from sim.generator.areas import Area
from sim.generator.floor import Floor, Mask
from sim.scene import Body, Scene, Wall
from wire.catalogue import catalogue

ROBOT_CLEAR_M = 0.42
REACH_M = 1.1


def home_floor(scene: Scene) -> Floor:
    """The floor with its walls and all that stands on it."""
    corners = [corner for room in scene.rooms for corner in room.polygon_m]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    floor = Floor(Area(min(xs), min(ys), max(xs), max(ys)))
    for wall in scene.walls:
        floor.put(_wall_area(wall))
    for area in standing_areas(scene):
        floor.put(area)
    return floor


def standing_areas(scene: Scene) -> list[Area]:
    """Footprints of what stands on the floor."""
    return [body_area(b) for b in scene.bodies.values() if b.parent is None and b.position_m[2] < 0.5]


def body_area(body: Body) -> Area:
    """The smallest rectangle along the axes around a body."""
    box = body_box(body)
    xs, ys = zip(
        *(box.site((sx * box.half_m[0], sy * box.half_m[1], 0.0))[:2] for sx in (-1, 1) for sy in (-1, 1)), strict=True
    )
    return Area(min(xs), min(ys), max(xs), max(ys))


def _wall_area(wall: Wall) -> Area:
    (x0, y0), (x1, y1) = sorted((wall.start_m, wall.end_m))
    half = wall.thickness_m / 2.0
    return Area(x0 - half, y0, x1 + half, y1) if x0 == x1 else Area(x0, y0 - half, x1, y1 + half)


def all_rooms_joined(scene: Scene, floor: Floor, walkable: Mask) -> bool:
    """Whether every room has walkable floor."""
    areas = [_polygon_area(room.polygon_m) for room in scene.rooms]
    return all((walkable & (floor.distance_m(area.grown(-0.3)) <= 0.0)).any() for area in areas)


def _polygon_area(polygon: tuple[tuple[float, float], ...]) -> Area:
    xs, ys = zip(*polygon, strict=True)
    return Area(min(xs), min(ys), max(xs), max(ys))


def out_of_reach(scene: Scene, floor: Floor, walkable: Mask) -> list[Body]:
    """Everything that a robot may have to touch and cannot."""
    return [
        body
        for body in scene.bodies.values()
        if _touchable(body) and not (walkable & (floor.distance_m(body_area(body)) <= REACH_M)).any()
    ]


def _touchable(body: Body) -> bool:
    row = catalogue()[body.type]
    return any(row.can(flag) for flag in ("receptacle", "pickupable", "openable", "toggleable"))
