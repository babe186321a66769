"""What one picture told the robot, in the terms of its skills. No perception here, so that skills need none."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, TypeAlias

from wire.frames import distance_m
from wire.messages.driver import CameraFrame
from wire.messages.observation import ObservationBatch
from wire.model import Vec2, Vec3

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Points: TypeAlias = "NDArray[np.float32]"
CLEAR_VIEW = 0.75
"""At the sides of a picture things are cut off."""
FAR_M, FAR_FOR_SMALL_M = 3.0, 2.2
"""Small things further off are a few pixels, which the detector often misses."""


@dataclass(frozen=True)
class Thing:
    """Something recognised in one picture."""

    type: str
    confidence: float
    position_enu_m: Vec3
    props: dict[str, float]
    maybe: dict[str, float] = field(default_factory=dict)
    """What else it may be, with a confidence each: reason enough to go nearer and look again."""


@dataclass(frozen=True)
class Look:
    """One picture."""

    stamp_s: float
    camera_m: Vec2
    yaw_rad: float
    hfov_rad: float
    things: tuple[Thing, ...]
    surface_m: Points
    """(N, 3): a sample of the surfaces that the depth camera measured."""

    def nearest(self, type: str, point_enu_m: Vec3, within_m: float) -> Thing | None:
        """The thing of this type that is nearest to where it is believed to be."""
        near = [t for t in self.things if t.type == type and distance_m(t.position_enu_m, point_enu_m) <= within_m]
        return min(near, key=lambda t: distance_m(t.position_enu_m, point_enu_m), default=None)


class Eyes(Protocol):
    """Turns pictures into looks, and into what is reported to everybody."""

    def look(self, frame: CameraFrame, carrying: bool, boot_id: str) -> tuple[Look, ObservationBatch] | None:
        """None when the frame holds no picture."""
