"""What a quadruped looks like: body, four legs, head, and a mast with its camera."""

from sim import textures
from sim.scene import Part, Rgb

SHELL: tuple[Rgb, ...] = ((0.92, 0.62, 0.12), (0.20, 0.55, 0.85), (0.55, 0.78, 0.25), (0.80, 0.30, 0.55))
DARK: Rgb = (0.13, 0.13, 0.15)
STEEL: Rgb = (0.72, 0.73, 0.76)
CAMERA_FORWARD_M, CAMERA_HEIGHT_M = 0.20, 1.30


def robot_parts(number: int, holding: bool) -> list[Part]:
    """Parts about the floor point below its centre; each robot of a team has its own colour."""
    shell = SHELL[number % len(SHELL)]
    parts = [
        Part("box", (0.0, 0.0, 0.37), (0.62, 0.26, 0.15), shell),
        Part("box", (0.0, 0.0, 0.465), (0.44, 0.20, 0.05), DARK),
        Part("box", (0.36, 0.0, 0.39), (0.12, 0.17, 0.12), DARK),
        Part("cylinder", (0.425, 0.04, 0.41), (0.03, 0.03, 0.03), (0.5, 0.9, 1.0), 0.0, 1.5708, 0, 1.0),
        Part("cylinder", (0.425, -0.04, 0.41), (0.03, 0.03, 0.03), (0.5, 0.9, 1.0), 0.0, 1.5708, 0, 1.0),
        Part("cylinder", (0.10, 0.0, 0.87), (0.035, 0.035, 0.76), STEEL, texture=textures.METAL),
        Part("box", (CAMERA_FORWARD_M - 0.055, 0.0, CAMERA_HEIGHT_M), (0.09, 0.13, 0.07), DARK),
    ]
    for x in (0.24, -0.24):
        for y in (0.14, -0.14):
            parts += [
                Part("box", (x - 0.03, y, 0.27), (0.07, 0.06, 0.24), shell, 0.0, 0.45),
                Part("cylinder", (x - 0.03, y, 0.11), (0.04, 0.04, 0.22), DARK, 0.0, -0.35),
                Part("sphere", (x + 0.01, y, 0.025), (0.05, 0.05, 0.05), DARK),
            ]
    return parts + _arm(holding)


def _arm(holding: bool) -> list[Part]:
    """Folded on the back, or stretched out in front when it holds something."""
    if not holding:
        return [
            Part("box", (-0.08, 0.0, 0.52), (0.34, 0.05, 0.05), STEEL),
            Part("box", (0.08, 0.0, 0.57), (0.10, 0.07, 0.05), DARK),
        ]
    return [
        Part("box", (0.30, 0.0, 0.60), (0.45, 0.05, 0.05), STEEL, 0.0, -0.5),
        Part("box", (0.50, 0.0, 0.71), (0.10, 0.09, 0.05), DARK),
    ]
