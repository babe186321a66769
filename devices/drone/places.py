"""What a command means by a place, and where to hover to be there or to see it."""

from math import cos, pi, sin

from devices.drone.craft import Craft
from devices.drone.route import nearest_open
from wire.catalogue import catalogue
from wire.frames import bearing_rad, distance_m
from wire.messages.command import Command
from wire.model import Vec2, Vec3
from wire.outline import mean_m
from wire.site import Room

BESIDE_M = 1.0
"""From the side of a thing, where nothing else is said."""
SLACK_M = 1.5
BEARINGS = 12


def room_of(craft: Craft, id: str | None) -> Room | None:
    return next((room for room in craft.space.rooms if room.id == id), None)


def place_of(craft: Craft, command: Command) -> tuple[Vec2, str]:
    """The middle of what the command names, and its name; where the drone is when it names nothing."""
    if command.target is not None:
        return command.target.position_enu_m[:2], command.target.id
    if (room := room_of(craft, command.room)) is not None:
        return middle_of(room.polygon_m), room.name
    if command.point_m is not None:
        return command.point_m, f"({command.point_m[0]:.1f}, {command.point_m[1]:.1f})"
    return craft.position_m[:2], "where it is"


def middle_of(polygon_m: tuple[Vec2, ...]) -> Vec2:
    """The centre of its area; of its corners when it has none."""
    area = x = y = 0.0
    x1, y1 = polygon_m[-1]
    for x2, y2 in polygon_m:
        cross = x1 * y2 - x2 * y1
        area, x, y = area + cross, x + (x1 + x2) * cross, y + (y1 + y2) * cross
        x1, y1 = x2, y2
    if abs(area) < 1e-9:
        return mean_m(polygon_m)
    return (x / (3.0 * area), y / (3.0 * area))


def half_size_m(type: str) -> float:
    """From a thing's middle to its longer side, as things of its type commonly are."""
    row = catalogue().get(type)
    return max(row.size_m[0], row.size_m[1]) / 2.0 if row is not None else 0.2


def near_target(craft: Craft, middle_m: Vec2, height_m: float, away_m: float = BESIDE_M) -> Vec3 | None:
    """Where to hover that far from a point: on the drone's own side of it rather than behind it, in the same room.

    With 0 as near to being above the point as walls and high things allow. None when there is no such place.
    """
    if away_m <= 0.0:
        return nearest_open(craft.space, (*middle_m, height_m), SLACK_M)
    own_rad = bearing_rad(middle_m, craft.position_m[:2])
    turns = sorted((2.0 * pi * k / BEARINGS for k in range(BEARINGS)), key=lambda turn: min(turn, 2.0 * pi - turn))
    for turn in turns:
        angle = own_rad + turn
        point = (middle_m[0] + away_m * cos(angle), middle_m[1] + away_m * sin(angle), height_m)
        if not craft.space.fault(point) and craft.space.in_sight(point, middle_m):
            return point
    near = nearest_open(craft.space, (*middle_m, height_m), away_m + SLACK_M)
    return near if near is not None and distance_m(near, middle_m) <= away_m + SLACK_M else None
