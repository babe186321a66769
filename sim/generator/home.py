"""A furnished home from a seed: plan, furniture, clutter, cameras, starts; drawn again until a robot can work in it."""

from itertools import count
from random import Random

from sim.generator.access import ROBOT_CLEAR_M, all_rooms_joined, home_floor, out_of_reach
from sim.generator.cctv import place_cameras
from sim.generator.clutter import Clutter
from sim.generator.furniture import dining_room, furnish
from sim.generator.placing import RoomPlacing
from sim.generator.plan import FloorPlan, PlannedRoom, draw_house, draw_plan
from sim.generator.starts import draw_starts
from sim.generator.statistics import House
from sim.generator.walls import draw_walls
from sim.scene import Body, Rgb, Room, Scene
from sim.textures import CARPET, MARBLE, TILE, WOOD
from wire.catalogue import RoomKind

MOST_BODIES = 70
LEAST_BODIES = 40
NEEDED: dict[RoomKind, tuple[str, ...]] = {
    "Kitchen": ("CounterTop", "Fridge", "Sink"),
    "LivingRoom": ("Sofa",),
    "Bedroom": ("Bed",),
    "Bathroom": ("Toilet",),
}
"""A room without one of these is drawn again."""
FLOORS: dict[RoomKind, tuple[int, ...]] = {
    "Kitchen": (TILE, TILE, WOOD),
    "LivingRoom": (WOOD, WOOD, CARPET),
    "Bedroom": (CARPET, WOOD),
    "Bathroom": (TILE, MARBLE),
}
PAINTS: tuple[Rgb, ...] = (
    (0.88, 0.86, 0.80),
    (0.80, 0.85, 0.88),
    (0.86, 0.82, 0.74),
    (0.78, 0.84, 0.76),
    (0.90, 0.89, 0.88),
    (0.87, 0.78, 0.74),
)


def make_home(seed: int) -> Scene:
    """The home of a seed: always the same one."""
    house = draw_house(Random(f"house {seed}"))
    for attempt in count():
        scene = _draw_home(seed, house, Random(f"home {seed} {attempt}"))
        if scene is not None:
            return scene
    raise AssertionError("unreachable")


def _draw_home(seed: int, house: House, rng: Random) -> Scene | None:
    plan = draw_plan(house, rng)
    bodies = _furnished(plan, rng)
    if bodies is None or len(bodies) < LEAST_BODIES:
        return None
    rooms = tuple(_room(room, rng) for room in plan.rooms)
    scene = Scene(seed, rooms, draw_walls(plan), plan.doors, bodies, (), ())
    floor = home_floor(scene)
    walkable = floor.walkable(needed_m=ROBOT_CLEAR_M)
    if walkable is None or not all_rooms_joined(scene, floor, walkable) or out_of_reach(scene, floor, walkable):
        return None
    starts = draw_starts(scene, floor, walkable, rng)
    cameras = place_cameras(scene, rng)
    if starts is None or cameras is None:
        return None
    scene.robot_starts, scene.cameras = starts, cameras
    return scene


def _furnished(plan: FloorPlan, rng: Random) -> dict[int, Body] | None:
    keys = count(1)
    rooms = [RoomPlacing(room, plan.doors, rng, keys) for room in plan.rooms]
    dining = dining_room(rooms, rng)
    for placing in rooms:
        furnish(placing, plan.doors, placing is dining)
        there = {body.type for body in placing.bodies.values()}
        if not there.issuperset(NEEDED[placing.room.kind]):
            return None
    clutter = Clutter(rooms, rng, keys)
    clutter.spread(MOST_BODIES)
    return {key: body for placing in rooms for key, body in sorted(placing.bodies.items())}


def _room(room: PlannedRoom, rng: Random) -> Room:
    return Room(room.id, room.name, room.kind, room.area.corners_m, rng.choice(FLOORS[room.kind]), rng.choice(PAINTS))
