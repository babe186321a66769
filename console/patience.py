"""How long a start may take: as long as something moves, on a fast machine or a slow one."""

from collections.abc import Collection, Iterable

from deploy.launch import ProcessInfo

QUIET_S = 60.0
"""Given up when nothing has moved for this long."""
OWN_LIMIT_S = 300.0
"""One that has run for this long and has not announced itself no longer counts as starting."""
MOST_STARTS = 6
"""So often a process may be started anew, as one is that came before the router."""
WORKED_S = 0.5
"""This much of the processor's time is a sign of work; one that only waits uses less within `QUIET_S`."""


class Patience:
    """Told again and again how things stand, says when waiting has become vain."""

    def __init__(self, now_s: float) -> None:
        self._moved_s = now_s
        self._here: frozenset[str] = frozenset()
        self._pids: dict[str, set[int]] = {}
        self._worked_s: dict[int, float] = {}

    def over(self, here: Iterable[str], missing: Collection[ProcessInfo], now_s: float) -> bool:
        """Whether nobody has come, been started or worked for `QUIET_S`. `missing`: who has not announced itself."""
        arrived = frozenset(here)
        if arrived != self._here:
            self._here, self._moved_s = arrived, now_s
        if any([self._moves(process) for process in missing]):
            self._moved_s = now_s
        return now_s - self._moved_s > QUIET_S

    def _moves(self, process: ProcessInfo) -> bool:
        """Started anew, or worked since it last moved, within its own limits."""
        pids = self._pids.setdefault(process.id, set())
        if process.pid == 0:
            return False
        begun = process.pid not in pids
        pids.add(process.pid)
        if process.up_s > OWN_LIMIT_S or len(pids) > MOST_STARTS:
            return False
        worked = process.cpu_s - self._worked_s.get(process.pid, 0.0) >= WORKED_S
        if worked:
            self._worked_s[process.pid] = process.cpu_s
        return begun or worked
