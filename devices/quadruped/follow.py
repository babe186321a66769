"""From a pose and a few straight legs to a velocity: turn on the spot at sharp corners, pursue the leg otherwise."""

from math import cos, hypot, sqrt

from wire.frames import bearing_rad, wrap_rad
from wire.model import Vec2

CRUISE_MPS = 0.8
NEAR_MPS = 0.5
"""Where something is near, as in doors."""
TURN_RADPS = 1.5
TURN_GAIN = 4.0
BRAKE_MPS2 = 0.8
SHARP_RAD, ALIGNED_RAD, FACING_RAD = 0.5, 0.2, 0.08
LOOKAHEAD_M = 0.45
CORNER_M, ARRIVED_M = 0.15, 0.05


def turn_rate(error_rad: float) -> float:
    """Yaw rate that takes out a heading error."""
    return max(-TURN_RADPS, min(TURN_RADPS, TURN_GAIN * error_rad))


class Follower:
    """Walks along `legs_m`, the corner points of a way that begins where the robot is."""

    def __init__(self, start_m: Vec2, legs_m: list[Vec2]) -> None:
        self._corners = [start_m, *legs_m]
        self._leg = 0
        self._turning = True
        self.turns = 0

    @property
    def begun(self) -> int:
        """Legs and turns on the spot so far: what is counted as actions."""
        return self.turns + min(self._leg + 1, len(self._corners) - 1)

    @property
    def left_m(self) -> tuple[Vec2, ...]:
        """Corners still ahead."""
        return tuple(self._corners[self._leg + 1 :])

    @property
    def arrived(self) -> bool:
        return self._leg >= len(self._corners) - 1

    def off_way_m(self, position_m: Vec2) -> float:
        """How far the robot is beside its leg."""
        if self.arrived:
            return 0.0
        return abs(self._on_leg(position_m)[1])

    def steer(self, position_m: Vec2, yaw_rad: float, limit_mps: float) -> tuple[float, float]:
        """(forward_mps, yaw_rate_radps); zeros when arrived."""
        self._advance(position_m)
        if self.arrived:
            return (0.0, 0.0)
        error = wrap_rad(bearing_rad(position_m, self._aim(position_m)) - yaw_rad)
        if abs(error) > SHARP_RAD and not self._turning:
            self._turning = True
        if self._turning and abs(error) > ALIGNED_RAD:
            self.turns += 0 if self._counted else 1
            self._counted = True
            return (0.0, turn_rate(error))
        self._turning = self._counted = False
        end = self._corners[self._leg + 1]
        braking = sqrt(2.0 * BRAKE_MPS2 * hypot(end[0] - position_m[0], end[1] - position_m[1]))
        slow_after = self._leg + 2 >= len(self._corners) or self._sharp_after()
        speed = min(limit_mps, max(0.12, braking)) if slow_after else limit_mps
        return (speed * max(0.2, cos(error)), turn_rate(error))

    _counted = False

    def _on_leg(self, position_m: Vec2) -> tuple[float, float, float]:
        """(along, beside, length) of the robot with respect to its leg, in metres."""
        (x0, y0), (x1, y1) = self._corners[self._leg], self._corners[self._leg + 1]
        length = max(1e-6, hypot(x1 - x0, y1 - y0))
        ux, uy = (x1 - x0) / length, (y1 - y0) / length
        dx, dy = position_m[0] - x0, position_m[1] - y0
        return (dx * ux + dy * uy, -dx * uy + dy * ux, length)

    def _advance(self, position_m: Vec2) -> None:
        while not self.arrived:
            along, beside, length = self._on_leg(position_m)
            last = self._leg + 2 == len(self._corners)
            near = hypot(length - along, beside) < (ARRIVED_M if last else CORNER_M)
            passed = along >= length and abs(beside) < (2.0 * CORNER_M)
            if not (near or passed):
                return
            self._leg += 1

    def _aim(self, position_m: Vec2) -> Vec2:
        along, _, length = self._on_leg(position_m)
        (x0, y0), (x1, y1) = self._corners[self._leg], self._corners[self._leg + 1]
        share = min(1.0, max(0.0, (along + LOOKAHEAD_M) / length))
        return (x0 + share * (x1 - x0), y0 + share * (y1 - y0))

    def _sharp_after(self) -> bool:
        a, b, c = self._corners[self._leg : self._leg + 3]
        return abs(wrap_rad(bearing_rad(b, c) - bearing_rad(a, b))) > SHARP_RAD
