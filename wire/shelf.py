"""Where a node's messages lie in lockstep until its loop wants them: with Zenoh, without any of this program running.

One tick is one waking. Only the clock's own messages end the wait, and a nudge from an alarm that lets the loop look
round (is it asked to stop, has somebody gone?); all others are fetched when a tick hands them out.
"""

import threading
from collections.abc import Callable
from typing import Any

from wire.letter import Letter

NUDGE_S = 0.2
"""How long a signal to stop, or a death, may go unnoticed."""

Open = Callable[[Any], Letter | None]
"""A sample to a letter; None when it is none, such as a nudge."""


class Shelf:
    """`nudge` puts something that is no letter where the clock's messages come; it is called in a thread of its own."""

    def __init__(self, nudge: Callable[[], None]) -> None:
        self._nudge = nudge
        self._clock: tuple[Any, Open] | None = None
        self._boxes: list[tuple[Any, Open]] = []
        self._closed = threading.Event()
        self._alarm = threading.Thread(target=self._ring, name="alarm", daemon=True)

    def add(self, box: Any, open: Open) -> None:
        """A subscription to fetch from."""
        self._boxes.append((box, open))

    def add_clock(self, box: Any, open: Open) -> None:
        """The subscription to wait for."""
        self._clock = (box, open)
        self._alarm.start()

    def wait(self) -> list[Letter]:
        """The clock's next messages, as many as there are; none after a nudge."""
        assert self._clock is not None, "nobody waits for a clock that was not subscribed to"
        box, open = self._clock
        letters, sample = [], box.recv()
        while sample is not None:
            letter = open(sample)
            if letter is not None:
                letters.append(letter)
            sample = box.try_recv()
        return letters

    def fetch(self) -> list[Letter]:
        """All other messages that have come since the last call, in no particular order."""
        letters = []
        for box, open in self._boxes:
            while (sample := box.try_recv()) is not None:
                letter = open(sample)
                if letter is not None:
                    letters.append(letter)
        return letters

    def close(self) -> None:
        """The last nudge is over when this returns."""
        self._closed.set()
        if self._alarm.is_alive():
            self._alarm.join(NUDGE_S)

    def _ring(self) -> None:
        while not self._closed.wait(NUDGE_S):
            self._nudge()
