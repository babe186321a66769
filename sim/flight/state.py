"""What a vehicle is told to do and what it says of itself. NED and FRD, SI units, seconds of simulated time.

Local NED has its origin at the site's origin; down is negative height above the floor.
"""

from dataclasses import dataclass, field
from typing import Protocol

Vec3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
"""(w, x, y, z), body FRD to NED."""
OptionalVec3 = tuple[float | None, float | None, float | None]
FREE: OptionalVec3 = (None, None, None)


@dataclass(frozen=True, slots=True)
class Off:
    """No thrust: rotors stand when disarmed and idle when armed."""


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Follow position, velocity and acceleration; an axis that is None in all three holds zero velocity.

    With a position and a velocity on one axis the velocity is fed forward.
    """

    position_ned_m: OptionalVec3 = FREE
    velocity_ned_mps: OptionalVec3 = FREE
    acceleration_ned_mps2: OptionalVec3 = FREE
    heading_rad: float | None = None
    """Clockwise from north; None keeps the heading, or turns at the rate."""
    heading_rate_radps: float | None = None
    max_speed_mps: float | None = None
    """Bounds the horizontal speed towards a position."""
    max_climb_mps: float | None = None
    max_descent_mps: float | None = None


@dataclass(frozen=True, slots=True)
class AttitudeTarget:
    """Hold an attitude, or with `attitude` None turn at the rates. Thrust 0 to 1, hover at about `Vehicle.hover_thrust`."""

    attitude: Quaternion | None
    rates_frd_radps: OptionalVec3
    thrust: float


Setpoint = Off | Trajectory | AttitudeTarget


@dataclass(slots=True)
class Estimate:
    """What the estimator believes: never ground truth."""

    stamp_s: float = 0.0
    position_ned_m: Vec3 = (0.0, 0.0, 0.0)
    velocity_ned_mps: Vec3 = (0.0, 0.0, 0.0)
    attitude: Quaternion = (1.0, 0.0, 0.0, 0.0)
    roll_rad: float = 0.0
    pitch_rad: float = 0.0
    heading_rad: float = 0.0
    rates_frd_radps: Vec3 = (0.0, 0.0, 0.0)
    position_std_m: float = 0.02
    velocity_std_mps: float = 0.02
    position_ok: bool = False
    """Horizontal position and velocity can be relied on (GPS-like fix or external pose is fresh)."""
    height_ok: bool = False
    attitude_ok: bool = False


@dataclass(slots=True)
class Battery:
    voltage_v: float = 16.6
    current_a: float = 0.0
    consumed_mah: float = 0.0
    remaining: float = 1.0
    """Part of the capacity, 0 to 1."""
    left_s: float | None = None
    """How long that lasts at what is drawn of late; None while the rotors rest."""


@dataclass(slots=True)
class Sensors:
    """The latest readings, with noise and bias."""

    accel_frd_mps2: Vec3 = (0.0, 0.0, -9.81)
    gyro_frd_radps: Vec3 = (0.0, 0.0, 0.0)
    mag_frd_gauss: Vec3 = (0.2, 0.0, 0.4)
    pressure_hpa: float = 1013.25
    temperature_degc: float = 25.0
    fix_ned_m: Vec3 | None = None
    """The indoor position system's latest fix, as a GPS receiver gives one; None without."""
    fix_velocity_ned_mps: Vec3 = (0.0, 0.0, 0.0)
    healthy: dict[str, bool] = field(default_factory=dict)
    """By name: gyro, accel, mag, baro, fix, battery."""


class Vehicle(Protocol):
    """What an autopilot flies. `sim.flight.quadrotor` is the one there is."""

    @property
    def estimate(self) -> Estimate: ...

    @property
    def battery(self) -> Battery: ...

    @property
    def sensors(self) -> Sensors: ...

    @property
    def on_ground(self) -> bool:
        """As a land detector concludes from thrust and estimate, not from contacts."""
        ...

    @property
    def tipped(self) -> bool:
        """Leaning too far to fly on."""
        ...

    @property
    def hover_thrust(self) -> float: ...

    @property
    def rotors(self) -> tuple[float, float, float, float]:
        """Throttle of each rotor, 0 to 1."""
        ...

    def arm(self) -> None: ...

    def disarm(self) -> None: ...

    def command(self, setpoint: Setpoint) -> None:
        """Followed until the next one."""
        ...

    def external_pose(self, stamp_s: float, position_ned_m: Vec3, heading_rad: float | None) -> bool:
        """A pose from outside (vision, motion capture), finite; whether the estimator believes it."""
        ...

    def fail(self, unit: str, works: bool) -> None:
        """Break or mend `fix`, `mag`, `baro`, `gyro`, `accel` or `battery`."""
        ...

    def set_battery(self, remaining: float | None, drain_s: float | None, voltage_v: float | None) -> None:
        """Provoke: set the charge (0 to 1), the seconds from full to empty, or pin the voltage; None leaves as it is."""
        ...
