"""What every renderer takes and gives: cameras, pictures, and who owns which pixel."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sim.scene import Body, CctvPose, Vec3

NOTHING_ID = -1
WALL_ID = 1_000_000
FLOOR_ID = 2_000_000
CEILING_ID = 3_000_000
DOOR_ID = 4_000_000
ROBOT_ID = 5_000_000
"""First id of each range, by index in the scene (robots: in order of appearance); smaller ones are bodies' keys."""

NEAR_M = 0.05
FAR_M = 60.0


class RenderError(RuntimeError):
    """No picture can be drawn; the text says why and what to do."""


@dataclass(frozen=True)
class Camera:
    """A pinhole camera as `wire.frames.project` has it. A robot's own camera does not see its `carrier`."""

    position_m: Vec3
    yaw_rad: float
    tilt_down_rad: float
    width_px: int
    height_px: int
    focal_px: float
    carrier: str | None = None

    @classmethod
    def fixed(cls, pose: CctvPose) -> "Camera":
        """The camera of a CCTV pose."""
        return cls(pose.position_m, pose.yaw_rad, pose.tilt_down_rad, pose.width_px, pose.height_px, pose.focal_px)


@dataclass(frozen=True)
class Picture:
    """One frame. Row 0 is the top; ids and depth are there when asked for."""

    rgb: NDArray[np.uint8]
    ids: NDArray[np.int32] | None = None
    depth_m: NDArray[np.float32] | None = None
    """Distance along the optical axis; 0 where there is nothing."""


Content = object
"""What a picture was drawn from: where it is equal, so is the picture. None equals nothing that was drawn."""


class Renderer(Protocol):
    """Takes pictures of one scene. Belongs to the thread that made it."""

    name: str

    def update(self, body: Body) -> None:
        """Draw the body as it is now from the next picture on."""

    def set_robot(
        self, name: str, position_m: Vec3, yaw_rad: float, holding: bool = False, flies: bool = False
    ) -> None:
        """Put a robot there; position is where its feet are, below its centre."""

    def render(self, camera: Camera, with_ids: bool = False, with_depth: bool = False) -> Picture:
        """Take a picture."""

    def render_changed(
        self, camera: Camera, before: Content, with_depth: bool = False
    ) -> tuple[Content, Picture] | None:
        """The same with its content, or None when it would be the picture of the content given."""

    def close(self) -> None:
        """Give back what the renderer holds."""
