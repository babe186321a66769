"""What the drivers of hardware publish and take: cameras, legs, lidar, gripper. The simulator is one such driver.

Site frame: ENU, x east, y north, z up, metres. Body frame: FLU, x forward, y left, z up. Yaw: radians, from east,
counter-clockwise. Tilt of a camera: radians below the horizon.
"""

from typing import Literal

from pydantic import Field

from wire.model import Id, Message, Probability, Stamp, Text, Vec3, Word


class CameraFrame(Message):
    """One picture, with the camera's pose and intrinsics at the moment of exposure.

    `jpeg` holds the colour picture. `depth_mm`, when the camera measures depth, holds height x width unsigned
    16-bit little-endian millimetres along the optical axis, 0 where nothing was measured.
    """

    camera: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    width_px: int = Field(gt=0, le=4096)
    height_px: int = Field(gt=0, le=4096)
    focal_px: float = Field(gt=0.0)
    position_enu_m: Vec3
    yaw_rad: float
    tilt_down_rad: float
    jpeg: bytes = Field(max_length=4_000_000)
    depth_mm: bytes | None = Field(default=None, max_length=8_000_000)


class Odometry(Message):
    """Where a robot's own localisation says it is."""

    robot: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    position_enu_m: Vec3
    yaw_rad: float
    speed_mps: float = Field(ge=0.0)
    yaw_rate_radps: float
    in_contact: bool = False
    """The body touches something other than the floor."""


class LaserScan(Message):
    """A horizontal sweep of ranges in the body frame; a beam that hit nothing reports 0."""

    robot: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    position_enu_m: Vec3
    yaw_rad: float
    angle_min_rad: float
    angle_step_rad: float
    range_max_m: float = Field(gt=0.0)
    ranges_m: tuple[float, ...] = Field(max_length=2048)


class VelocityCommand(Message):
    """Body-frame velocity. The driver stops the robot when no command arrives for `timeout_s`."""

    robot: Id
    seq: int = Field(ge=0)
    forward_mps: float = Field(ge=-2.0, le=2.0)
    left_mps: float = Field(ge=-2.0, le=2.0)
    yaw_rate_radps: float = Field(ge=-4.0, le=4.0)
    camera_tilt_down_rad: float = Field(default=0.3, ge=-0.55, le=1.1)
    timeout_s: float = Field(default=0.5, gt=0.0, le=5.0)


GripperAction = Literal["pickup", "put", "open", "close", "toggle_on", "toggle_off", "slice", "clean"]


class GripperCommand(Message):
    """Manipulate whatever is at a point. The driver knows nothing of object ids: it reaches to the point."""

    robot: Id
    command_id: str = Field(max_length=64)
    action: GripperAction
    point_enu_m: Vec3
    expected_type: Word | None = None
    """What the caller believes is there; a gripper camera refuses when it plainly is something else."""


class GripperState(Message):
    """The last command's outcome, and what the hand holds (weight and camera tell that, not a name)."""

    robot: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    holding: bool
    holding_type: Word | None = None
    command_id: str | None = None
    busy: bool = False
    ok: bool | None = None
    reason: Text = ""
    point_enu_m: Vec3 | None = None
    """Where the hand let go or took hold."""


class DeviceReport(Message):
    """What a smart appliance says of itself (a television's plug, a fridge's door contact)."""

    device: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    type: Word
    position_enu_m: Vec3
    props: dict[Word, Probability]
