"""The claims of a measurement as bars: how far each is on the right side of its target."""

from math import log2
from pathlib import Path
from typing import Any

import cv2
import numpy as np

_ROW_PX, _LEFT_PX, _WIDTH_PX, _PER_DOUBLING_PX = 34, 480, 1180, 90
_FONT = cv2.FONT_HERSHEY_SIMPLEX
_GOOD_BGR, _BAD_BGR, _INK = (110, 170, 70), (60, 60, 210), (40, 40, 40)


def draw_rows(rows: list[dict[str, Any]], path: Path) -> None:
    """A bar to the right is better than promised, each step a factor of two; to the left it falls short."""
    height = _ROW_PX * (len(rows) + 2)
    image = np.full((height, _WIDTH_PX, 3), 255, np.uint8)
    middle = _LEFT_PX + 250
    cv2.putText(image, "target (each step is a factor of two)", (middle - 120, 22), _FONT, 0.5, _INK, 1, cv2.LINE_AA)
    cv2.line(image, (middle, 30), (middle, height - 10), _INK, 1)
    for index, row in enumerate(rows):
        top = _ROW_PX * (index + 1)
        cv2.putText(image, row["name"], (10, top + 20), _FONT, 0.5, _INK, 1, cv2.LINE_AA)
        if "error" in row:
            cv2.putText(image, "not measured", (middle + 8, top + 20), _FONT, 0.5, _BAD_BGR, 1, cv2.LINE_AA)
            continue
        reach = int(np.clip(_PER_DOUBLING_PX * _doublings(row), -240, 330))
        colour = _GOOD_BGR if row["met"] else _BAD_BGR
        cv2.rectangle(image, (middle, top + 6), (middle + reach, top + 26), colour, -1)
        text = f"{row['value']:g} {row['unit']}"
        cv2.putText(image, text, (middle + max(reach, 0) + 8, top + 20), _FONT, 0.5, _INK, 1, cv2.LINE_AA)
    cv2.imwrite(str(path), image)


def _doublings(row: dict[str, Any]) -> float:
    """How many factors of two the value is better than its target."""
    value, target = row["value"], row["target"]
    if value <= 0 or target <= 0:
        return 2.0 if row["met"] else -2.0
    return log2(value / target) if row["at_least"] else log2(target / value)
