"""How long a full battery keeps a drone in the air: as its autopilot reckons, or else as its charge has gone so far."""

from math import isfinite

SETTLED_S = 10.0
"""Rotors that have only begun to turn say nothing of how long they can."""
LEAST_CHARGE, LEAST_DRAIN = 0.05, 0.06
"""Below so much of the battery, and before so much of it has gone, quotients say nothing: charge is told in hundredths."""
SHORTEST_S, LONGEST_S = 30.0, 36_000.0
FRESH = 0.1
"""The part that the newest of the autopilot's own guesses has in what is believed."""


class Endurance:
    """`full_s` is None until something is known; it is kept on the ground."""

    def __init__(self) -> None:
        self.full_s: float | None = None
        self._since: tuple[float, float] | None = None
        """When it was in the air first in this flight, and the charge then."""
        self._told = False
        """The autopilot reckons by itself: what is learned here is worth less."""

    def take(self, now_s: float, airborne: bool, charge: float | None, left_s: float | None) -> None:
        """`left_s`: how long the autopilot believes that what is left keeps it in the air."""
        if not airborne or charge is None:
            self._since = None
            return
        if self._since is None or charge > self._since[1]:
            self._since = (now_s, charge)
        flown_s, gone = now_s - self._since[0], self._since[1] - charge
        if flown_s < SETTLED_S:
            return
        if left_s is not None and charge >= LEAST_CHARGE:
            known = self.full_s if self._told else None
            self._believe(left_s / charge if known is None else known + FRESH * (left_s / charge - known), True)
        elif not self._told and gone >= LEAST_DRAIN:
            self._believe(flown_s / gone, False)

    def _believe(self, full_s: float, told: bool) -> None:
        if isfinite(full_s) and SHORTEST_S <= full_s <= LONGEST_S:
            self.full_s, self._told = full_s, told
