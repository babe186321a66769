"""What the firmware knows at one moment; every algorithm beside it reads this and says its texts here."""

import math
from dataclasses import dataclass, field
from typing import Literal

from sim.autopilot.geo import Origin
from sim.autopilot.interface import Command, Severity
from sim.autopilot.params import Params
from sim.autopilot.personality import Mode, Personality, Quantity
from sim.flight.state import Estimate, Vec3, Vehicle

CLEARANCE_M = 0.4
"""Nothing is aimed at higher than this below the ceiling."""
LOWEST_FLIGHT_M = 0.3
"""Take-off and return go at least this high."""
LOWEST_PLACE_M = 0.2
"""No place to fly to lies lower than this above the floor."""


@dataclass(slots=True)
class Situation:
    """Shared by the algorithms of one autopilot. Heights are above the floor, positions local NED."""

    vehicle: Vehicle
    row: Personality
    params: Params
    gps: Literal["fused", "none"]
    ceiling_m: float
    """Height of the ceiling; infinite outdoors."""
    origin: Origin | None
    mode: Mode
    custom_mode: int
    armed: bool = False
    armed_since_s: float = 0.0
    home_ned_m: Vec3 | None = None
    home_heading_rad: float = 0.0
    home_kept: bool = False
    """Set by somebody; arming does not move it."""
    rally_ned_m: tuple[Vec3, ...] = ()
    """Where it may land instead of at home."""
    speed_mps: float | None = None
    """Asked for by DO_CHANGE_SPEED; None: the parameter's."""
    region_ned_m: Vec3 | None = None
    """The region of interest."""
    nose_to_region: bool = False
    """The nose points there: it has no gimbal that would."""
    payload: list[Command] = field(default_factory=list)
    """What the mission wants of camera and gimbal, not handed on yet."""
    said: list[tuple[Severity, str]] = field(default_factory=list)

    def say(self, severity: Severity, text: str) -> None:
        self.said.append((severity, text))

    @property
    def estimate(self) -> Estimate:
        return self.vehicle.estimate

    @property
    def here(self) -> Vec3:
        return self.vehicle.estimate.position_ned_m

    @property
    def flying(self) -> bool:
        return self.armed and not self.vehicle.on_ground

    @property
    def located(self) -> bool:
        """Whether it knows where it is, across and in height."""
        estimate = self.vehicle.estimate
        return estimate.position_ok and estimate.height_ok and estimate.attitude_ok

    @property
    def home(self) -> Vec3:
        """Home, or where it stands as long as there is none."""
        return self.home_ned_m or self.here

    def above_start(self, height_m: float) -> float:
        """The down coordinate this high above home, and not lower above where it stands."""
        return min(self.home[2], self.here[2]) - height_m

    @property
    def refuge_ned_m(self) -> Vec3:
        """Where a return goes: home or a rally point, whichever is nearer."""
        north, east, _ = self.here
        return min((self.home, *self.rally_ned_m), key=lambda point: math.hypot(point[0] - north, point[1] - east))

    @staticmethod
    def above_floor(point: Vec3) -> Vec3:
        """The point, raised off the floor where it must be."""
        return point[0], point[1], min(point[2], -LOWEST_PLACE_M)

    def below_ceiling(self, point: Vec3) -> Vec3:
        """The point, lowered below the ceiling where it must be."""
        return point[0], point[1], max(point[2], self.top_down_m)

    def lowered(self, point: Vec3, what: str) -> Vec3:
        """The point below the ceiling; says of `what` that it is flown lower than asked."""
        if point[2] < self.top_down_m:
            self.say(Severity.NOTICE, f"{what}: flown at {-self.top_down_m:.1f} m, below the ceiling")
        return self.below_ceiling(point)

    @property
    def top_down_m(self) -> float:
        """The least (highest) down coordinate that may be aimed at."""
        return -max(self.ceiling_m - CLEARANCE_M, LOWEST_FLIGHT_M)

    def towards_region(self) -> float | None:
        """Heading to the region of interest; None without one, right above it, or where the gimbal looks there."""
        if self.region_ned_m is None or not self.nose_to_region:
            return None
        north, east = self.region_ned_m[0] - self.here[0], self.region_ned_m[1] - self.here[1]
        return math.atan2(east, north) if math.hypot(north, east) > 0.2 else None

    def quantity(self, name: Quantity) -> float:
        """In SI units, from this firmware's parameter."""
        parameter, factor = self.row.quantities[name]
        return self.params.get(parameter) * factor

    @property
    def cruise_mps(self) -> float:
        return self.quantity("cruise_mps") if self.speed_mps is None else self.speed_mps
