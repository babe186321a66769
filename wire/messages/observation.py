"""What a source claims to have seen: the u_t of equation 5 of the first paper."""

from typing import Annotated, Literal

from pydantic import Field

from wire.model import Id, Message, Probability, Stamp, Text, Vec2, Vec3, Word

Covariance = tuple[
    Annotated[float, Field(ge=0.0)], float, Annotated[float, Field(ge=0.0)], Annotated[float, Field(ge=0.0)]
]
"""Variances and covariance in m^2: (xx, xy, yy, zz)."""

BoxPx = tuple[float, float, float, float]
"""left, top, right, bottom in pixels."""


class ObjectObservation(Message):
    """One object in one picture. `track` is the source's own name for it, stable while the source keeps sight."""

    track: Annotated[str, Field(max_length=16)]
    type: Word
    confidence: Probability
    position_enu_m: Vec3
    """Centre of the object."""
    covariance_m2: Covariance
    props: dict[Word, Probability] = {}
    """Probability that a property of equation 4 (isOpen, isToggled, ...) is true; absent when it cannot be seen."""
    box_px: BoxPx | None = None


class Absence(Message):
    """Something that this source saw, could see again, and does not: evidence that it has gone."""

    track: Annotated[str, Field(max_length=16)]
    type: Word
    position_enu_m: Vec3
    confidence: Probability


class View(Message):
    """The piece of floor that the source could see well enough to notice a small object there."""

    origin_enu_m: Vec3
    polygon_m: tuple[Vec2, ...] = Field(max_length=64)
    yaw_rad: float
    hfov_rad: float = Field(gt=0.0, le=6.3)
    range_m: float = Field(gt=0.0)


class ObservationBatch(Message):
    """Everything one source noticed in one picture."""

    source: Id
    boot_id: str = Field(max_length=32)
    seq: int = Field(ge=0)
    stamp_s: Stamp
    kind: Literal["cctv", "robot", "device"]
    objects: tuple[ObjectObservation, ...] = Field(default=(), max_length=512)
    gone: tuple[Absence, ...] = Field(default=(), max_length=512)
    view: View | None = None


class EventLog(Message):
    """One line of the time-stamped text log that a source keeps of what changed before it."""

    source: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    text: Text
