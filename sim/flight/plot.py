"""Step responses as a picture: what was asked for, what the vehicle truly did."""

from pathlib import Path

import cv2
import numpy as np

from sim.flight.state import Trajectory, Vec3
from sim.flight.world import BareFloor

_WIDTH_PX, _HEIGHT_PX, _LEFT_PX, _GAP_PX = 1100, 240, 70, 52
_FONT = cv2.FONT_HERSHEY_SIMPLEX
_INK, _GRID, _ASKED_BGR, _DONE_BGR = (40, 40, 40), (225, 225, 225), (60, 60, 210), (170, 110, 40)
_START: Vec3 = (0.0, 0.0, -2.0)
_STEPS: tuple[tuple[str, int, Vec3, float], ...] = (
    ("north, 10 m", 0, (10.0, 0.0, -2.0), 10.0),
    ("east, 2 m", 1, (0.0, 2.0, -2.0), 6.0),
    ("up, 1.5 m", 2, (0.0, 0.0, -3.5), 6.0),
)


def draw_steps(path: Path, seed: int = 0) -> None:
    """One row for each step: metres over seconds."""
    image = np.full((len(_STEPS) * (_HEIGHT_PX + _GAP_PX) + _GAP_PX, _WIDTH_PX, 3), 255, np.uint8)
    for row, (name, axis, target, span_s) in enumerate(_STEPS):
        times, values = _respond(axis, target, span_s, seed)
        top = row * (_HEIGHT_PX + _GAP_PX) + _GAP_PX
        sign = -1.0 if axis == 2 else 1.0  # heights are drawn, not depths
        _draw(image, top, name, times, values, sign * _START[axis], sign * target[axis])
    cv2.imwrite(str(path), image)


def _respond(axis: int, target: Vec3, span_s: float, seed: int) -> tuple[list[float], list[float]]:
    world = BareFloor(seed=seed)
    vehicle = world.vehicles[0]
    world.advance(1.0)
    vehicle.arm()
    vehicle.command(Trajectory(_START, heading_rad=0.0))
    world.advance(7.0)
    vehicle.command(Trajectory(target, heading_rad=0.0))
    times, values = [], []
    for step in range(round(span_s / 0.05)):
        east, north, up = vehicle.true_pose()[0]
        times.append(0.05 * step)
        values.append((north, east, up)[axis])
        world.advance(0.05)
    world.close()
    return times, values


def _draw(
    image: np.ndarray, top: int, name: str, times_s: list[float], values: list[float], start: float, target: float
) -> None:
    low, high = min(start, target), max(start, target)
    low, high = low - 0.15 * (high - low), high + 0.15 * (high - low)
    right = _WIDTH_PX - 20

    def point(time_s: float, value: float) -> tuple[int, int]:
        x = _LEFT_PX + (right - _LEFT_PX) * time_s / times_s[-1]
        return (int(x), int(top + _HEIGHT_PX * (high - value) / (high - low)))

    for second in range(int(times_s[-1]) + 1):
        cv2.line(image, point(second, low), point(second, high), _GRID, 1)
        cv2.putText(
            image, f"{second} s", (point(second, low)[0] - 8, top + _HEIGHT_PX + 16), _FONT, 0.4, _INK, 1, cv2.LINE_AA
        )
    for value in (start, target):
        cv2.putText(image, f"{value:g} m", (8, point(0.0, value)[1] + 5), _FONT, 0.45, _INK, 1, cv2.LINE_AA)
    asked = [point(0.0, start), point(0.0, target), point(times_s[-1], target)]
    cv2.polylines(image, [np.array(asked, np.int32)], False, _ASKED_BGR, 1, cv2.LINE_AA)
    done = [point(t, v) for t, v in zip(times_s, values, strict=True)]
    cv2.polylines(image, [np.array(done, np.int32)], False, _DONE_BGR, 2, cv2.LINE_AA)
    cv2.putText(image, name, (_LEFT_PX, top - 8), _FONT, 0.55, _INK, 1, cv2.LINE_AA)
