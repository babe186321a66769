"""A start is waited for as long as something moves, and no longer."""

from console.patience import MOST_STARTS, OWN_LIMIT_S, QUIET_S, Patience
from deploy.launch import ProcessInfo


def _process(pid: int = 1, up_s: float = 0.0, cpu_s: float = 0.0) -> ProcessInfo:
    return ProcessInfo("sim", "RUNNING", pid, up_s, cpu_s, 0, "")


def _gives_up_s(moves, step_s: float = 5.0, limit_s: float = 2000.0) -> float | None:
    """When it gives up on one process; `moves(time)` says who is here and how the process stands."""
    patience = Patience(0.0)
    for step in range(round(limit_s / step_s)):
        here, process = moves(step * step_s)
        if patience.over(here, [process], step * step_s):
            return step * step_s
    return None


def test_nothing_moves() -> None:
    assert _gives_up_s(lambda t_s: (set(), _process(up_s=t_s))) == QUIET_S + 5.0


def test_one_that_only_waits_does_not_move() -> None:
    assert _gives_up_s(lambda t_s: (set(), _process(up_s=t_s, cpu_s=0.002 * t_s))) == QUIET_S + 5.0


def test_one_that_works_slowly_is_waited_for_within_its_own_limit() -> None:
    given_up_s = _gives_up_s(lambda t_s: (set(), _process(up_s=t_s, cpu_s=0.1 * t_s)))
    assert given_up_s == OWN_LIMIT_S + QUIET_S + 5.0


def test_who_comes_late_is_a_sign() -> None:
    assert _gives_up_s(lambda t_s: ({"hub"} if t_s >= 50.0 else set(), _process())) == 50.0 + QUIET_S + 5.0


def test_one_that_comes_up_again_and_again_is_given_up() -> None:
    given_up_s = _gives_up_s(lambda t_s: (set(), _process(pid=1 + int(t_s / 20.0), cpu_s=5.0)))
    assert given_up_s == 20.0 * (MOST_STARTS - 1) + QUIET_S + 5.0
