"""One PyBullet world without a window, its calls bound to it once: several worlds can live in one process."""

from collections.abc import Sequence
from functools import partial
from types import SimpleNamespace
from typing import Any

import pybullet

from sim.boxes import Box

BOXES_PER_BODY = 16
"""A static body costs about 0.4 us a step by merely existing; sixteen boxes in one cost no more than one."""

GRAVITY_MPS2 = 9.81
STEP_S = 1.0 / 240.0
SOLVER_ITERATIONS = 20

_CALLS = (
    "applyExternalForce",
    "applyExternalTorque",
    "changeDynamics",
    "createCollisionShape",
    "createCollisionShapeArray",
    "createMultiBody",
    "disconnect",
    "getBasePositionAndOrientation",
    "getBaseVelocity",
    "getContactPoints",
    "getJointInfo",
    "getJointStates",
    "getLinkState",
    "getNumJoints",
    "loadURDF",
    "rayTestBatch",
    "removeBody",
    "resetBaseVelocity",
    "resetJointState",
    "setCollisionFilterGroupMask",
    "setJointMotorControlArray",
    "stepSimulation",
)


def open_bullet() -> Any:
    """An empty world with gravity and this project's fixed step."""
    client = pybullet.connect(pybullet.DIRECT)
    calls = {name: partial(getattr(pybullet, name), physicsClientId=client) for name in _CALLS}
    constants = {name: getattr(pybullet, name) for name in dir(pybullet) if name.isupper()}
    pybullet.setTimeStep(STEP_S, physicsClientId=client)
    pybullet.setGravity(0.0, 0.0, -GRAVITY_MPS2, physicsClientId=client)
    pybullet.setPhysicsEngineParameter(
        deterministicOverlappingPairs=1, numSolverIterations=SOLVER_ITERATIONS, physicsClientId=client
    )
    return SimpleNamespace(getQuaternionFromEuler=pybullet.getQuaternionFromEuler, client=client, **calls, **constants)


def add_floor(bullet: Any, group: int, mask: int) -> int:
    """The plane at height 0; the body's number."""
    body: int = bullet.createMultiBody(0.0, bullet.createCollisionShape(bullet.GEOM_PLANE), useMaximalCoordinates=1)
    bullet.setCollisionFilterGroupMask(body, -1, group, mask)
    return body


def add_static_boxes(bullet: Any, boxes: Sequence[Box], group: int, mask: int) -> list[int]:
    """Immovable boxes, near ones together in one body."""
    ordered = sorted(boxes, key=lambda b: (b.centre_m[0] // 3.0, b.centre_m[1] // 3.0, b.centre_m))
    bodies = []
    for start in range(0, len(ordered), BOXES_PER_BODY):
        batch = ordered[start : start + BOXES_PER_BODY]
        shape = bullet.createCollisionShapeArray(
            shapeTypes=[bullet.GEOM_BOX] * len(batch),
            halfExtents=[box.half_m for box in batch],
            collisionFramePositions=[box.centre_m for box in batch],
            collisionFrameOrientations=[bullet.getQuaternionFromEuler((0.0, 0.0, b.yaw_rad)) for b in batch],
        )
        body: int = bullet.createMultiBody(0.0, shape, useMaximalCoordinates=1)
        bullet.setCollisionFilterGroupMask(body, -1, group, mask)
        bodies.append(body)
    return bodies
