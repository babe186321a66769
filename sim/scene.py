"""A furnished home as data: what the generator makes, what physics and the renderer build from.

Frames: site ENU, metres. An object's own frame: x to its front, y to its left, z up, origin at the centre of its base.
"""

from dataclasses import dataclass, field
from typing import Literal

Vec2 = tuple[float, float]
Vec3 = tuple[float, float, float]
Rgb = tuple[float, float, float]

ORIGIN = (47.397742, 8.545594, 488.0)
"""Latitude, longitude and height above the sea of a site's origin: where PX4's own simulation stands."""

Shape = Literal["box", "cylinder", "sphere", "cone"]


@dataclass(frozen=True)
class Part:
    """One primitive of an object's looks. `size_m`: full extents along x, y, z (a cylinder's and cone's axis is z)."""

    shape: Shape
    centre_m: Vec3
    size_m: Vec3
    rgb: Rgb
    yaw_rad: float = 0.0
    pitch_rad: float = 0.0
    """Turn about y after yaw about z: lids, doors, leaning books."""
    texture: int = 0
    """Row of the texture atlas; 0 is plain."""
    emission: float = 0.0
    """0 is lit by the room, 1 shines by itself."""


@dataclass
class Body:
    """One object as it is now. `key` is the simulator's own name and never leaves it."""

    key: int
    type: str
    position_m: Vec3
    """Centre of the base."""
    yaw_rad: float
    size_m: Vec3
    """Depth (x), width (y), height (z)."""
    look: int
    """Seed of colours and variants."""
    props: dict[str, bool] = field(default_factory=dict)
    parent: int | None = None
    """Key of the receptacle it rests in or on."""
    held_by: str | None = None
    gone: bool = False


@dataclass(frozen=True)
class Room:
    id: str
    name: str
    kind: str
    """Kitchen, LivingRoom, Bedroom or Bathroom."""
    polygon_m: tuple[Vec2, ...]
    floor_texture: int
    wall_rgb: Rgb


@dataclass(frozen=True)
class Wall:
    start_m: Vec2
    end_m: Vec2
    thickness_m: float
    height_m: float
    rooms: tuple[str, ...]


@dataclass(frozen=True)
class Door:
    id: str
    rooms: tuple[str, str]
    start_m: Vec2
    end_m: Vec2
    height_m: float


@dataclass(frozen=True)
class CctvPose:
    """A fixed camera; tilt is below the horizon."""

    id: str
    room: str
    position_m: Vec3
    yaw_rad: float
    tilt_down_rad: float
    width_px: int
    height_px: int
    focal_px: float


@dataclass
class Scene:
    """Everything in the building. `seed` made it; the same seed makes it again, byte for byte."""

    seed: int
    rooms: tuple[Room, ...]
    walls: tuple[Wall, ...]
    doors: tuple[Door, ...]
    bodies: dict[int, Body]
    cameras: tuple[CctvPose, ...]
    robot_starts: tuple[tuple[Vec2, float], ...]
    """Position and yaw, one for each possible robot, on free floor."""
