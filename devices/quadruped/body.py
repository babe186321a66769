"""The robot's body as its skills see it: what the driver reports, and what is asked of it."""

from collections import deque
from collections.abc import Iterable
from math import cos, hypot, inf, sin

from devices.quadruped.look import Look
from devices.quadruped.map import FloorMap
from wire.bus import Node
from wire.frames import body_to_enu
from wire.messages.command import TrafficOrder
from wire.messages.driver import GripperAction, GripperCommand, GripperState, LaserScan, Odometry, VelocityCommand
from wire.model import Message, Vec2, Vec3

COUNTED_M = 0.04
"""Smaller moves are the odometry's noise and not travelled."""
STANDS_MPS = 0.02
"""What is slower stands."""
TILT_STEP_RAD = 0.1
"""A smaller change of the camera's tilt is no action of its own."""
WALK_TILT_RAD = 0.45
BUMPER_M = 0.5
MOST_LOOKS = 24
ROBOT_NEAR_M = 1.1
TOUCH_WEIGHT = 30.0
"""Outlasts the beams that pass above or below what was touched for half a minute."""
STANDING_AGAIN_S, EARLY_S = 1.0, 1e-6
"""A driver that is asked to stand stands; so often it is asked again."""
DIRECTED_S = 0.3
"""While anybody is at work the hub directs the traffic more often than this."""
BODY_HALF_WIDTH_M, BODY_FRONT_M = 0.24, 0.33


class Body:
    """One robot. `now_s` is the mesh's time, `clock_s` that of the skill at work, which stands while the skill does."""

    def __init__(self, id: str, floor: FloorMap, sighted: bool = False) -> None:
        self.id, self.floor, self.sighted = id, floor, sighted
        self.now_s = self.clock_s = 0.0
        self.odometry: Odometry | None = None
        self.scan: LaserScan | None = None
        self.gripper: GripperState | None = None
        self.order: TrafficOrder | None = None
        self.looks: deque[Look] = deque(maxlen=MOST_LOOKS)
        self.path_m: tuple[Vec2, ...] = ()
        self.behind_other = False
        """Standing because another robot is in the way."""
        self.goal_id = ""
        self.note, self.fraction = "", 0.0
        self.travelled_m, self.action_steps = 0.0, 0
        self._counted_m: Vec2 | None = None
        self._forward_mps = self._left_mps = self._yaw_rate_radps = 0.0
        self._tilt_rad = WALK_TILT_RAD
        self._seq = self._grips = 0
        self._asked: tuple[float, tuple[float, ...]] = (-inf, ())
        """When the driver was asked for what: velocities and the camera's tilt."""
        self._pending: GripperCommand | None = None
        self._awaited: str | None = None

    # What the driver says

    def hear(self, message: Message) -> None:
        match message:
            case Odometry():
                self.odometry = message
                self._count()
            case LaserScan():
                self.scan = message
                self.floor.see(message, self.others_m)
            case GripperState():
                self.gripper = message
                if message.command_id == self._awaited and message.ok is not None:
                    self._awaited = None
            case TrafficOrder():
                self.order = message

    @property
    def position_m(self) -> Vec2:
        assert self.odometry is not None, "nothing moves before the first odometry"
        return self.odometry.position_enu_m[:2]

    @property
    def yaw_rad(self) -> float:
        assert self.odometry is not None, "nothing moves before the first odometry"
        return self.odometry.yaw_rad

    @property
    def holding(self) -> bool:
        return self.gripper is not None and self.gripper.holding

    @property
    def holding_type(self) -> str | None:
        """What the gripper takes the thing in the hand for; None too when it is empty."""
        return self.gripper.holding_type if self.gripper is not None and self.gripper.holding else None

    @property
    def others_m(self) -> tuple[Vec2, ...]:
        return self.order.others_m if self.order else ()

    @property
    def may_move(self) -> bool:
        return self.order is None or self.order.go or self.order.step_aside_m is not None

    @property
    def at_rest(self) -> bool:
        """It stands, and neither what is asked of it nor an order to step aside is going to move it."""
        asked = self._forward_mps or self._left_mps or self._yaw_rate_radps or self._pending or self._awaited
        ordered = self.order is not None and self.order.step_aside_m is not None
        return not asked and not ordered and self.odometry is not None and self.odometry.speed_mps < STANDS_MPS

    @property
    def directed(self) -> bool:
        """Traffic orders come often: somebody moves, and may need this robot out of the way."""
        return self.order is not None and self.now_s - self.order.stamp_s < DIRECTED_S

    @property
    def gripping(self) -> bool:
        """The gripper is at work and its outcome not known yet."""
        return self._awaited is not None

    @property
    def tilt_rad(self) -> float:
        """Of the camera, as last asked for."""
        return self._tilt_rad

    def looks_since(self, stamp_s: float) -> list[Look]:
        """Pictures taken at that time or later."""
        return [look for look in self.looks if look.stamp_s >= stamp_s]

    def room_ahead_m(self) -> float:
        """Free length in front of the body, as the last sweep saw it."""
        if self.scan is None:
            return BUMPER_M
        nearest_m = self.scan.range_max_m
        for k, range_m in enumerate(self.scan.ranges_m):
            angle_rad = self.scan.angle_min_rad + self.scan.angle_step_rad * k
            ahead_m = range_m * cos(angle_rad)
            if 0.0 < ahead_m < nearest_m and abs(range_m * sin(angle_rad)) < BODY_HALF_WIDTH_M:
                nearest_m = ahead_m
        return nearest_m - BODY_FRONT_M

    # What is asked of it

    def move(self, forward_mps: float, yaw_rate_radps: float, left_mps: float = 0.0) -> None:
        self._forward_mps, self._left_mps, self._yaw_rate_radps = forward_mps, left_mps, yaw_rate_radps

    def stand(self) -> None:
        self.move(0.0, 0.0)

    def tilt(self, tilt_down_rad: float) -> None:
        if abs(tilt_down_rad - self._tilt_rad) > TILT_STEP_RAD:
            self.action_steps += 1
        self._tilt_rad = tilt_down_rad

    def grip(self, action: GripperAction, point_enu_m: Vec3, expected_type: str | None) -> str:
        """Reach to a point. The outcome comes with the driver's `GripperState` of the returned command id."""
        self._grips += 1
        self.action_steps += 1
        command_id = f"{self.goal_id[-50:]}-{self._grips}"
        self._pending = GripperCommand(
            robot=self.id,
            command_id=command_id,
            action=action,
            point_enu_m=point_enu_m,
            expected_type=expected_type,
        )
        self._awaited = command_id
        return command_id

    def stop_waiting(self) -> None:
        """The driver did not answer in time."""
        self._awaited = None

    def publish(self, node: Node) -> None:
        """Send what is asked of the driver: once a step, and while it stands only now and then."""
        if self._pending is not None:
            node.publish("gripper_command", self._pending, self.id)
            self._pending = None
        motion = (self._forward_mps, self._left_mps, self._yaw_rate_radps) if self.may_move else (0.0, 0.0, 0.0)
        asked, (since_s, before) = (*motion, self._tilt_rad), self._asked
        if asked == before and not any(motion) and 0.0 <= self.now_s - since_s < STANDING_AGAIN_S - EARLY_S:
            return
        self._asked, self._seq = (self.now_s, asked), self._seq + 1
        forward_mps, left_mps, yaw_rate_radps = motion
        command = VelocityCommand(
            robot=self.id,
            seq=self._seq,
            forward_mps=forward_mps,
            left_mps=left_mps,
            yaw_rate_radps=yaw_rate_radps,
            camera_tilt_down_rad=self._tilt_rad,
        )
        node.publish("velocity", command, self.id)

    def touched(self) -> None:
        """Something that the lidar does not see stands in front: remember it, unless it is another robot."""
        x, y = self.position_m
        if any(hypot(other[0] - x, other[1] - y) < ROBOT_NEAR_M for other in self.others_m):
            return
        front: Iterable[Vec3] = ((BODY_FRONT_M + 0.07, side, 0.0) for side in (-0.15, 0.0, 0.15))
        here = (*self.position_m, 0.0)
        self.floor.mark([body_to_enu(point, here, self.yaw_rad)[:2] for point in front], self.now_s, TOUCH_WEIGHT)

    def _count(self) -> None:
        if self._counted_m is None:
            self._counted_m = self.position_m
        x, y = self.position_m
        moved_m = hypot(x - self._counted_m[0], y - self._counted_m[1])
        if moved_m > COUNTED_M:
            self.travelled_m += moved_m
            self._counted_m = (x, y)
