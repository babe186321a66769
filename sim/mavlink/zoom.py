"""The camera's zoom lens: how far it is in, and where the commands of the five kinds send it."""

import math
from dataclasses import dataclass

WIDEST_MM, LONGEST_MM = 3.0, 12.0
SENSOR_MM = (3.68, 2.76)
PER_S = 25.0
"""Hundredths of its range in a second."""
STEP = 10.0
BY_STEPS, ON_AND_ON, TO_PART, TO_FOCAL_LENGTH, TO_VIEW = 0.0, 1.0, 2.0, 3.0, 4.0
"""CAMERA_ZOOM_TYPE."""
ZOOM_KINDS = (BY_STEPS, ON_AND_ON, TO_PART, TO_FOCAL_LENGTH, TO_VIEW)


def _part(focal_mm: float) -> float:
    """In hundredths of the range."""
    return 100.0 * (focal_mm - WIDEST_MM) / (LONGEST_MM - WIDEST_MM)


@dataclass(slots=True)
class Zoom:
    level: float = 0.0
    """In hundredths of the range, 0 is wide."""
    _to: float = 0.0

    @property
    def focal_mm(self) -> float:
        return WIDEST_MM + (LONGEST_MM - WIDEST_MM) * self.level / 100.0

    @property
    def view_deg(self) -> tuple[float, float]:
        """The angles that the picture spans, across and down."""
        across, down = (math.degrees(2 * math.atan(size / 2 / self.focal_mm)) for size in SENSOR_MM)
        return across, down

    def target(self, kind: float, value: float) -> float | None:
        """Where a command sends it, bounded to the range; None where its kind or its value makes no sense."""
        level = {
            BY_STEPS: self._to + STEP * value,
            ON_AND_ON: {-1.0: 0.0, 0.0: self.level, 1.0: 100.0}.get(value, math.nan),
            TO_PART: value if 0.0 <= value <= 100.0 else math.nan,
            TO_FOCAL_LENGTH: _part(value) if value > 0.0 else math.nan,
            TO_VIEW: _of_view(value) if 0.0 < value < 180.0 else math.nan,
        }.get(kind, math.nan)
        return max(0.0, min(100.0, level)) if math.isfinite(level) else None

    def go(self, level: float) -> None:
        self._to = level

    def step(self, span_s: float) -> bool:
        """Move for this long; whether it has just come to where it was sent."""
        if self.level == self._to:
            return False
        most = PER_S * span_s
        self.level += max(-most, min(most, self._to - self.level))
        return self.level == self._to


def _of_view(across_deg: float) -> float:
    return _part(SENSOR_MM[0] / 2 / math.tan(math.radians(across_deg) / 2))
