"""How far off a robot's own localisation is: errors that wander smoothly about zero (Ornstein-Uhlenbeck)."""

from math import exp, radians, sqrt
from random import Random

POSITION_SIGMA_M = 0.01
YAW_SIGMA_RAD = radians(0.3)
CORRELATION_S = 2.0


class Drift:
    """Errors along x, y and in yaw; stationary, so that they never grow."""

    def __init__(self, seed: str) -> None:
        self._random = Random(seed)
        self._unit = [self._random.gauss(0.0, 1.0) for _ in range(3)]

    def advance(self, step_s: float) -> None:
        keep = exp(-step_s / CORRELATION_S)
        fresh = sqrt(1.0 - keep * keep)
        self._unit = [keep * u + fresh * self._random.gauss(0.0, 1.0) for u in self._unit]

    @property
    def x_m(self) -> float:
        return POSITION_SIGMA_M * self._unit[0]

    @property
    def y_m(self) -> float:
        return POSITION_SIGMA_M * self._unit[1]

    @property
    def yaw_rad(self) -> float:
        return YAW_SIGMA_RAD * self._unit[2]
