"""What a device's shell asks of the part that does the work."""

from dataclasses import dataclass
from typing import Literal, Protocol

from wire.messages.command import Command, DeviceCard, ReasonCode
from wire.model import Vec2, Vec3


@dataclass(frozen=True)
class Outcome:
    """How a skill ended."""

    status: Literal["done", "failed", "cancelled"]
    code: ReasonCode
    reason: str
    point_enu_m: Vec3 | None = None


@dataclass(frozen=True)
class Pose:
    """What a report says of the body."""

    position_enu_m: Vec3
    yaw_rad: float
    path_m: tuple[Vec2, ...]
    travelled_m: float
    action_steps: int
    holding: bool
    standing_by_order: bool
    held_up: bool = False
    """Not getting on because of other robots: standing by order, making way, or behind one that is in the way."""
    holding_type: str | None = None
    """What the gripper takes the thing in the hand for, if it can tell."""
    path_heights_m: tuple[float, ...] = ()
    """Of what flies: how high it will be at each point of its path."""
    velocity_enu_mps: Vec3 | None = None
    airborne: bool = False
    battery: float | None = None
    """What is left of it, 0 to 1."""
    endurance_s: float | None = None
    """How long a full one lasts at work, where that is known."""
    lost: bool = False
    """What moves the body does not answer: the rest is what it said last."""
    taken: bool = False
    """A person steers it: nothing can be asked of it until it is given back."""


class Worker(Protocol):
    """What actually does the work: one goal at a time."""

    def card(self, boot_id: str) -> DeviceCard: ...

    def fault_of(self, command: Command) -> str:
        """Why this command cannot be done by this device; empty when it can be tried."""

    def begin(self, command: Command) -> None: ...

    def work(self, now_s: float) -> Outcome | None:
        """One step of the goal."""

    def idle(self, now_s: float) -> None:
        """One step without a goal."""

    def halt(self) -> None:
        """Stand still, now."""

    def drop(self) -> None:
        """Forget the goal and stand still."""

    @property
    def committed(self) -> bool:
        """In the middle of something that cannot be taken back, such as a grasp."""

    @property
    def pose(self) -> Pose | None:
        """None before the body knows where it is."""

    @property
    def progress(self) -> tuple[float, str]: ...
