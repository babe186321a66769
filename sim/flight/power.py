"""A battery of four lithium cells: charge, voltage under load, and hooks to provoke what a low one does."""

from sim.flight.state import Battery

CAPACITY_MAH = 5200.0
_CELLS, _EMPTY_V, _SPAN_V = 4, 3.45, 0.75
_LEAST_V = 8.0
"""What an empty one falls to at once, loaded or not."""
_RESISTANCE_OHM = 0.03
_FLYING_W = 20.0
"""With less the rotors do not turn."""
_LATELY_S = 10.0


class Power:
    """Drained by what the rotors take."""

    __slots__ = ("_broken_at", "_drain_s", "_pinned_v", "_taken_per_s", "state")

    def __init__(self) -> None:
        self.state = Battery(voltage_v=_rest_v(1.0))
        self._broken_at: float | None = None
        self._drain_s: float | None = None
        self._pinned_v: float | None = None
        self._taken_per_s: float | None = None
        """Part of the capacity that goes in a second, of late."""

    def provoke(self, remaining: float | None, drain_s: float | None, voltage_v: float | None) -> None:
        """`drain_s` of 0 and `voltage_v` of 0 let go of what was set before."""
        if remaining is not None:
            self.state.remaining = max(0.0, min(1.0, remaining))
            self.state.voltage_v = _rest_v(self.state.remaining)
        if drain_s is not None:
            self._drain_s = drain_s or None
        if voltage_v is not None:
            self._pinned_v = voltage_v or None

    def fail(self, works: bool) -> None:
        """A broken battery gives nothing; a mended one has the charge that it had."""
        if works and self._broken_at is not None:
            self.provoke(self._broken_at, None, None)
            self._broken_at = None
        elif not works and self._broken_at is None:
            self._broken_at = self.state.remaining
            self.provoke(0.0, None, None)

    def draw(self, power_w: float, span_s: float) -> None:
        state = self.state
        current_a = power_w / max(6.0, state.voltage_v)
        used = current_a * span_s / 3.6
        state.current_a = current_a
        state.consumed_mah += used
        gone = used / CAPACITY_MAH
        if self._drain_s is not None and power_w > _FLYING_W:
            gone = max(gone, span_s / self._drain_s)
        self._reckon(gone / span_s if power_w > _FLYING_W else None, span_s)
        state.remaining = max(0.0, state.remaining - gone)
        state.voltage_v = self._pinned_v or max(_LEAST_V, _rest_v(state.remaining) - _RESISTANCE_OHM * current_a)

    def _reckon(self, per_s: float | None, span_s: float) -> None:
        if per_s is not None and self._taken_per_s is not None:
            per_s = self._taken_per_s + (per_s - self._taken_per_s) * min(1.0, span_s / _LATELY_S)
        self._taken_per_s = per_s
        self.state.left_s = self.state.remaining / per_s if per_s else None


def _rest_v(remaining: float) -> float:
    return _CELLS * (_EMPTY_V + _SPAN_V * remaining) if remaining > 0.0 else _LEAST_V
