"""Success and tokens over the error rate, a line for each planner."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np

_WIDTH_PX, _HEIGHT_PX, _LEFT_PX, _TOP_PX, _PANEL_PX = 1100, 470, 80, 70, 400
_FONT = cv2.FONT_HERSHEY_SIMPLEX
_INK, _GRID = (40, 40, 40), (225, 225, 225)
_COLOURS = ((40, 40, 40), (180, 110, 30), (60, 60, 210), (70, 160, 70), (170, 60, 160), (30, 150, 220), (120, 120, 120))
Row = dict[str, Any]


def draw(rows: Sequence[Row], label: str, path: Path) -> None:
    """Two panels and a legend; `label` stands above them."""
    image = np.full((_HEIGHT_PX, _WIDTH_PX, 3), 255, np.uint8)
    _say(image, label, (_LEFT_PX, 28), 0.55)
    planners = list(dict.fromkeys(row["planner"] for row in rows))
    most = max((row["tokens"] for row in rows), default=1) or 1
    panels: tuple[tuple[str, float, Callable[[Row], float]], ...] = (
        ("share of episodes that succeeded", 1.0, lambda row: row["succeeded"] / row["episodes"]),
        ("tokens of an episode (median)", float(most), lambda row: float(row["tokens"])),
    )
    widest = max((row["rate"] for row in rows), default=0.0) or 1.0
    for number, (title, top, value) in enumerate(panels):
        left = _LEFT_PX + number * (_PANEL_PX + 80)
        _frame(image, left, title, top, sorted({row["rate"] for row in rows}))
        for planner, colour in zip(planners, _colours(planners), strict=True):
            points = [_at(left, row["rate"] / widest, value(row) / top) for row in rows if row["planner"] == planner]
            cv2.polylines(image, [np.array(points, np.int32)], False, colour, 2, cv2.LINE_AA)
            for point in points:
                cv2.circle(image, point, 4, colour, -1, cv2.LINE_AA)
    for number, (planner, colour) in enumerate(zip(planners, _colours(planners), strict=True)):
        x = _LEFT_PX + 165 * number
        cv2.line(image, (x, _HEIGHT_PX - 18), (x + 22, _HEIGHT_PX - 18), colour, 3, cv2.LINE_AA)
        _say(image, planner, (x + 28, _HEIGHT_PX - 13), 0.45)
    cv2.imwrite(str(path), image)


def _colours(planners: Sequence[str]) -> list[tuple[int, int, int]]:
    return [_COLOURS[i % len(_COLOURS)] for i in range(len(planners))]


def _at(left: int, across: float, up: float) -> tuple[int, int]:
    bottom = _HEIGHT_PX - 80
    return (int(left + (_PANEL_PX - 20) * across), int(bottom - (bottom - _TOP_PX - 20) * up))


def _frame(image: np.ndarray, left: int, title: str, top: float, rates: Sequence[float]) -> None:
    _say(image, title, (left, _TOP_PX), 0.5)
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        cv2.line(image, _at(left, 0.0, part), _at(left, 1.0, part), _GRID, 1)
        x, y = _at(left, 0.0, part)
        _say(image, f"{part:.0%}" if top == 1.0 else f"{part * top:.0f}", (x - 58, y + 5), 0.4)
    for rate in rates:
        x, y = _at(left, rate / (rates[-1] or 1.0), 0.0)
        _say(image, f"{rate:.0%}", (x - 10, y + 20), 0.4)


def _say(image: np.ndarray, text: str, place: tuple[int, int], size: float) -> None:
    cv2.putText(image, text, place, _FONT, size, _INK, 1, cv2.LINE_AA)
