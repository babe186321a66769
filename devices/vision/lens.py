"""A camera at the moment of a picture: where it was, how it looked, and the rays and pixels that follow."""

from dataclasses import dataclass
from functools import cached_property
from math import radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wire.frames import camera_axes
from wire.messages.driver import CameraFrame
from wire.model import Vec3
from wire.site import Camera

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]
Depth = NDArray[np.float32]


@dataclass(frozen=True)
class Lens:
    """Pose and intrinsics of a pinhole camera; the optical centre is the middle of the picture."""

    width_px: int
    height_px: int
    focal_px: float
    position_enu_m: Vec3
    yaw_rad: float
    tilt_down_rad: float

    @classmethod
    def of_frame(cls, frame: CameraFrame) -> "Lens":
        return cls(
            frame.width_px,
            frame.height_px,
            frame.focal_px,
            frame.position_enu_m,
            frame.yaw_rad,
            frame.tilt_down_rad,
        )

    @classmethod
    def of_camera(cls, camera: Camera) -> "Lens":
        """The calibration that the site file gives for a fixed camera."""
        return cls(
            camera.width_px,
            camera.height_px,
            camera.focal_px,
            camera.position_enu_m,
            radians(camera.yaw_deg),
            radians(camera.tilt_down_deg),
        )

    @cached_property
    def axes(self) -> Floats:
        """Rows: the camera's right, down and forward unit vectors in ENU."""
        return np.array(camera_axes(self.yaw_rad, self.tilt_down_rad))

    def rays(self, u_px: Any, v_px: Any) -> Floats:
        """Directions in ENU, (N, 3), scaled to depth 1 along the optical axis."""
        x = (np.atleast_1d(np.asarray(u_px, dtype=np.float64)) - self.width_px / 2.0) / self.focal_px
        y = (np.atleast_1d(np.asarray(v_px, dtype=np.float64)) - self.height_px / 2.0) / self.focal_px
        right, down, forward = self.axes
        result: Floats = forward + x[:, None] * right + y[:, None] * down
        return result

    def pixels(self, points_enu_m: Any) -> Floats:
        """(N, 3): u, v and depth along the optical axis; u and v mean nothing where the depth is not positive."""
        delta = np.atleast_2d(np.asarray(points_enu_m, dtype=np.float64)) - np.array(self.position_enu_m)
        x, y, z = self.axes @ delta.T
        scale = self.focal_px / np.where(z > 1e-6, z, 1.0)
        return np.stack([self.width_px / 2.0 + x * scale, self.height_px / 2.0 + y * scale, z], axis=1)

    def floor_rows(self) -> Floats:
        """For every row of the picture one over the depth at which it meets the floor; negative above the horizon."""
        y = (np.arange(self.height_px) + 0.5 - self.height_px / 2.0) / self.focal_px
        _, down_z, forward_z = self.axes[:, 2]
        result: Floats = -(forward_z + y * down_z) / max(self.position_enu_m[2], 0.1)
        return result
