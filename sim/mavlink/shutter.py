"""When the camera takes pictures by itself: a series in time, and one every so many metres of way."""

import math
from dataclasses import dataclass

from sim.flight.state import Vec3

LEAST_INTERVAL_S = 0.1


@dataclass(slots=True)
class Series:
    """One picture after another."""

    interval_s: float = 0.0
    left: int = 0
    """Pictures still to be taken; -1 without end."""
    next_s: float = math.inf

    def start(self, number: int, interval_s: float, now_s: float) -> None:
        """`number` of pictures, 0 for without end."""
        self.left, self.interval_s, self.next_s = number or -1, max(interval_s, LEAST_INTERVAL_S), now_s

    def stop(self) -> None:
        self.left, self.next_s = 0, math.inf

    @property
    def runs(self) -> bool:
        return not math.isinf(self.next_s)

    def due(self, now_s: float) -> bool:
        """Whether one is to be taken now; counts it."""
        if now_s < self.next_s:
            return False
        self.left -= self.left > 0
        self.next_s = now_s + self.interval_s if self.left else math.inf
        return True


@dataclass(slots=True)
class Spacing:
    """Pictures by distance across the ground."""

    every_m: float = 0.0
    """0 for none."""
    by_mission: bool = False
    """The mission asked for it."""
    _at: tuple[float, float] | None = None

    def start(self, every_m: float, by_mission: bool) -> None:
        self.every_m, self.by_mission, self._at = max(every_m, 0.0), by_mission, None

    def due(self, here: Vec3) -> bool:
        """Whether one is to be taken here; the next is counted from here then."""
        at = (here[0], here[1])
        if self._at is None:
            self._at = at
        if math.dist(at, self._at) < self.every_m:
            return False
        self._at = at
        return True
