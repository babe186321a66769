"""A robot's legs and senses of place as their driver has them: takes velocities, gives odometry and laser scans."""

from math import atan2, cos, sin

from sim.lidar import ANGLE_MIN_RAD, ANGLE_STEP_RAD, HEIGHT_M, RANGE_M, Lidar
from sim.odometry import Drift
from sim.physics import Physics
from sim.rover import Wish
from wire.bus import Node
from wire.messages.driver import LaserScan, Odometry, VelocityCommand

SCAN_HZ = 5.0
STANDING_HZ = 4.0
"""Where a robot stands is told this often, where it moves at every step; and so often is it looked around from there."""
SAME_SCAN_S = 1.0
"""From where it stands, what has not changed is told again after this."""
STANDS_MPS, STANDS_RADPS = 0.005, 0.01


class Locomotion:
    """The estimated position is the point on the floor below the body's centre."""

    def __init__(self, robot: str, physics: Physics, seed: int, step_s: float) -> None:
        self.id = robot
        self._physics = physics
        self._rover = physics.robots[robot]
        self._lidar = Lidar(physics, robot)
        self._drift = Drift(f"{seed}/{robot}/odometry")
        self._step_s = step_s
        self._scan_every = max(1, round(1.0 / (SCAN_HZ * step_s)))
        self._standing_every = max(1, round(1.0 / (STANDING_HZ * step_s)))
        self._same_scan_ticks = round(SAME_SCAN_S / step_s)
        self._scanned: tuple[int, tuple[float, ...]] = (0, ())
        """Tick and ranges of the last sweep that was told."""
        self._touched = False
        self._deadline_s = 0.0
        self._seq = {"odometry": 0, "scan": 0}

    def obey(self, command: VelocityCommand, now_s: float) -> None:
        self._rover.wish = Wish(
            command.forward_mps, command.left_mps, command.yaw_rate_radps, command.camera_tilt_down_rad
        )
        self._deadline_s = now_s + command.timeout_s

    def watch(self, now_s: float) -> None:
        """Stop when no command has come for its `timeout_s`; the camera keeps its tilt."""
        if now_s >= self._deadline_s:
            self._rover.wish = Wish(tilt_down_rad=self._rover.wish.tilt_down_rad)

    def publish(self, node: Node, tick: int, now_s: float) -> None:
        """What is due at this tick."""
        self._drift.advance(self._step_s)
        moves, standing_due = self._moves(), tick % self._standing_every == 0
        if moves or standing_due:
            node.publish("odometry", self._odometry(now_s), self.id)
        if tick % self._scan_every == 0 if moves else standing_due:
            self._look_around(node, tick, now_s, moves)

    def _look_around(self, node: Node, tick: int, now_s: float, moves: bool) -> None:
        ranges_m = self._lidar.sweep()
        told_tick, told_m = self._scanned
        if not moves and ranges_m == told_m and tick - told_tick < self._same_scan_ticks:
            return
        self._scanned = (tick, ranges_m)
        node.publish("scan", self._scan(now_s, ranges_m), self.id)

    def _moves(self) -> bool:
        """It goes or turns, is about to, or has come upon something or off it."""
        motion, touches = self._rover.motion(), self._physics.in_contact(self.id)
        stands = motion.speed_mps < STANDS_MPS and abs(motion.yaw_rate_radps) < STANDS_RADPS
        return not stands or self._rover.wish.moves or touches != self._touched

    def estimate(self) -> tuple[float, float, float]:
        """Where the robot believes to be: x, y in metres, yaw in (-pi, pi]."""
        motion = self._rover.motion()
        x, y = motion.position_m
        yaw_rad = motion.yaw_rad + self._drift.yaw_rad
        return (x + self._drift.x_m, y + self._drift.y_m, atan2(sin(yaw_rad), cos(yaw_rad)))

    def _odometry(self, now_s: float) -> Odometry:
        x, y, yaw_rad = self.estimate()
        motion = self._rover.motion()
        self._touched = self._physics.in_contact(self.id)
        return Odometry(
            robot=self.id,
            seq=self._next("odometry"),
            stamp_s=now_s,
            position_enu_m=(x, y, 0.0),
            yaw_rad=yaw_rad,
            speed_mps=motion.speed_mps,
            yaw_rate_radps=motion.yaw_rate_radps,
            in_contact=self._touched,
        )

    def _scan(self, now_s: float, ranges_m: tuple[float, ...]) -> LaserScan:
        x, y, yaw_rad = self.estimate()
        return LaserScan(
            robot=self.id,
            seq=self._next("scan"),
            stamp_s=now_s,
            position_enu_m=(x, y, HEIGHT_M),
            yaw_rad=yaw_rad,
            angle_min_rad=ANGLE_MIN_RAD,
            angle_step_rad=ANGLE_STEP_RAD,
            range_max_m=RANGE_M,
            ranges_m=ranges_m,
        )

    def _next(self, stream: str) -> int:
        self._seq[stream] += 1
        return self._seq[stream] - 1
