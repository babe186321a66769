"""The articulated tier: twelve motors trot and carry the weight, the trunk's course is guided as for one body.

A crude gait on purpose: it shows legs, feet on the floor and what they cost, not how a quadruped balances.
"""

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager
from math import atan2, cos, pi, sin
from typing import Any

import pybullet_data

from sim.rover import Rover
from sim.scene import Vec2

STAND_RAD = (0.0, 0.7, -1.4)
"""Hip, upper leg, lower leg."""
STAND_HEIGHT_M = 0.32
LEG_LENGTH_M = 0.28
STEP_HZ = 2.5
LIFT_RAD = 0.35
MOTOR_NM = 30.0
POSITION_GAIN = 0.4
LEVELLING_PER_S = 8.0
FOOT_FRICTION = 0.3
PHASES = (0.0, 0.0, pi, pi)
"""Rear left with front right, front left with rear right: the order of the model's legs."""
JOINTS = tuple(range(12))


class LeggedRover(Rover):
    """Unitree A1 of PyBullet's own data; it has no mast in the physics, and is smaller than the one body."""

    def __init__(self, bullet: Any, robot: str, body: int) -> None:
        super().__init__(bullet, robot, body)
        self._phase_rad = 0.0
        self._spin_radps = 0.0

    def push(self, step_s: float, steps: int, gravity_mps2: float) -> None:
        _, turn = self._bullet.getBasePositionAndOrientation(self.body)
        linear, _ = self._bullet.getBaseVelocity(self.body)
        yaw_rad = 2.0 * atan2(turn[2], turn[3])
        span_s = steps * step_s
        # Feet that stand resist a turn: it is led by what was asked for last, not by what came of it.
        (x_mps, y_mps), spin = self._next_velocity((linear[0], linear[1]), self._spin_radps, yaw_rad, span_s)
        self._spin_radps = spin
        # turn is nearly level: twice the vector part of what remains beside the yaw is roll and pitch, in site axes.
        half_c, half_s = cos(yaw_rad / 2.0), sin(yaw_rad / 2.0)
        lean_x = 2.0 * (half_c * turn[0] - half_s * turn[1])
        lean_y = 2.0 * (half_s * turn[0] + half_c * turn[1])
        self._bullet.resetBaseVelocity(
            self.body, (x_mps, y_mps, linear[2]), (-LEVELLING_PER_S * lean_x, -LEVELLING_PER_S * lean_y, spin)
        )
        self._trot(cos(yaw_rad) * x_mps + sin(yaw_rad) * y_mps, spin, span_s)

    def _trot(self, forward_mps: float, yaw_rate_radps: float, span_s: float) -> None:
        """Feet on the floor go back under the trunk, the others are lifted forward; standing still, all stand."""
        walking = abs(forward_mps) > 0.02 or abs(yaw_rate_radps) > 0.05
        self._phase_rad = (self._phase_rad + 2.0 * pi * STEP_HZ * span_s) % (2.0 * pi) if walking else 0.0
        reach_rad = forward_mps / STEP_HZ / 4.0 / LEG_LENGTH_M
        targets: list[float] = []
        for offset_rad in PHASES:
            swing, swept = sin(self._phase_rad + offset_rad), cos(self._phase_rad + offset_rad)
            lift_rad = LIFT_RAD * max(0.0, swing) if walking else 0.0
            hip, upper, lower = STAND_RAD
            targets += (hip, upper + 0.8 * lift_rad + (reach_rad * swept if walking else 0.0), lower - 1.6 * lift_rad)
        self._bullet.setJointMotorControlArray(
            self.body,
            JOINTS,
            self._bullet.POSITION_CONTROL,
            targetPositions=targets,
            forces=[MOTOR_NM] * len(JOINTS),
            positionGains=[POSITION_GAIN] * len(JOINTS),
        )


def legged_rover(bullet: Any, robot: str, start_m: Vec2, yaw_rad: float, group: int, mask: int) -> LeggedRover:
    with _chatter_to_stderr():
        body: int = bullet.loadURDF(
            f"{pybullet_data.getDataPath()}/a1/a1.urdf",
            (*start_m, STAND_HEIGHT_M),
            bullet.getQuaternionFromEuler((0.0, 0.0, yaw_rad)),
            flags=bullet.URDF_MERGE_FIXED_LINKS,
        )
    for joint in JOINTS:
        bullet.resetJointState(body, joint, STAND_RAD[joint % 3])
    for link in (-1, *JOINTS):
        bullet.setCollisionFilterGroupMask(body, link, group, mask)
        bullet.changeDynamics(body, link, lateralFriction=FOOT_FRICTION, linearDamping=0.0, angularDamping=0.0)
    return LeggedRover(bullet, robot, body)


@contextmanager
def _chatter_to_stderr() -> Iterator[None]:
    """PyBullet's loader prints from C to the standard output, which belongs to reports."""
    libc = ctypes.CDLL(None)
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        libc.fflush(None)
        os.dup2(kept, 1)
        os.close(kept)
