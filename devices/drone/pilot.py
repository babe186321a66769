"""Between a drone's core and its autopilot: orders go one way, news comes the other. Places and yaws are the site's."""

from dataclasses import dataclass
from typing import Literal, Protocol

from wire.model import Vec3

Landed = Literal["unknown", "on_ground", "in_air", "taking_off", "landing"]
Firmware = Literal["ardupilot", "px4", "unknown"]


@dataclass(frozen=True, slots=True)
class Setpoint:
    """Be there, moving like that, facing there."""

    position_enu_m: Vec3
    velocity_enu_mps: Vec3
    yaw_rad: float


@dataclass(frozen=True, slots=True)
class Arm:
    """Let the rotors run."""


@dataclass(frozen=True, slots=True)
class Disarm:
    """Stop the rotors; refused in the air."""


@dataclass(frozen=True, slots=True)
class TakeOff:
    height_m: float
    """Above where it stands."""


@dataclass(frozen=True, slots=True)
class Land:
    """Down, where it is."""


@dataclass(frozen=True, slots=True)
class Steer:
    """Take setpoints from now on, this one first; what follows goes through `Pilot.fly`."""

    setpoint: Setpoint


@dataclass(frozen=True, slots=True)
class Hover:
    """Stay there without any more setpoints."""

    setpoint: Setpoint


@dataclass(frozen=True, slots=True)
class Shoot:
    """Take a picture with the vehicle's camera."""


Order = Arm | Disarm | TakeOff | Land | Steer | Hover | Shoot


@dataclass(frozen=True, slots=True)
class Telemetry:
    """What the autopilot says of itself. The drone is heard from whenever one of these comes."""

    position_enu_m: Vec3 | None
    """None before the first, and when none has come for a while."""
    velocity_enu_mps: Vec3
    yaw_rad: float
    armed: bool
    landed: Landed
    mode: str
    """MAVSDK's names: HOLD, OFFBOARD, RETURN_TO_LAUNCH, LAND, ..."""
    battery: float | None
    """What is left of it, 0 to 1."""
    located: bool
    """The autopilot trusts its own position."""
    armable: bool
    battery_left_s: float | None = None
    """How long it believes that its battery keeps it in the air; None where it does not say."""


@dataclass(frozen=True, slots=True)
class Found:
    """An autopilot is at the other end of the link. `fault`: why it cannot be flown from here; empty when it can."""

    system: int
    firmware: Firmware
    fault: str = ""


@dataclass(frozen=True, slots=True)
class Answered:
    """What came of an order; an empty `reason` is success."""

    order: int
    reason: str


@dataclass(frozen=True, slots=True)
class Said:
    """A status text of the autopilot. `urgent` from warnings on."""

    text: str
    urgent: bool


@dataclass(frozen=True, slots=True)
class Pictured:
    """The camera says that it has taken a picture, or that it could not."""

    index: int
    ok: bool


@dataclass(frozen=True, slots=True)
class NoLink:
    """The link cannot be opened; it is tried again."""

    reason: str


News = Telemetry | Found | Answered | Said | Pictured | NoLink


class Pilot(Protocol):
    """What flies one drone. `devices.drone.client` does it with MAVSDK."""

    def start(self) -> None:
        """Begin to look for the autopilot, and go on for ever."""

    def ask(self, order: Order) -> int:
        """Give an order and return its number at once; `Answered` comes with the news."""

    def fly(self, setpoint: Setpoint) -> None:
        """Replace the setpoint that is being sent. Only the newest counts."""

    def news(self) -> list[News]:
        """What has come since the last call, oldest first. Never waits."""

    def stop(self) -> None:
        """Let orders that were given go out, and end."""
