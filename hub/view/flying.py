"""Draws what flies: a quadrotor's body, its way at its height, how full it is."""

from math import cos, pi, sin

import rerun as rr

from wire.messages.command import RobotReport
from wire.model import Vec3

_ARM_M, _ROTOR_M = 0.18, 0.11
_FLOOR_M = 0.05
"""Ways over the floor are drawn this high."""


def draw_quadrotor(rec: rr.RecordingStream, robot: str, rgb: tuple[int, int, int]) -> None:
    """Two crossed arms with four rotors and a nose about the origin of the robot's own frame."""
    path = f"world/robots/{robot}"
    tips = [(_ARM_M * cos(a), _ARM_M * sin(a), 0.03) for a in (pi / 4 + k * pi / 2 for k in range(4))]
    rec.log(
        f"{path}/body",
        rr.Boxes3D(
            centers=[(0.0, 0.0, 0.0)], half_sizes=[(0.07, 0.05, 0.03)], colors=[rgb], labels=[robot], fill_mode="solid"
        ),
        static=True,
    )
    arms = [[tips[0], tips[2]], [tips[1], tips[3]]]
    rings = [[_rim(tip, k) for k in range(13)] for tip in tips]
    rec.log(
        f"{path}/rotors",
        rr.LineStrips3D([*arms, *rings], colors=[(60, 60, 60)] * 2 + [rgb] * 4, radii=[0.012] * 2 + [0.008] * 4),
        static=True,
    )
    nose = rr.Arrows3D(origins=[(0.0, 0.0, 0.03)], vectors=[(0.32, 0.0, 0.0)], colors=[rgb])
    rec.log(f"{path}/heading", nose, static=True)


def _rim(tip: Vec3, k: int) -> Vec3:
    return (tip[0] + _ROTOR_M * cos(k * pi / 6), tip[1] + _ROTOR_M * sin(k * pi / 6), tip[2])


def draw_flight(rec: rr.RecordingStream, report: RobotReport) -> None:
    """How high it is and what is left of its battery, as plots."""
    rec.log(f"flight/height_m/{report.robot}", rr.Scalars(report.position_enu_m[2]))
    if report.battery is not None:
        rec.log(f"flight/battery_percent/{report.robot}", rr.Scalars(100.0 * report.battery))


def way_ahead(report: RobotReport) -> list[Vec3]:
    """What is left of a robot's way from where it is: at its heights where it tells them, else just over the floor."""
    if not report.path_m:
        return []
    if len(report.path_heights_m) != len(report.path_m):
        x, y, _ = report.position_enu_m
        return [(x, y, _FLOOR_M), *((px, py, _FLOOR_M) for px, py in report.path_m)]
    return [report.position_enu_m, *((x, y, z) for (x, y), z in zip(report.path_m, report.path_heights_m, strict=True))]
