"""What a quadrotor looks like: a hull with lamps, four guarded propellers, and a camera beneath its nose."""

from math import pi

from sim.render.robot import DARK, SHELL, STEEL
from sim.scene import Part

_ARM_M, _GUARD_M = 0.12, 0.2


def drone_parts(number: int) -> list[Part]:
    """Parts about the point between its feet; each drone of a team has its own colour."""
    shell = SHELL[number % len(SHELL)]
    parts = [
        Part("box", (0.0, 0.0, 0.07), (0.2, 0.12, 0.06), shell),
        Part("box", (-0.02, 0.0, 0.105), (0.12, 0.08, 0.02), DARK),
        Part("box", (0.11, 0.0, 0.045), (0.04, 0.06, 0.05), DARK),
        Part("cylinder", (0.135, 0.0, 0.045), (0.025, 0.025, 0.02), (0.5, 0.9, 1.0), 0.0, pi / 2.0, 0, 1.0),
    ]
    for x, lamp in ((_ARM_M, (0.3, 1.0, 0.3)), (-_ARM_M, (1.0, 0.25, 0.2))):
        for y in (_ARM_M, -_ARM_M):
            parts += [
                Part(
                    "box", (x / 2.0, y / 2.0, 0.08), (0.13, 0.025, 0.02), STEEL, pi / 4.0 if x * y > 0.0 else -pi / 4.0
                ),
                Part("cylinder", (x, y, 0.1), (_GUARD_M, _GUARD_M, 0.012), DARK),
                Part("cylinder", (x, y, 0.06), (0.03, 0.03, 0.07), DARK),
                Part("sphere", (x, y, 0.02), (0.03, 0.03, 0.03), lamp, 0.0, 0.0, 0, 0.8),
            ]
    return parts
