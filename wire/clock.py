"""The mesh's time: the wall's, or in lockstep the ticks of one owner, who waits for every follower."""

import time
from collections.abc import Iterable

from wire.keys import Role
from wire.site import Site

FOLLOWER_ROLES: frozenset[Role] = frozenset(("hub", "planner", "cctv", "robot"))
"""Who decides something holds time up; who only looks on does not."""
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


class Roll:
    """Which followers are there, and which of them still owe their answer to the newest tick."""

    def __init__(self, followers: Iterable[str]) -> None:
        self._followers = frozenset(followers)
        self._present: set[str] = set()
        self._waiting: set[str] = set()
        self._tick = -1

    @property
    def absent(self) -> list[str]:
        return sorted(self._followers - self._present)

    @property
    def waiting(self) -> list[str]:
        return sorted(self._waiting)

    @property
    def deserted(self) -> bool:
        """There should be followers, and none is there: time stands still."""
        return bool(self._followers) and not self._present

    def presence(self, process: str, alive: bool) -> None:
        if process not in self._followers:
            return
        if alive:
            self._present.add(process)  # joins with the next tick
        else:
            self._present.discard(process)
            self._waiting.discard(process)

    def begin(self, tick: int) -> None:
        self._tick = tick
        self._waiting = set(self._present)

    def done(self, follower: str, tick: int) -> None:
        if tick == self._tick:
            self._waiting.discard(follower)


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


def followers_of(site: Site) -> list[str]:
    """The processes that are expected to follow the clock."""
    return [p.id for p in site.process if p.role in FOLLOWER_ROLES and p.autostart]


def owner_of(site: Site) -> str:
    """The process that owns the clock in lockstep; empty by the wall clock."""
    if site.clock.mode == "wall":
        return ""
    return next((p.id for p in site.process if p.role == "sim"), "")
