"""Rooms, walls and doors as rows. Each side of a wall has the colour of the room it faces."""

from math import cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from sim import textures
from sim.render.meshes import BOX, TRIANGLE
from sim.render.picture import CEILING_ID, DOOR_ID, FLOOR_ID, WALL_ID
from sim.render.polygons import contains, triangles
from sim.render.rows import EVERYWHERE, ROW, Rows
from sim.scene import Door, Rgb, Room, Scene, Vec2, Vec3, Wall

OUTSIDE: Rgb = (0.80, 0.78, 0.74)
CEILING: Rgb = (0.95, 0.95, 0.93)
FRAME: Rgb = (0.93, 0.91, 0.87)
FLOORS: dict[int, tuple[Rgb, ...]] = {
    textures.WOOD: ((0.72, 0.53, 0.35), (0.56, 0.39, 0.25), (0.82, 0.68, 0.50)),
    textures.TILE: ((0.80, 0.82, 0.83), (0.72, 0.70, 0.66), (0.62, 0.68, 0.70)),
    textures.CARPET: ((0.64, 0.60, 0.56), (0.48, 0.52, 0.58), (0.70, 0.64, 0.52)),
    textures.MARBLE: ((0.88, 0.87, 0.85), (0.74, 0.76, 0.78)),
}
ANY_FLOOR: tuple[Rgb, ...] = ((0.75, 0.72, 0.68),)
FRAME_WIDTH_M = 0.07


class RoomFinder:
    """Which room a point of the floor lies in."""

    def __init__(self, rooms: tuple[Room, ...]) -> None:
        self._polygons = [room.polygon_m for room in rooms]
        self.index = {room.id: i for i, room in enumerate(rooms)}

    def find(self, point_m: Vec2) -> int | None:
        return next((i for i, polygon in enumerate(self._polygons) if contains(polygon, point_m)), None)

    def place(self, point_m: Vec3) -> tuple[int, np.uint64]:
        """Index of the lamp and the rooms it can be seen from, of something at a point."""
        room = self.find((point_m[0], point_m[1]))
        return (-1, EVERYWHERE) if room is None else (room, np.uint64(1 << room))

    def around(self, point_m: Vec3, radius_m: float) -> np.uint64:
        """The rooms from which something round, about a point, may be seen; all of them when it stands in a doorway."""
        _, rooms = self.place(point_m)
        for k in range(8):
            x, y = (point_m[0] + radius_m * cos(k * pi / 4.0), point_m[1] + radius_m * sin(k * pi / 4.0))
            room = self.find((x, y))
            rooms |= np.uint64(0 if room is None else 1 << room)
        return rooms

    def bits(self, rooms: tuple[str, ...]) -> np.uint64:
        return np.uint64(sum(1 << self.index[room] for room in rooms))


def building_rows(scene: Scene) -> Rows:
    """All that never moves."""
    finder = RoomFinder(scene.rooms)
    rows = [row for i, room in enumerate(scene.rooms) for row in _slabs(i, room, _ceiling_m(scene), scene.seed)]
    for i, wall in enumerate(scene.walls):
        for start, end in _solid(wall, scene.doors):
            rows += _wall_rows(wall, start, end, (0.0, wall.height_m), WALL_ID + i, scene.rooms, finder)
    for i, door in enumerate(scene.doors):
        wall = _wall_of(door, scene.walls)
        span = (door.height_m, wall.height_m)
        rows += _wall_rows(wall, door.start_m, door.end_m, span, WALL_ID + scene.walls.index(wall), scene.rooms, finder)
        rows += _frame_rows(door, wall.thickness_m, DOOR_ID + i, finder.bits(door.rooms), finder.index[door.rooms[0]])
    return np.array(rows, dtype=ROW)


def _ceiling_m(scene: Scene) -> float:
    return max((wall.height_m for wall in scene.walls), default=2.5)


Row = tuple[object, ...]


def _row(
    shape: int, axes: object, centre: Vec3, rgb: Rgb, surface: int, room: int, row_id: int, rooms: np.uint64
) -> Row:
    return (axes, centre, rgb, surface, 0.0, room, row_id, shape, rooms)


def _slabs(index: int, room: Room, height_m: float, seed: int) -> list[Row]:
    """Floor seen from above and ceiling seen from below."""
    rows = []
    shades = FLOORS.get(room.floor_texture, ANY_FLOOR)
    rgb = shades[(seed + index) % len(shades)]
    for a, b, c in triangles(room.polygon_m):
        one, two = (b[0] - a[0], b[1] - a[1], 0.0), (c[0] - a[0], c[1] - a[1], 0.0)
        floor, ceiling = (one, two, (0.0, 0.0, 1.0)), (two, one, (0.0, 0.0, -1.0))
        bit = np.uint64(1 << index)
        rows.append(_row(TRIANGLE, floor, (*a, 0.0), rgb, room.floor_texture, index, FLOOR_ID + index, bit))
        rows.append(_row(TRIANGLE, ceiling, (*a, height_m), CEILING, 0, index, CEILING_ID + index, bit))
    return rows


def _solid(wall: Wall, doors: tuple[Door, ...]) -> list[tuple[Vec2, Vec2]]:
    """The stretches of a wall between the doors in it."""
    length = hypot(wall.end_m[0] - wall.start_m[0], wall.end_m[1] - wall.start_m[1])
    gaps = sorted(gap for door in doors if (gap := _gap(wall, door)) is not None)
    cuts = [0.0, *(along for gap in gaps for along in gap), length]
    return [(_along(wall, a), _along(wall, b)) for a, b in zip(cuts[::2], cuts[1::2], strict=True) if b - a > 1e-3]


def _direction(start_m: Vec2, end_m: Vec2) -> tuple[NDArray[np.float64], float]:
    step = np.array(end_m) - np.array(start_m)
    length = float(np.hypot(*step))
    return step / length, length


def _along(wall: Wall, distance_m: float) -> Vec2:
    direction, _ = _direction(wall.start_m, wall.end_m)
    x, y = np.array(wall.start_m) + distance_m * direction
    return (float(x), float(y))


def _gap(wall: Wall, door: Door) -> tuple[float, float] | None:
    """Where along a wall a door opens it."""
    direction, length = _direction(wall.start_m, wall.end_m)
    jambs = [np.array(jamb) - np.array(wall.start_m) for jamb in (door.start_m, door.end_m)]
    aside = max(abs(float(jamb[0] * direction[1] - jamb[1] * direction[0])) for jamb in jambs)
    first, last = sorted(float(jamb @ direction) for jamb in jambs)
    if aside > 0.05 or last < 0.01 or first > length - 0.01:
        return None
    return max(first, 0.0), min(last, length)


def _wall_of(door: Door, walls: tuple[Wall, ...]) -> Wall:
    """The wall a door is in, or the nearest piece of it that is left."""

    def distance(wall: Wall) -> float:
        direction, length = _direction(wall.start_m, wall.end_m)
        offset = (np.array(door.start_m) + np.array(door.end_m)) / 2.0 - np.array(wall.start_m)
        along = min(max(float(offset @ direction), 0.0), length)
        aligned = _direction(door.start_m, door.end_m)[0] @ direction
        return float(np.hypot(*(offset - along * direction))) + (0.0 if abs(aligned) > 0.9 else 100.0)

    return min(walls, key=distance)


def _box(start: Vec2, end: Vec2, aside_m: tuple[float, float], up_m: tuple[float, float]) -> tuple[object, Vec3]:
    """Axes and centre of a box along a line, between two distances to its left and two heights."""
    direction, length = _direction(start, end)
    left = np.array((-direction[1], direction[0]))
    middle = (np.array(start) + np.array(end)) / 2.0 + left * sum(aside_m) / 2.0
    width, height = aside_m[1] - aside_m[0], up_m[1] - up_m[0]
    axes = ((*(direction * length), 0.0), (*(left * width), 0.0), (0.0, 0.0, height))
    return axes, (float(middle[0]), float(middle[1]), sum(up_m) / 2.0)


def _wall_rows(
    wall: Wall,
    start: Vec2,
    end: Vec2,
    up_m: tuple[float, float],
    row_id: int,
    rooms: tuple[Room, ...],
    finder: RoomFinder,
) -> list[Row]:
    """Two half walls back to back, each painted and seen with its own room."""
    rows = []
    direction, _ = _direction(wall.start_m, wall.end_m)
    half = wall.thickness_m / 2.0
    for side in (1.0, -1.0):
        probe = (np.array(start) + np.array(end)) / 2.0 + side * (half + 0.05) * np.array((-direction[1], direction[0]))
        room = finder.find((float(probe[0]), float(probe[1])))
        rgb = OUTSIDE if room is None else rooms[room].wall_rgb
        bits = np.uint64(0) if room is None else np.uint64(1 << room)
        axes, centre = _box(start, end, (min(0.0, side * half), max(0.0, side * half)), up_m)
        rows.append(_row(BOX, axes, centre, rgb, 0, -1 if room is None else room, row_id, bits))
    return rows


def _frame_rows(door: Door, thickness_m: float, row_id: int, bits: np.uint64, room: int) -> list[Row]:
    """Two posts and a head, a little proud of the wall."""
    half = thickness_m / 2.0 + 0.02
    direction, _ = _direction(door.start_m, door.end_m)
    step = direction * FRAME_WIDTH_M
    start, end = np.array(door.start_m), np.array(door.end_m)
    pieces = (
        (start, start + step, (0.0, door.height_m)),
        (end - step, end, (0.0, door.height_m)),
        (start, end, (door.height_m - FRAME_WIDTH_M, door.height_m + 0.03)),
    )
    rows = []
    for a, b, up_m in pieces:
        axes, centre = _box((float(a[0]), float(a[1])), (float(b[0]), float(b[1])), (-half, half), up_m)
        rows.append(_row(BOX, axes, centre, FRAME, 0, room, row_id, bits))
    return rows
