"""The fused world state W = (robots, objects, areas): equations 1 to 4 of the first paper, with provenance."""

from typing import Annotated, Literal

from pydantic import Field

from wire.messages.observation import Covariance
from wire.model import Id, Message, Probability, Stamp, Text, Vec2, Vec3, Word, unset

RobotStatus = Literal["idle", "executing", "canceling", "holding", "lost", "fault"]
YawDeg = Annotated[float, Field(ge=0.0, lt=360.0)]


class RobotState(Message):
    """Equation 2: id, position, yaw in [0, 360), status, payload, skills."""

    id: Id
    kind: Word
    position_enu_m: Vec3
    yaw_deg: YawDeg
    status: RobotStatus
    inventory: str | None = None
    """Id of the object carried."""
    skills: tuple[Word, ...] = ()
    stamp_s: Stamp
    room: Id | None = None
    path_m: tuple[Vec2, ...] = ()
    """What is left of the path being followed."""
    goal_id: str | None = None
    travelled_m: float = Field(default=0.0, ge=0.0)
    action_steps: int = Field(default=0, ge=0)
    airborne: bool = Field(default=False, exclude_if=unset)
    """Off the ground: `position_enu_m` says how high."""
    battery: Probability | None = Field(default=None, exclude_if=unset)
    """What is left of it, where the robot can tell."""


class PropertyState(Message):
    """One entry of the vector pi of equation 3, with who said so and when."""

    value: bool
    confidence: Probability
    source: Id
    stamp_s: Stamp
    contradicted_by: tuple[Id, ...] = ()


class ObjectState(Message):
    """Equation 3: id, type, position, parent receptacle, properties, room, source, time."""

    id: Id
    type: Word
    position_enu_m: Vec3
    covariance_m2: Covariance
    receptacle: str | None = None
    """Id of the receptacle, robot or None. Contents of a closed receptacle cannot be reached."""
    props: dict[Word, PropertyState] = {}
    room: Id | None = None
    source: Id
    stamp_s: Stamp
    confidence: Probability
    seen_by: tuple[Id, ...] = ()
    verified: bool = False
    """A robot has seen it from close by, or handled it."""
    maybe: dict[Word, Probability] = {}
    """Other types that a good part of the looks took it for."""
    seen_from_above: bool = Field(default=False, exclude_if=unset)
    """A robot has hovered over it in the current task and looked down."""
    looked_into: bool = Field(default=False, exclude_if=unset)
    """A robot has looked into it, open, in the current task."""


class AreaState(Message):
    """A room: how much of its floor has been looked at, by whom, when."""

    id: Id
    name: Text
    kind: Word
    seen_fraction: Probability
    camera_fraction: Probability
    """The part that fixed cameras watch all the time."""
    stamp_s: Stamp | None = None
    source: Id | None = None
    searched: bool = False
    """A robot has gone through this room and looked at all of it in the current task."""
    searches: int = Field(default=0, ge=0)
    """How many robots have gone through it to the end in the current task."""
    seen_from_above: bool = Field(default=False, exclude_if=unset)
    """A robot has hovered in this room in the current task and looked down."""
    surveyed: bool = Field(default=False, exclude_if=unset)
    """A robot has flown over all of it in lanes in the current task."""


class WorldState(Message):
    """W_t, with the number of the last change it contains."""

    seq: int = Field(ge=0)
    stamp_s: Stamp
    robots: tuple[RobotState, ...] = ()
    objects: tuple[ObjectState, ...] = ()
    areas: tuple[AreaState, ...] = ()


class WorldDelta(Message):
    """What changed since delta `seq - 1`."""

    seq: int = Field(ge=1)
    stamp_s: Stamp
    robots: tuple[RobotState, ...] = ()
    objects: tuple[ObjectState, ...] = ()
    areas: tuple[AreaState, ...] = ()
    removed: tuple[Id, ...] = ()


class SnapshotRequest(Message):
    """Ask for the whole of W."""
