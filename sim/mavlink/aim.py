"""How a gimbal of two axes moves: to angles at a pace, or on and on; its yaw with the nose, or locked to north.

It keeps level by itself: pitch is above the horizon. Yaw is clockwise, from the nose or from north, without an end.
"""

import math
from dataclasses import dataclass

from sim.flight.state import Quaternion

PITCH_RANGE_RAD = (-math.pi / 2, math.pi / 6)
YAW_RANGE_RAD = (-math.pi, math.pi)
FASTEST_RADPS = math.radians(90)
_SLACK_RAD = 1e-3


def reaches(angle_rad: float, range_rad: tuple[float, float]) -> bool:
    """NaN is for where it is."""
    return math.isnan(angle_rad) or range_rad[0] - _SLACK_RAD <= angle_rad <= range_rad[1] + _SLACK_RAD


@dataclass(slots=True)
class Axis:
    """Where to and how fast; what it is to be at may move on at a rate."""

    to_rad: float = 0.0
    pace_radps: float = FASTEST_RADPS
    rate_radps: float = 0.0

    def ask(self, angle_rad: float, rate_radps: float, here_rad: float) -> None:
        """An angle, at a rate or as fast as it can; a rate alone, of which 0 is to stop; NaN for what is not asked."""
        bounded = max(-FASTEST_RADPS, min(FASTEST_RADPS, rate_radps))
        if not math.isnan(angle_rad):
            self.to_rad, self.rate_radps = angle_rad, 0.0
            self.pace_radps = abs(bounded) if not math.isnan(rate_radps) and rate_radps else FASTEST_RADPS
        elif not math.isnan(rate_radps):
            self.to_rad, self.rate_radps, self.pace_radps = here_rad, bounded, FASTEST_RADPS

    def advance(self, span_s: float) -> None:
        """Where it is to be moves on at the rate."""
        self.to_rad += self.rate_radps * span_s

    def bounded(self, missing_rad: float, span_s: float) -> float:
        """How far of what is missing it turns in this time."""
        return max(-self.pace_radps * span_s, min(self.pace_radps * span_s, missing_rad))


class Aim:
    """Where the camera looks, and is to look."""

    def __init__(self) -> None:
        self.pitch_rad = 0.0
        self.yaw_rad = 0.0
        """From the nose."""
        self.locked = False
        """It keeps its yaw from north while the vehicle turns beneath."""
        self.heading_rad = 0.0
        """Of the vehicle; set it before each step."""
        self._pitch, self._yaw = Axis(), Axis()

    @property
    def north_rad(self) -> float:
        """Its yaw from north."""
        return math.remainder(self.yaw_rad + self.heading_rad, math.tau)

    def turn(
        self, pitch_rad: float, yaw_rad: float, rates_radps: tuple[float, float], locked: bool, from_north: bool
    ) -> None:
        """`from_north`: whether that is where the given yaw is counted from; `locked`: whether it keeps it from there."""
        if locked != self.locked:
            self.locked = locked
            self._yaw.ask(self._own_yaw_rad, math.nan, 0.0)
        if from_north != locked:
            yaw_rad = math.remainder(yaw_rad + self.heading_rad * (1 if locked else -1), math.tau)
        self._pitch.ask(pitch_rad, rates_radps[0], self.pitch_rad)
        self._yaw.ask(yaw_rad, rates_radps[1], self._own_yaw_rad)

    @property
    def _own_yaw_rad(self) -> float:
        """In the axes that it keeps."""
        return self.north_rad if self.locked else self.yaw_rad

    def step(self, span_s: float) -> None:
        """Turn for this long."""
        least, most = PITCH_RANGE_RAD
        self._pitch.advance(span_s)
        self._yaw.advance(span_s)
        self._pitch.to_rad = max(least, min(most, self._pitch.to_rad))
        self.pitch_rad += self._pitch.bounded(self._pitch.to_rad - self.pitch_rad, span_s)
        missing = math.remainder(self._yaw.to_rad - self._own_yaw_rad, math.tau)
        self.yaw_rad = math.remainder(self.yaw_rad + self._yaw.bounded(missing, span_s), math.tau)

    @property
    def attitude(self) -> Quaternion:
        """Of the camera, yaw from where it keeps it, then pitch."""
        pitch, yaw = self.pitch_rad / 2, self._own_yaw_rad / 2
        cp, sp, cy, sy = math.cos(pitch), math.sin(pitch), math.cos(yaw), math.sin(yaw)
        return (cy * cp, -sy * sp, cy * sp, sy * cp)
