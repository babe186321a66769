"""What went wrong before, from the hub's sentences: which action on which thing failed, and how often.

A sentence names the action and the thing by its id ("dog-1 could not put fridge-1: no free spot"); nothing else of its
wording is relied on.
"""

import re
from collections import Counter
from collections.abc import Iterable, Sequence

from wire.messages.plan import FROM_ABOVE, KNOWN_ACTIONS

GIVE_UP = 3
"""So many failures of one action on one thing, and it is not tried again."""
_ACTIONS = KNOWN_ACTIONS | FROM_ABOVE.keys()
_TOKEN = re.compile(r"[a-z][a-z0-9_-]*")


class Failures:
    """Counts by action and thing, and the last sentence about each."""

    def __init__(self, sentences: Sequence[str], robots: Iterable[str]) -> None:
        self._counts: Counter[tuple[str, str]] = Counter()
        self._last: dict[str, str] = {}
        self._who: dict[tuple[str, str], set[str]] = {}
        names = set(robots)
        for sentence in sentences:
            words = _TOKEN.findall(sentence.lower())
            actions = [w for w in words if w in _ACTIONS][:1]
            about = dict.fromkeys(w for w in words if w not in _ACTIONS and w not in names)
            for action in actions:
                for word in about:
                    self._counts[action, word] += 1
                    self._who.setdefault((action, word), set()).update(names & set(words))
            for word in about:
                self._last[word] = sentence

    def count(self, action: str, id: str) -> int:
        return self._counts[action, id]

    def spent(self, action: str, id: str) -> bool:
        """It has failed too often to be tried once more."""
        return self._counts[action, id] >= GIVE_UP

    def robots(self, action: str, id: str) -> set[str]:
        """Who failed at it."""
        return self._who.get((action, id), set())

    def last(self, id: str) -> str:
        """What was said about a thing last."""
        return self._last.get(id, "")
