"""Where callbacks leave what arrived and the deciding loop picks it up: one queue, in the order of arrival.

A full inbox makes the callback wait, which holds back the link and with it the sender: nothing is lost. Of topics whose
readers want the newest only, an older letter makes room for the newer one at once.
"""

import threading
import time
from itertools import islice

from wire.keys import TOPIC
from wire.letter import Kind, Letter

MAX_BYTES = 64_000_000
LETTER_BYTES = 300
"""What a letter takes besides its payload, roughly."""


class Inbox:
    """Filled by Zenoh's threads, emptied by one loop."""

    def __init__(self, keep_newest_only: bool, max_bytes: int = MAX_BYTES) -> None:
        self._keep_newest_only = keep_newest_only
        self._max_bytes = max_bytes
        self._changed = threading.Condition()
        self._letters: dict[object, Letter] = {}
        self._bytes = 0
        self._count = 0
        self._closed = False

    def put(self, letter: Letter) -> None:
        """Called by callbacks. Waits while the inbox is full; when it is closed, forgets the letter."""
        with self._changed:
            key = self._key(letter)
            replaced = self._letters.pop(key, None)
            if replaced is not None:
                self._bytes -= _size(replaced)
            while self._bytes > self._max_bytes and not self._closed:
                self._changed.wait()
            self._letters[key] = letter
            self._bytes += _size(letter)
            if len(self._letters) == 1:
                self._changed.notify_all()

    def take(self, timeout_s: float, limit: int | None = None) -> list[Letter]:
        """What has arrived, oldest first; at most `limit` letters. Waits at most this long for the first."""
        deadline_s = time.monotonic() + timeout_s
        with self._changed:
            while not self._letters and not self._closed:
                rest_s = deadline_s - time.monotonic()
                if rest_s <= 0.0 or not self._changed.wait(rest_s):
                    break
            if limit is None or len(self._letters) <= limit:
                taken, self._letters = list(self._letters.values()), {}
                self._bytes = 0
            else:
                taken = [self._letters.pop(key) for key in list(islice(self._letters, limit))]
                self._bytes -= sum(map(_size, taken))
            self._changed.notify_all()
        return taken

    def close(self) -> None:
        """Let every waiting callback go, so that the session can close."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _key(self, letter: Letter) -> object:
        if self._keep_newest_only and letter.kind is Kind.MESSAGE and TOPIC[letter.name].delivery == "latest":
            return (letter.name, letter.id)
        self._count += 1
        return self._count


def _size(letter: Letter) -> int:
    return len(letter.payload) + LETTER_BYTES
