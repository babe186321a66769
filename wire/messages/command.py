"""Goals for one robot: accepted or refused at once, then progress, then exactly one result; cancellable."""

from typing import Literal

from pydantic import Field

from wire.messages.plan import Action, Param, SkillCard
from wire.messages.world import RobotStatus
from wire.model import Id, Message, Probability, Stamp, Text, Vec2, Vec3, Word, unset


class Target(Message):
    """What the hub believes of the thing to act on."""

    id: Id
    type: Word
    position_enu_m: Vec3
    spread_m: float = Field(ge=0.0)
    """One standard deviation of the position in the floor plane."""
    room: Id | None = None
    inside: "Target | None" = None
    """The receptacle it is in or on."""


class Command(Message):
    """One skill for one robot. The same `goal_id` again changes nothing and answers with the current state."""

    goal_id: str = Field(pattern=r"^[a-z0-9-]{1,64}$")
    epoch: int = Field(ge=0)
    """Of the hub's run; a device refuses an epoch lower than one it has seen."""
    robot: Id
    action: Action
    target: Target | None = None
    item: Target | None = None
    room: Id | None = None
    point_m: Vec2 | None = None
    looking_for: tuple[Word, ...] = ()
    params: dict[Word, Param] = {}
    """The skill's own parameters, as its card announces them."""
    valid_until_s: Stamp
    """Not started after this."""
    timeout_s: float = Field(gt=0.0)
    """From its start. Waiting for other robots does not count, but no longer than this again."""


GoalStatus = Literal["accepted", "running", "done", "failed", "cancelled", "expired", "interrupted"]
ReasonCode = Literal[
    "ok",
    "not_there",
    "unreachable",
    "blocked",
    "precondition",
    "hand_full",
    "not_holding",
    "closed",
    "already",
    "timeout",
    "lost_hub",
    "cancelled",
    "interrupted",
    "refused",
    "driver",
]


class CommandAck(Message):
    """Durable: written to the device's journal before it is sent."""

    goal_id: str
    accepted: bool
    status: GoalStatus | None = None
    reason: Text = ""


class Progress(Message):
    goal_id: str
    robot: Id
    stamp_s: Stamp
    fraction: float = Field(ge=0.0, le=1.0)
    note: Text = ""


class Result(Message):
    """The end of a goal. `point_enu_m`: where the thing was found, taken or put."""

    goal_id: str
    robot: Id
    stamp_s: Stamp
    status: Literal["done", "failed", "cancelled", "expired", "interrupted"]
    code: ReasonCode
    reason: Text = ""
    point_enu_m: Vec3 | None = None
    holding: bool = False
    travelled_m: float = Field(default=0.0, ge=0.0)
    action_steps: int = Field(default=0, ge=0)


class CancelRequest(Message):
    """Stop the goal, or whatever runs when `goal_id` is None."""

    robot: Id
    goal_id: str | None = None
    epoch: int = Field(ge=0)


class GoalsRequest(Message):
    """Ask a device for every goal it remembers (after a restart of the hub)."""


class GoalRecord(Message):
    goal_id: str
    status: GoalStatus
    code: ReasonCode = "ok"
    reason: Text = ""
    point_enu_m: Vec3 | None = None


class GoalsReply(Message):
    robot: Id
    boot_id: str
    epoch: int
    goals: tuple[GoalRecord, ...] = ()


class RobotReport(Message):
    """Ten a second from a robot's own loop."""

    robot: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    position_enu_m: Vec3
    yaw_rad: float
    status: RobotStatus
    holding: bool = False
    holding_type: Word | None = None
    """What its gripper takes the thing in the hand for, if it can tell."""
    goal_id: str | None = None
    path_m: tuple[Vec2, ...] = ()
    travelled_m: float = Field(default=0.0, ge=0.0)
    action_steps: int = Field(default=0, ge=0)
    velocity_enu_mps: Vec3 | None = None
    airborne: bool = False
    """Off the ground: `position_enu_m` says how high."""
    battery: Probability | None = None
    """What is left of it, where the robot can tell."""
    path_heights_m: tuple[float, ...] = Field(default=(), exclude_if=unset)
    """Of what flies: how high it will be at each point of `path_m`."""
    endurance_s: float | None = Field(default=None, gt=0.0, exclude_if=unset)
    """How long a full battery lasts at work, where the robot has been told or has learned it."""


class TrafficOrder(Message):
    """Where a robot may be, decided by the hub so that robots neither collide nor block each other in doors."""

    robot: Id
    seq: int = Field(ge=0)
    stamp_s: Stamp
    go: bool
    """False: stand still where you are."""
    step_aside_m: Vec2 | None = None
    """Go there first: you are in somebody's way."""
    others_m: tuple[Vec2, ...] = ()
    """The other robots' positions, to be kept clear of."""
    because: Text = ""
    height_m: float | None = Field(default=None, exclude_if=unset)
    """For what flies where others fly: travel at this height, which is a level of your own."""
    column_taken: bool = Field(default=False, exclude_if=unset)
    """For what flies: neither take off nor land here now, somebody stands or passes above or below."""
    land_at_m: Vec2 | None = Field(default=None, exclude_if=unset)
    """While somebody stands below: a free place near by to land at instead."""


class DeviceCard(Message):
    """Who a device is and what it can do."""

    id: Id
    """That of its process in the site file: commands are sent to this id."""
    kind: Word
    boot_id: str
    skills: tuple[SkillCard, ...] = ()
    payload_kg: float = Field(default=0.0, ge=0.0)
    radius_m: float = Field(default=0.0, ge=0.0)
    speed_mps: float = Field(default=0.0, ge=0.0)


class CardRequest(Message):
    """Ask a device for its card."""
