"""A robot that obeys velocity commands: it accelerates within limits, contacts stop it. One rigid body by default."""

from dataclasses import dataclass
from math import atan2, cos, hypot, sin
from typing import Any

from sim.boxes import Box
from sim.scene import Vec2, Vec3

BODY_SIZE_M: Vec3 = (0.65, 0.35, 0.43)
BODY_BOTTOM_M = 0.02
BODY_CENTRE_M = BODY_BOTTOM_M + BODY_SIZE_M[2] / 2.0
MAST_FORWARD_M = 0.20
MAST_TOP_M = 1.30
MAST_HALF_WIDTH_M = 0.02
MASS_KG = 12.0
YAW_INERTIA_KGM2 = 0.6
FRICTION = 0.1
ACCELERATION_MPS2 = 2.0
BRAKING_MPS2 = 4.0
"""More than the acceleration, so that a robot that stands holds its place against one that pushes."""
YAW_ACCELERATION_RADPS2 = 8.0
MAX_SPEED_MPS = 0.8
MAX_YAW_RATE_RADPS = 1.6
TILT_RATE_RADPS = 1.5
HEIGHT_GAIN_PER_S = 20.0


@dataclass(frozen=True)
class Motion:
    """Where a robot is: its body's centre on the floor, and how it moves (site frame)."""

    position_m: Vec2
    yaw_rad: float
    speed_mps: float
    yaw_rate_radps: float


@dataclass
class Wish:
    """The velocity asked for, in the body frame, and the tilt asked of the camera."""

    forward_mps: float = 0.0
    left_mps: float = 0.0
    yaw_rate_radps: float = 0.0
    tilt_down_rad: float = 0.3

    @property
    def moves(self) -> bool:
        """Whether the body is asked to move; the camera's tilt does not matter."""
        return bool(self.forward_mps or self.left_mps or self.yaw_rate_radps)


class Rover:
    """A body in the physics that follows a wish."""

    def __init__(self, bullet: Any, robot: str, body: int) -> None:
        self.id = robot
        self.body = body
        self.wish = Wish()
        self.tilt_down_rad = self.wish.tilt_down_rad
        self._bullet = bullet
        self._motion: Motion | None = None

    def push(self, step_s: float, steps: int, gravity_mps2: float) -> None:
        """Before some physics steps: move the velocity towards the wish, as far as the accelerations allow."""
        position, turn = self._bullet.getBasePositionAndOrientation(self.body)
        linear, angular = self._bullet.getBaseVelocity(self.body)
        yaw_rad = 2.0 * atan2(turn[2], turn[3])
        (x_mps, y_mps), spin = self._next_velocity((linear[0], linear[1]), angular[2], yaw_rad, steps * step_s)
        # The legs carry the weight: thrown up so that gravity brings it back within the steps, the body needs no floor.
        rise = gravity_mps2 * step_s * (steps + 1) / 2.0 + HEIGHT_GAIN_PER_S * (BODY_CENTRE_M - position[2])
        self._bullet.resetBaseVelocity(self.body, (x_mps, y_mps, rise), (0.0, 0.0, spin))

    def _next_velocity(
        self, velocity_mps: Vec2, yaw_rate_radps: float, yaw_rad: float, span_s: float
    ) -> tuple[Vec2, float]:
        """Planar velocity in the site frame and yaw rate, one span later."""
        c, s = cos(yaw_rad), sin(yaw_rad)
        ahead, aside = self._limited()
        dvx, dvy = c * ahead - s * aside - velocity_mps[0], s * ahead + c * aside - velocity_mps[1]
        allowed = (ACCELERATION_MPS2 if ahead or aside else BRAKING_MPS2) * span_s
        share = min(1.0, allowed / max(1e-9, hypot(dvx, dvy)))
        most = YAW_ACCELERATION_RADPS2 * span_s
        wished = max(-MAX_YAW_RATE_RADPS, min(MAX_YAW_RATE_RADPS, self.wish.yaw_rate_radps))
        spin = yaw_rate_radps + max(-most, min(most, wished - yaw_rate_radps))
        return (velocity_mps[0] + share * dvx, velocity_mps[1] + share * dvy), spin

    def _limited(self) -> Vec2:
        ahead, aside = self.wish.forward_mps, self.wish.left_mps
        share = min(1.0, MAX_SPEED_MPS / max(1e-9, hypot(ahead, aside)))
        return (share * ahead, share * aside)

    def tilt(self, step_s: float) -> None:
        most = TILT_RATE_RADPS * step_s
        self.tilt_down_rad += max(-most, min(most, self.wish.tilt_down_rad - self.tilt_down_rad))

    def motion(self) -> Motion:
        """As it is since the physics last moved on: many ask, once between two steps it is looked up."""
        if self._motion is None:
            position, turn = self._bullet.getBasePositionAndOrientation(self.body)
            linear, angular = self._bullet.getBaseVelocity(self.body)
            self._motion = Motion(
                (position[0], position[1]), 2.0 * atan2(turn[2], turn[3]), hypot(linear[0], linear[1]), angular[2]
            )
        return self._motion

    def state(self) -> object:
        """Equal before and after some steps when they have not moved the body at all."""
        return (self._bullet.getBasePositionAndOrientation(self.body), self._bullet.getBaseVelocity(self.body))

    def moved_on(self) -> None:
        """The physics has taken steps."""
        self._motion = None

    def box(self) -> Box:
        """The body without its mast."""
        motion = self.motion()
        half = (BODY_SIZE_M[0] / 2.0, BODY_SIZE_M[1] / 2.0, BODY_SIZE_M[2] / 2.0)
        return Box((*motion.position_m, BODY_CENTRE_M), half, motion.yaw_rad)

    def eye_m(self) -> Vec3:
        """Where the mast's camera is."""
        motion = self.motion()
        x, y = motion.position_m
        c, s = cos(motion.yaw_rad), sin(motion.yaw_rad)
        return (x + MAST_FORWARD_M * c, y + MAST_FORWARD_M * s, MAST_TOP_M)


def one_body_rover(bullet: Any, robot: str, start_m: Vec2, yaw_rad: float, group: int, mask: int) -> Rover:
    """Body and mast in one piece. Zero inertia about x and y means infinite there for the solver: it cannot tip."""
    body: int = bullet.createMultiBody(
        MASS_KG,
        _shape(bullet),
        useMaximalCoordinates=1,
        basePosition=(*start_m, BODY_CENTRE_M),
        baseOrientation=bullet.getQuaternionFromEuler((0.0, 0.0, yaw_rad)),
    )
    bullet.changeDynamics(
        body,
        -1,
        mass=MASS_KG,  # without it, PyBullet makes a rigid body's mass 0 when its inertia is set
        localInertiaDiagonal=(0.0, 0.0, YAW_INERTIA_KGM2),
        lateralFriction=FRICTION,
        linearDamping=0.0,
        angularDamping=0.0,
        activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
    )
    bullet.setCollisionFilterGroupMask(body, -1, group, mask)
    return Rover(bullet, robot, body)


def _shape(bullet: Any) -> int:
    body_half = [side / 2.0 for side in BODY_SIZE_M]
    mast_bottom_m = BODY_BOTTOM_M + BODY_SIZE_M[2]
    mast_half = [MAST_HALF_WIDTH_M, MAST_HALF_WIDTH_M, (MAST_TOP_M - mast_bottom_m) / 2.0]
    mast_centre = [MAST_FORWARD_M, 0.0, (MAST_TOP_M + mast_bottom_m) / 2.0 - BODY_CENTRE_M]
    shape: int = bullet.createCollisionShapeArray(
        shapeTypes=[bullet.GEOM_BOX, bullet.GEOM_BOX],
        halfExtents=[body_half, mast_half],
        collisionFramePositions=[[0.0, 0.0, 0.0], mast_centre],
    )
    return shape
