"""All that differs between the two families of firmware: one row each, by MAVLink's numbers."""

from dataclasses import dataclass
from typing import Literal

from sim.autopilot.defaults import ARDUPILOT_PARAMS, PX4_PARAMS
from sim.autopilot.interface import Ack, Param

Mode = Literal["hold", "takeoff", "land", "return", "mission", "offboard", "position", "stabilize"]

Quantity = Literal[
    "cruise_mps", "fastest_mps", "climb_mps", "descent_mps", "landing_mps", "acceptance_m", "return_height_m"
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Listed:
    """One mode as ground stations are told of it."""

    custom_mode: int
    name: str
    standard: int = 0
    """MAV_STANDARD_MODE; 0 where it is none of them."""
    advanced: bool = False


@dataclass(frozen=True, slots=True)
class Personality:
    """What one firmware calls things and which of two habits it has."""

    name: Literal["ardupilot", "px4"]
    autopilot: int
    """MAV_AUTOPILOT of the heartbeat."""
    banner: str
    """Said as a status text to whoever connects."""
    firmware_version: int
    """AUTOPILOT_VERSION.flight_sw_version: major, minor, patch and type in a byte each."""
    capabilities: int
    """MAV_PROTOCOL_CAPABILITY."""
    modes: dict[Mode, int]
    """`custom_mode` in the heartbeat of each mode."""
    also: dict[int, Mode]
    """Further values of `custom_mode` that can be asked for, and what they fly as."""
    armable_modes: frozenset[Mode]
    """Modes in which it lets itself be armed."""
    refused: Ack
    """The result when the state does not allow what was asked."""
    param_encoding: Literal["cast", "bytewise"]
    """How an INT32 travels in PARAM_VALUE's float: converted, or bit for bit."""
    mission_request: Literal["float", "int"]
    """MISSION_REQUEST or MISSION_REQUEST_INT asks for the next item of an upload."""
    home_is_item_0: bool
    """A mission's item 0 is home: ignored in an upload, current home in a download."""
    home_streams: Literal["asked", "always"]
    """HOME_POSITION goes out once somebody has asked for it, or always."""
    estimator_message: Literal["EKF_STATUS_REPORT", "ESTIMATOR_STATUS"]
    takeoff: Literal["guided", "auto"]
    """NAV_TAKEOFF: armed and in guided mode to a height above home, or by itself to a parameter's height or to AMSL."""
    setpoint_stream: bool
    """Offboard needs a stream of setpoints to be entered and to stay; without, targets stay until the next."""
    unknown_items: frozenset[int]
    """MAV_CMD of mission items that only the other firmware knows."""
    unknown_mode: Ack
    """The result when there is no such mode."""
    inclusions: Literal["all", "any"]
    """Whether it must stay inside all of the fence's inclusions or inside any."""
    above_sea_level: frozenset[int]
    """MAV_CMD whose altitude in a global frame is taken for one above mean sea level, whatever the frame says."""
    listed: tuple[Listed, ...]
    """The modes that it tells ground stations of, in this order; none where it does not know that protocol."""
    quantities: dict[Quantity, tuple[str, float]]
    """The parameter that holds each, and the factor to SI units."""
    params: tuple[Param, ...]

    def mode(self, custom_mode: int) -> Mode | None:
        """Which mode a `custom_mode` asks for; None when there is no such mode."""
        for mode, number in self.modes.items():
            if number == custom_mode and not (mode == "takeoff" and self.takeoff == "guided"):
                return mode
        return self.also.get(custom_mode)

    def numbers(self, custom_mode: int) -> str:
        """A `custom_mode` as people write it: PX4's has two parts."""
        return (
            str(custom_mode) if self.name == "ardupilot" else f"{custom_mode >> 16 & 0xFF}, {custom_mode >> 24 & 0xFF}"
        )


def px4_mode(main: int, sub: int = 0) -> int:
    """PX4's `custom_mode` of a main and a sub mode."""
    return main << 16 | sub << 24


SHARED_CAPABILITIES = 1 | 4 | 8 | 64 | 128 | 256 | 2048 | 8192 | 16384 | 32768
"""Float and int missions, COMMAND_INT, attitude, local and global targets, termination, MAVLink 2, fence, rally."""

ARDUPILOT = Personality(
    name="ardupilot",
    autopilot=3,
    banner="ArduCopter V4.5.7 (R2X simulator)",
    firmware_version=4 << 24 | 5 << 16 | 7 << 8 | 255,
    capabilities=SHARED_CAPABILITIES | 2 | 131072,
    modes={
        "stabilize": 0,
        "mission": 3,
        "offboard": 4,
        "takeoff": 4,
        "hold": 5,
        "return": 6,
        "land": 9,
        "position": 16,
    },
    also={2: "position", 17: "hold", 21: "return"},
    armable_modes=frozenset({"stabilize", "offboard", "hold", "position"}),
    refused=Ack.FAILED,
    param_encoding="cast",
    mission_request="float",
    home_is_item_0=True,
    home_streams="asked",
    estimator_message="EKF_STATUS_REPORT",
    takeoff="guided",
    setpoint_stream=False,
    unknown_items=frozenset({4501}),  # CONDITION_GATE
    unknown_mode=Ack.FAILED,
    inclusions="all",
    above_sea_level=frozenset({34}),  # DO_ORBIT, as MAVSDK sends it: in a relative frame
    listed=(),
    quantities={
        "cruise_mps": ("WPNAV_SPEED", 0.01),
        "fastest_mps": ("WPNAV_SPEED", 0.01),
        "climb_mps": ("WPNAV_SPEED_UP", 0.01),
        "descent_mps": ("WPNAV_SPEED_DN", 0.01),
        "landing_mps": ("LAND_SPEED", 0.01),
        "acceptance_m": ("WPNAV_RADIUS", 0.01),
        "return_height_m": ("RTL_ALT", 0.01),
    },
    params=ARDUPILOT_PARAMS,
)

PX4 = Personality(
    name="px4",
    autopilot=12,
    banner="PX4 v1.15.4 (R2X simulator)",
    firmware_version=1 << 24 | 15 << 16 | 4 << 8 | 255,
    capabilities=SHARED_CAPABILITIES | 16,
    modes={
        "position": px4_mode(3),
        "takeoff": px4_mode(4, 2),
        "hold": px4_mode(4, 3),
        "mission": px4_mode(4, 4),
        "return": px4_mode(4, 5),
        "land": px4_mode(4, 6),
        "offboard": px4_mode(6),
        "stabilize": px4_mode(7),
    },
    also={px4_mode(1): "stabilize", px4_mode(2): "position", px4_mode(4): "hold", px4_mode(4, 1): "hold"},
    armable_modes=frozenset({"stabilize", "offboard", "hold", "position", "mission", "takeoff"}),
    refused=Ack.TEMPORARILY_REJECTED,
    param_encoding="bytewise",
    mission_request="int",
    home_is_item_0=False,
    home_streams="always",
    estimator_message="ESTIMATOR_STATUS",
    takeoff="auto",
    setpoint_stream=True,
    unknown_items=frozenset({82}),  # NAV_SPLINE_WAYPOINT
    unknown_mode=Ack.DENIED,
    inclusions="any",
    above_sea_level=frozenset({34, 195}),  # and DO_SET_ROI_LOCATION: PX4 does not look at the frame
    listed=(
        Listed(px4_mode(1), "Manual", advanced=True),
        Listed(px4_mode(2), "Altitude", standard=4),
        Listed(px4_mode(3), "Position", standard=1),
        Listed(px4_mode(4, 4), "Mission", standard=6),
        Listed(px4_mode(4, 3), "Hold"),
        Listed(px4_mode(4, 5), "Return", standard=5),
        Listed(px4_mode(4, 2), "Takeoff", standard=8),
        Listed(px4_mode(4, 6), "Land", standard=7),
        Listed(px4_mode(6), "Offboard", advanced=True),
        Listed(px4_mode(7), "Stabilized", advanced=True),
    ),
    quantities={
        "cruise_mps": ("MPC_XY_CRUISE", 1.0),
        "fastest_mps": ("MPC_XY_VEL_MAX", 1.0),
        "climb_mps": ("MPC_Z_V_AUTO_UP", 1.0),
        "descent_mps": ("MPC_Z_V_AUTO_DN", 1.0),
        "landing_mps": ("MPC_LAND_SPEED", 1.0),
        "acceptance_m": ("NAV_ACC_RAD", 1.0),
        "return_height_m": ("RTL_RETURN_ALT", 1.0),
    },
    params=PX4_PARAMS,
)

PERSONALITIES = {row.name: row for row in (ARDUPILOT, PX4)}
