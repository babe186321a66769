"""A land detector: from thrust and estimate, as a vehicle without feet that feel has to."""

_RESTS_S, _STANDS_S = 0.4, 0.5
_RISING_M = 0.08


class Touchdown:
    """Whether the vehicle stands on something."""

    __slots__ = ("_ground_down_m", "_since_s", "landed")

    def __init__(self) -> None:
        self.landed = True
        self._since_s: float | None = None
        self._ground_down_m: float | None = None

    def look(
        self, now_s: float, armed: bool, thrust: float, hover: float, down_m: float, down_mps: float, wish: float
    ) -> None:
        """`thrust` and `hover` as parts of the full thrust; `wish` the velocity down that is asked for."""
        if self.landed:
            if self._ground_down_m is None or not armed:
                self._ground_down_m = down_m
            risen = self._ground_down_m - down_m > _RISING_M and down_mps < -0.05
            fallen = not armed and abs(down_mps) > 0.5
            if fallen or (armed and risen and thrust > 0.6 * hover):
                self.landed, self._since_s = False, None
            return
        still = abs(down_mps) < 0.15
        resting = still and thrust < 0.75 * hover and wish > 0.05 if armed else still
        if not resting:
            self._since_s = None
        elif self._since_s is None:
            self._since_s = now_s
        elif now_s - self._since_s > (_RESTS_S if armed else _STANDS_S):
            self.landed, self._ground_down_m = True, down_m
