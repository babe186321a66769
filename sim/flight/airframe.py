"""An indoor quadrotor in X with guarded propellers: 1.3 kg, 0.4 m across. Rotors, drag and ground effect.

Rotors, seen from above, front up: 0 front right and 1 rear left turn counter-clockwise, 2 front left and 3 rear right
clockwise (the order of the two firmware families that the wire speaks for). Body axes are FRD.
"""

from math import exp, sqrt

from sim.bullet import GRAVITY_MPS2
from sim.flight.state import Vec3

MASS_KG = 1.3
HALF_M: Vec3 = (0.2, 0.2, 0.06)
INERTIA_KGM2: Vec3 = (0.0135, 0.0135, 0.024)
ARM_M = 0.12
"""Of each rotor from the middle, along both axes."""
MAX_THRUST_N = 6.7
"""Of one rotor, at 16 V."""
TORQUE_PER_THRUST_M = 0.016
MOTOR_LAG_S = 0.03
ROTOR_RADIUS_M = 0.11
ROTOR_HEIGHT_M = 0.1
"""Above the feet."""
POWER_W = 137.0
"""Of one rotor at full speed and 16 V; power goes with the cube of both."""
AVIONICS_W = 6.0
DRAG_NPMPS, DRAG_NPMPS2 = 0.18, 0.05
IDLE = 0.12
"""Rotor speed of an armed vehicle that wants no thrust."""
HOVER_THRUST = MASS_KG * GRAVITY_MPS2 / (4.0 * MAX_THRUST_N)
_MOST_GROUND_EFFECT = 1.3


class Rotors:
    """Speeds as parts of the full one; thrust goes with their square."""

    __slots__ = ("_keep", "speeds")

    def __init__(self, step_s: float) -> None:
        self.speeds = [0.0, 0.0, 0.0, 0.0]
        self._keep = exp(-step_s / MOTOR_LAG_S)

    def step(self, thrusts: tuple[float, float, float, float] | None, idle: bool) -> None:
        """Follow the wished thrusts (0 to 1 each); None for none."""
        keep, speeds = self._keep, self.speeds
        least = IDLE if idle else 0.0
        for k in (0, 1, 2, 3):
            wish = sqrt(thrusts[k]) if thrusts is not None else 0.0
            wish = wish if wish > least else least
            speeds[k] = wish + keep * (speeds[k] - wish)

    def wrench(self, voltage_v: float, height_m: float) -> tuple[float, float, float, float]:
        """Thrust in newtons and torques about x, y, z (FRD) in newton metres, feet `height_m` above the floor."""
        full = MAX_THRUST_N * (voltage_v / 16.0) ** 2
        if height_m < 0.6:
            full *= ground_effect(height_m)
        a, b, c, d = self.speeds
        a, b, c, d = full * a * a, full * b * b, full * c * c, full * d * d
        return (
            a + b + c + d,
            ARM_M * (-a + b + c - d),
            ARM_M * (a - b + c - d),
            TORQUE_PER_THRUST_M * (a + b - c - d),
        )

    def power_w(self, voltage_v: float) -> float:
        """Electrical: a lower voltage needs more throttle for the same thrust, not more power."""
        a, b, c, d = self.speeds
        return POWER_W * (voltage_v / 16.0) ** 3 * (a * a * a + b * b * b + c * c * c + d * d * d)


def ground_effect(height_m: float) -> float:
    """How much more a rotor lifts near the floor (Cheeseman and Bennett 1955)."""
    ratio = ROTOR_RADIUS_M / (4.0 * (max(height_m, 0.0) + ROTOR_HEIGHT_M))
    return min(_MOST_GROUND_EFFECT, 1.0 / (1.0 - min(0.9, ratio) ** 2))


def mix(thrust: float, roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Thrusts of the rotors, each 0 to 1, from wishes in the same unit per rotor.

    When they do not fit, yaw gives way first, then roll and pitch are scaled, last the collective is moved: a vehicle
    that cannot climb stays upright.
    """
    a, b, c, d = -roll + pitch, roll - pitch, roll + pitch, -roll - pitch
    span = max(a, b, c, d) - min(a, b, c, d)
    if span > 1.0:
        a, b, c, d = a / span, b / span, c / span, d / span
        span = 1.0
    room = (1.0 - span) / 2.0
    yaw = max(-room, min(room, yaw))
    a, b, c, d = a + yaw, b + yaw, c - yaw, d - yaw
    low, high = min(a, b, c, d), max(a, b, c, d)
    thrust = max(-low, min(1.0 - high, thrust))
    return (_unit(thrust + a), _unit(thrust + b), _unit(thrust + c), _unit(thrust + d))


def _unit(value: float) -> float:
    return 0.0 if value < 0.0 else 1.0 if value > 1.0 else value
