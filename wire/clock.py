"""The mesh's time: the wall's, or in lockstep the ticks of one owner, who waits for every follower."""

import time
from collections.abc import Iterable, Mapping
from math import ceil, floor
from typing import cast

from wire.bus import Core, Resting
from wire.keys import FOLLOWERS
from wire.site import Site

LONGEST_REST_S = 0.5
"""Whoever rests hears after this at the latest what was published; a question or an answer ends its rest."""
LATE_S = 1.0
"""Behind by more than this, the pace is taken up anew instead of being caught up with."""


class WallClock:
    """Seconds since 1970 that never go back."""

    def __init__(self) -> None:
        self._newest_s = 0.0

    def now_s(self) -> float:
        self._newest_s = max(self._newest_s, time.time())
        return self._newest_s


def boot_id(first_step_s: float) -> str:
    """What a run of a process is called: the time of its first step, which a later run of it can never have."""
    return f"{first_step_s:.6f}"


def next_turn(core: Core, beat_due_s: float, tick: int, now_s: float, step_s: float) -> int:
    """The tick in which a core that has just stepped at `now_s` steps next; a heartbeat that is due ends a rest."""
    if not hasattr(core, "rests_until_s"):  # `isinstance` of a protocol costs as much as the rest of a turn
        return tick + 1
    rest_s = min(cast(Resting, core).rests_until_s() - now_s, beat_due_s - now_s, LONGEST_REST_S)
    wanted = ceil(max(rest_s, 0.0) / step_s - 1e-6)
    return tick + max(1, min(wanted, floor(LONGEST_REST_S / step_s + 1e-6)))


class Roll:
    """Which followers are there, whose turn it is, and who still owes the answer to the newest tick."""

    def __init__(self, followers: Mapping[str, str]) -> None:
        """`followers` and their roles."""
        self._followers = dict(followers)
        self._turns: dict[str, int] = {}
        """Of those who are there: the tick of the next turn."""
        self._waiting: set[str] = set()
        self._woken: set[str] = set()
        """Who was named in answers to this tick: a process, or a role."""
        self._tick = -1

    @property
    def absent(self) -> list[str]:
        return sorted(self._followers.keys() - self._turns.keys())

    @property
    def waiting(self) -> list[str]:
        return sorted(self._waiting)

    @property
    def deserted(self) -> bool:
        """There should be followers, and none is there: time stands still."""
        return bool(self._followers) and not self._turns

    def presence(self, process: str, alive: bool) -> None:
        if process not in self._followers:
            return
        if alive:
            self._turns.setdefault(process, 0)  # joins with the next tick
        else:
            self._turns.pop(process, None)
            self._waiting.discard(process)

    def begin(self, tick: int) -> list[str]:
        """Those whose turn it is, and who are waited for from now on."""
        self._tick = tick
        woken, self._woken = self._woken, set()
        self._waiting = {
            follower
            for follower, turn in self._turns.items()
            if turn <= tick or follower in woken or self._followers[follower] in woken
        }
        return self.waiting

    def done(self, follower: str, tick: int, next_turn: int = 0, wakes: Iterable[str] = ()) -> None:
        if tick == self._tick and follower in self._waiting:
            self._woken.update(wakes)
            self._waiting.discard(follower)
            self._turns[follower] = next_turn


class Pace:
    """No faster than `speed` simulated seconds a second; 0 is as fast as possible."""

    def __init__(self, speed: float) -> None:
        self._speed = speed
        self._start: tuple[float, float] | None = None

    def ahead_s(self, now_s: float, wall_s: float) -> float:
        """How long to wait before `now_s` may be reached."""
        if self._speed <= 0.0:
            return 0.0
        if self._start is None:
            self._start = (now_s, wall_s)
        ahead_s = (now_s - self._start[0]) / self._speed - (wall_s - self._start[1])
        if ahead_s < -LATE_S:
            self._start = (now_s, wall_s)
        return max(0.0, ahead_s)


def followers_of(site: Site) -> dict[str, str]:
    """The processes that are expected to follow the clock, and their roles."""
    return {p.id: p.role for p in site.process if p.role in FOLLOWERS and p.autostart}


def owner_of(site: Site) -> str:
    """The process that owns the clock in lockstep; empty by the wall clock."""
    if site.clock.mode == "wall":
        return ""
    return next((p.id for p in site.process if p.role == "sim"), "")
