"""One quadrotor in a PyBullet world: what a `sim.flight.state.Vehicle` is. ENU and FLU outside, NED and FRD inside."""

from math import atan2, cos, pi, sqrt
from typing import Any

from sim.boxes import Box
from sim.bullet import GRAVITY_MPS2, STEP_S
from sim.flight.airframe import (
    AVIONICS_W,
    DRAG_NPMPS,
    DRAG_NPMPS2,
    HALF_M,
    HOVER_THRUST,
    INERTIA_KGM2,
    MASS_KG,
    Rotors,
)  # fmt: skip
from sim.flight.attitude import from_bullet
from sim.flight.control import Control
from sim.flight.estimator import Estimator
from sim.flight.power import Power
from sim.flight.sensing import SensorModel
from sim.flight.state import AttitudeTarget, Battery, Estimate, Off, Sensors, Setpoint, Trajectory, Vec3
from sim.flight.touchdown import Touchdown
from wire.frames import enu_to_ned, wrap_rad, yaw_to_heading_rad

GUIDE_EVERY, SLOW_EVERY = 4, 12
"""Steps from one guidance (60 Hz), and from one look at compass, barometer and fixes (20 Hz), to the next."""
_TIPPED = cos(60.0 * pi / 180.0)
_ANGULAR_DRAG_NMS = 0.003


class Quadrotor:
    """Call `before_step`, let the physics take one step of 1/240 s, and so on; `seed` draws noise and biases."""

    def __init__(
        self,
        bullet: Any,
        id: str,
        start_enu_m: Vec3,
        yaw_rad: float,
        seed: int,
        group: int,
        mask: int,
        fixes: bool = True,
        altitude_m: float = 0.0,
    ) -> None:
        """`start_enu_m`: where its feet stand. `altitude_m`: of the site's floor above the sea. `fixes`: whether there
        is an indoor position system."""
        self.id = id
        self.body = _body(bullet, start_enu_m, yaw_rad, group, mask)
        self._bullet = bullet
        position = enu_to_ned(start_enu_m)
        self._sensing = SensorModel(seed, fixes, altitude_m)
        self._estimator = Estimator(position if fixes else (0.0, 0.0, 0.0), yaw_to_heading_rad(yaw_rad))
        self._control, self._rotors, self._power = Control(), Rotors(STEP_S), Power()
        self._touchdown = Touchdown()
        self._setpoint: Setpoint = Off()
        self._armed = False
        self._steps = self._sensed = 0
        self._dozes = False
        """It lies still with its rotors off: it looks and thinks at the slower rate only."""
        self._before_mps: Vec3 = (0.0, 0.0, 0.0)

    # What an autopilot sees

    @property
    def estimate(self) -> Estimate:
        return self._estimator.estimate

    @property
    def battery(self) -> Battery:
        return self._power.state

    @property
    def sensors(self) -> Sensors:
        return self._sensing.readings

    @property
    def on_ground(self) -> bool:
        return self._touchdown.landed

    @property
    def tipped(self) -> bool:
        _, x, y, _ = self._estimator.q
        return 1.0 - 2.0 * (x * x + y * y) < _TIPPED

    @property
    def hover_thrust(self) -> float:
        return HOVER_THRUST

    @property
    def rotors(self) -> tuple[float, float, float, float]:
        a, b, c, d = self._rotors.speeds
        return (a, b, c, d)

    def arm(self) -> None:
        self._armed, self._dozes = True, False
        self._control.press_down(self.estimate.heading_rad)

    def disarm(self) -> None:
        self._armed = False
        self._setpoint = Off()

    def command(self, setpoint: Setpoint) -> None:
        self._setpoint = setpoint

    def external_pose(self, stamp_s: float, position_ned_m: Vec3, heading_rad: float | None) -> bool:
        return self._estimator.pose(stamp_s, position_ned_m, heading_rad)

    def fail(self, unit: str, works: bool) -> None:
        healthy = self._sensing.readings.healthy
        if unit not in healthy:
            raise ValueError(f"no unit {unit}; there are {', '.join(sorted(healthy))}")
        healthy[unit] = works and (unit != "fix" or self._sensing.fixes)
        if unit == "battery":
            self._power.fail(works)

    def set_battery(self, remaining: float | None, drain_s: float | None, voltage_v: float | None) -> None:
        self._power.provoke(remaining, drain_s, voltage_v)

    # Time

    def before_step(self, now_s: float) -> None:
        """Sense, estimate, decide, and push the body for the coming step of physics."""
        if self._dozes and self._steps % GUIDE_EVERY:
            self._steps += 1
            return
        span_s = max(1, self._steps - self._sensed) * STEP_S
        self._sensed = self._steps
        bullet, estimator = self._bullet, self._estimator
        (x, y, z), (qx, qy, qz, qw) = bullet.getBasePositionAndOrientation(self.body)
        (vx, vy, vz), (wx, wy, wz) = bullet.getBaseVelocity(self.body)
        # rows of R(ENU <- FLU)
        xx, yy, zz = qx * qx, qy * qy, qz * qz
        xy, xz, yz, wxq, wyq, wzq = qx * qy, qx * qz, qy * qz, qw * qx, qw * qy, qw * qz
        r00, r01, r02 = 1.0 - 2.0 * (yy + zz), 2.0 * (xy - wzq), 2.0 * (xz + wyq)
        r10, r11, r12 = 2.0 * (xy + wzq), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wxq)
        r20, r21, r22 = 2.0 * (xz - wyq), 2.0 * (yz + wxq), 1.0 - 2.0 * (xx + yy)
        bx, by, bz = self._before_mps
        self._before_mps = (vx, vy, vz)
        ax, ay, az = (vx - bx) / span_s, (vy - by) / span_s, (vz - bz) / span_s + GRAVITY_MPS2
        p, q, r = r00 * wx + r10 * wy + r20 * wz, r01 * wx + r11 * wy + r21 * wz, r02 * wx + r12 * wy + r22 * wz
        sensing = self._sensing
        sensing.inertial(
            (p, -q, -r),
            (
                r00 * ax + r10 * ay + r20 * az,
                -(r01 * ax + r11 * ay + r21 * az),
                -(r02 * ax + r12 * ay + r22 * az),
            ),
        )
        readings = sensing.readings
        estimator.predict(readings.gyro_frd_radps, readings.accel_frd_mps2, span_s)
        feet_m = z - HALF_M[2]
        if self._steps % SLOW_EVERY == 0:
            self._look_slowly(now_s, (y, x, -feet_m), (vy, vx, -vz), from_bullet(qx, qy, qz, qw))
        if self._steps % GUIDE_EVERY == 0:
            estimator.tell(now_s, readings.healthy["gyro"])
            self._guide(now_s)
        self._steps += 1
        self._turn_rotors()
        thrust, roll, pitch, yaw = self._rotors.wrench(self._power.state.voltage_v, feet_m)
        if thrust < 1e-3 and vx * vx + vy * vy + vz * vz < 1e-6:
            self._dozes = not self._armed and wx * wx + wy * wy + wz * wz < 1e-6
            return
        self._dozes = False
        drag = DRAG_NPMPS + DRAG_NPMPS2 * sqrt(vx * vx + vy * vy + vz * vz)
        bullet.applyExternalForce(
            self.body,
            -1,
            (thrust * r02 - drag * vx, thrust * r12 - drag * vy, thrust * r22 - drag * vz),
            (x, y, z),
            bullet.WORLD_FRAME,
        )
        tx, ty, tz = roll - _ANGULAR_DRAG_NMS * p, -pitch - _ANGULAR_DRAG_NMS * q, -yaw - _ANGULAR_DRAG_NMS * r
        bullet.applyExternalTorque(
            self.body,
            -1,
            (r00 * tx + r01 * ty + r02 * tz, r10 * tx + r11 * ty + r12 * tz, r20 * tx + r21 * ty + r22 * tz),
            bullet.WORLD_FRAME,
        )

    def _look_slowly(self, now_s: float, position: Vec3, velocity: Vec3, attitude: tuple[float, ...]) -> None:
        sensing, estimator = self._sensing, self._estimator
        w, x, y, z = attitude
        sensing.slow((w, x, y, z), position, velocity)
        readings = sensing.readings
        if readings.fix_ned_m is not None:
            estimator.fix(now_s, readings.fix_ned_m, readings.fix_velocity_ned_mps, SLOW_EVERY * STEP_S)
        if readings.healthy["mag"]:
            estimator.compass(now_s, readings.mag_frd_gauss)
        if readings.healthy["baro"]:
            estimator.barometer(now_s, sensing.baro_height_m())
        if self._touchdown.landed and not self._armed:
            estimator.stand(now_s)
        self._power.draw(self._rotors.power_w(self._power.state.voltage_v) + AVIONICS_W, SLOW_EVERY * STEP_S)

    def _guide(self, now_s: float) -> None:
        control, estimator, setpoint = self._control, self._estimator, self._setpoint
        heading_rad = estimator.estimate.heading_rad
        if not self._armed:
            thrust = 0.0
        elif isinstance(setpoint, Trajectory):
            if self._stays_down(setpoint):
                control.press_down(heading_rad)
            else:
                control.guide(setpoint, estimator, heading_rad, GUIDE_EVERY * STEP_S)
            thrust = control.thrust
        elif isinstance(setpoint, AttitudeTarget):
            control.obey(setpoint, estimator)
            thrust = control.thrust
        else:
            control.press_down(heading_rad)
            thrust = 0.0
        self._touchdown.look(
            now_s, self._armed, thrust, HOVER_THRUST, estimator.pd, estimator.vd, control.wanted_down_mps
        )

    def _turn_rotors(self) -> None:
        if not self._armed or self._power.state.remaining <= 0.0:
            self._rotors.step(None, idle=False)
        elif self._stays_down(self._setpoint):
            self._rotors.step(None, idle=True)
        else:
            self._rotors.step(self._control.steer(self._estimator, STEP_S), idle=True)

    def _stays_down(self, setpoint: Setpoint) -> bool:
        """Whether it stands, and nothing asks it to leave the floor: its rotors idle."""
        if isinstance(setpoint, Trajectory):
            return self._touchdown.landed and not _wants_up(setpoint, self._estimator)
        return isinstance(setpoint, Off)

    # For the simulator alone

    def true_pose(self) -> tuple[Vec3, float]:
        """Where its feet really are in ENU and its real yaw: for the renderer, the judge and measurements only."""
        (x, y, z), (qx, qy, qz, qw) = self._bullet.getBasePositionAndOrientation(self.body)
        yaw = atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz))
        return (x, y, z - HALF_M[2]), wrap_rad(yaw)

    def box(self) -> Box:
        """The body, level."""
        (x, y, z), yaw_rad = self.true_pose()
        return Box((x, y, z + HALF_M[2]), HALF_M, yaw_rad)


def _wants_up(wish: Trajectory, now: Estimator) -> bool:
    """Whether a vehicle that stands is asked to leave the floor."""
    height, climb, push = wish.position_ned_m[2], wish.velocity_ned_mps[2], wish.acceleration_ned_mps2[2]
    return (
        (height is not None and height < now.pd - 0.1)
        or (climb is not None and climb < -0.05)
        or (push is not None and push < -0.1)
    )


def _body(bullet: Any, start_m: Vec3, yaw_rad: float, group: int, mask: int) -> int:
    body: int = bullet.createMultiBody(
        MASS_KG,
        bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=HALF_M),
        useMaximalCoordinates=1,
        basePosition=(start_m[0], start_m[1], start_m[2] + HALF_M[2]),
        baseOrientation=bullet.getQuaternionFromEuler((0.0, 0.0, yaw_rad)),
    )
    bullet.changeDynamics(
        body,
        -1,
        mass=MASS_KG,  # without it, PyBullet makes a rigid body's mass 0 when its inertia is set
        localInertiaDiagonal=INERTIA_KGM2,
        lateralFriction=0.6,
        restitution=0.05,
        linearDamping=0.0,
        angularDamping=0.0,
        activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
    )
    bullet.setCollisionFilterGroupMask(body, -1, group, mask)
    return body
