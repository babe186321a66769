"""What the wire asks of an autopilot and what it hears back. Plain data; enumerations by MAVLink's numbers."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Literal, Protocol

from sim.flight.state import Battery, Estimate, Quaternion, Sensors, Vec3


class Ack(IntEnum):
    """MAV_RESULT."""

    ACCEPTED = 0
    TEMPORARILY_REJECTED = 1
    DENIED = 2
    UNSUPPORTED = 3
    FAILED = 4
    IN_PROGRESS = 5
    CANCELLED = 6
    LONG_ONLY = 7
    INT_ONLY = 8
    UNSUPPORTED_FRAME = 9


class Severity(IntEnum):
    """MAV_SEVERITY."""

    EMERGENCY = 0
    ALERT = 1
    CRITICAL = 2
    ERROR = 3
    WARNING = 4
    NOTICE = 5
    INFO = 6
    DEBUG = 7


@dataclass(frozen=True, slots=True)
class Command:
    """COMMAND_LONG or COMMAND_INT. Parameters may be NaN, which means unused; x and y are params 5 and 6 (degrees for
    global frames, metres for local ones), z is param 7."""

    id: int
    params: tuple[float, float, float, float]
    x: float
    y: float
    z: float
    frame: int | None
    """MAV_FRAME of a COMMAND_INT; None for a COMMAND_LONG."""


@dataclass(frozen=True, slots=True)
class Answer:
    """The acknowledgement, at once. `IN_PROGRESS` is followed by `Autopilot.progress` until it ends."""

    result: Ack
    text: str = ""
    """Said as a status text as well when not empty."""


@dataclass(frozen=True, slots=True)
class PositionTarget:
    """SET_POSITION_TARGET_LOCAL_NED or _GLOBAL_INT after scaling; every field finite unless its triple is masked out.

    `frame` is the MAV_FRAME as sent; for a global one `x`, `y` are degrees and `z` metres.
    """

    frame: int
    type_mask: int
    position: Vec3
    velocity_mps: Vec3
    acceleration_mps2: Vec3
    yaw_rad: float
    yaw_rate_radps: float


@dataclass(frozen=True, slots=True)
class AttitudeSetpoint:
    """SET_ATTITUDE_TARGET."""

    type_mask: int
    attitude: Quaternion
    rates_frd_radps: Vec3
    thrust: float


@dataclass(frozen=True, slots=True)
class Item:
    """One item of a mission, fence or rally plan: degrees for global frames, metres for local ones."""

    seq: int
    frame: int
    command: int
    current: bool
    autocontinue: bool
    params: tuple[float, float, float, float]
    x: float
    y: float
    z: float


Plan = Literal[0, 1, 2]
"""MAV_MISSION_TYPE: mission, fence, rally."""


@dataclass(frozen=True, slots=True)
class Param:
    """One parameter. `integer` ones are MAV_PARAM_TYPE_INT32, others REAL32."""

    name: str
    value: float
    integer: bool
    least: float
    most: float
    read_only: bool = False


@dataclass(frozen=True, slots=True)
class Telemetry:
    """Everything that streams are made of, at one moment."""

    now_s: float
    armed: bool
    base_mode: int
    custom_mode: int
    system_status: int
    """MAV_STATE: 3 standby, 4 active, 5 critical."""
    landed_state: int
    """MAV_LANDED_STATE: 1 on ground, 2 in air, 3 taking off, 4 landing."""
    estimate: Estimate
    battery: Battery
    sensors: Sensors
    rotors: tuple[float, float, float, float]
    home_ned_m: Vec3 | None
    home_heading_rad: float
    origin: tuple[float, float, float] | None
    """(latitude deg, longitude deg, altitude m AMSL) of local NED's origin; None when none is known."""
    global_fix: bool
    """Whether positions go out as global ones (GPS bit, fix type 3)."""
    armable: bool
    present: int
    enabled: int
    health: int
    """MAV_SYS_STATUS_SENSOR masks."""
    ekf_flags: int
    """EKF_STATUS_FLAGS."""
    mission_current: int
    mission_count: int
    """With home where that is item 0."""
    target_ned_m: Vec3 | None
    region_ned_m: Vec3 | None
    """The region of interest."""
    fence_breach: str
    """What of the fence is crossed, in words; empty while nothing is."""
    fence_breaches: int
    """How many times one began since it was switched on."""
    fence_breached_s: float
    """When the last one began."""


class Autopilot(Protocol):
    """One vehicle's firmware, without sockets. `sim.autopilot.firmware` is the one there is."""

    sysid: int

    def step(self, now_s: float) -> None:
        """Decide once; call at every physics step or at least at 50 Hz, before the vehicle steps."""
        ...

    def telemetry(self, now_s: float) -> Telemetry: ...

    def texts(self) -> list[tuple[Severity, str]]:
        """Status texts said since the last call."""
        ...

    def reached(self) -> list[int]:
        """Mission items reached since the last call."""
        ...

    def payload(self) -> list[Command]:
        """What the mission wants of camera and gimbal, since the last call."""
        ...

    def progress(self) -> list[tuple[int, Ack, int]]:
        """(command, result, percent) of commands that were in progress, since the last call."""
        ...

    def changed_params(self) -> list[Param]:
        """Parameters that the autopilot itself changed since the last call."""
        ...

    def command(self, command: Command, now_s: float) -> Answer: ...

    def set_mode(self, base_mode: int, custom_mode: int, now_s: float) -> Answer:
        """SET_MODE and DO_SET_MODE after unpacking: `custom_mode` as it stands in a heartbeat."""
        ...

    def position_target(self, target: PositionTarget, now_s: float) -> None: ...

    def attitude_target(self, target: AttitudeSetpoint, now_s: float) -> None: ...

    def external_pose(self, position_ned_m: Vec3, heading_rad: float | None, now_s: float) -> None: ...

    def set_origin(self, latitude_deg: float, longitude_deg: float, altitude_m: float) -> bool: ...

    def manual(self, roll: float, pitch: float, throttle: float, yaw: float, now_s: float, sysid: int) -> bool:
        """MANUAL_CONTROL or RC override of the station `sysid`: -1 to 1 each, throttle 0 to 1. Whether its sticks count
        at all."""
        ...

    def heard_station(self, now_s: float, sysid: int) -> None:
        """A heartbeat of the ground station `sysid` came."""
        ...

    def params(self) -> list[Param]:
        """All, in the order of their indices."""
        ...

    def set_param(self, name: str, value: float) -> Param | str:
        """The parameter as it now is, or a sentence why it is not: unknown, read-only, not finite, out of range."""
        ...

    def plan(self, kind: Plan) -> list[Item]:
        """What a download gives; with item 0 as home where the personality has that."""
        ...

    def check_item(self, kind: Plan, item: Item) -> int:
        """MAV_MISSION_RESULT of one uploaded item: 0 accepted, 3 unsupported, 1..15 as the protocol says."""
        ...

    def accept_plan(self, kind: Plan, items: list[Item]) -> int:
        """Take a whole upload; MAV_MISSION_RESULT. On anything but 0 the old plan stays."""
        ...

    def clear_plan(self, kind: Plan) -> int: ...

    def set_current(self, seq: int) -> bool: ...
