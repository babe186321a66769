"""A sweep of ranges around a robot, 120 beams at 0.25 m above the floor, cast into the physics."""

from math import cos, pi, sin

from sim.physics import Physics

BEAMS = 120
HEIGHT_M = 0.25
RANGE_M = 6.0
ANGLE_MIN_RAD = -pi
ANGLE_STEP_RAD = 2.0 * pi / BEAMS


def sweep(physics: Physics, robot: str) -> tuple[float, ...]:
    """Ranges in metres, beam k at ANGLE_MIN + k * ANGLE_STEP from straight ahead; 0 where nothing was hit."""
    motion = physics.robots[robot].motion()
    x, y = motion.position_m
    angles = [motion.yaw_rad + ANGLE_MIN_RAD + k * ANGLE_STEP_RAD for k in range(BEAMS)]
    ends = [(x + RANGE_M * cos(a), y + RANGE_M * sin(a), HEIGHT_M) for a in angles]
    shares = physics.cast(robot, [(x, y, HEIGHT_M)] * BEAMS, ends)
    return tuple(round(RANGE_M * share, 3) if share < 1.0 else 0.0 for share in shares)
