"""Looking takes its time: a thread looks while the loop goes on, and the result is due a fixed time after the picture.

Fixed, and not as soon as it is there, so that in lockstep the same run gives the same bytes whatever the machine.
"""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from math import inf
from typing import Generic, TypeVar

LOOK_S = 0.15
"""From a picture's arrival to what is said of it, on the mesh's clock."""

Result = TypeVar("Result")


class Pending(Generic[Result]):
    """Work handed in, done in order by one thread, and handed out when it is due."""

    def __init__(self, name: str, takes_s: float = LOOK_S) -> None:
        self._takes_s = takes_s
        self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix=name)
        self._waiting: deque[tuple[float, Future[Result]]] = deque()

    def begin(self, now_s: float, work: Callable[[], Result]) -> None:
        self._waiting.append((now_s + self._takes_s, self._pool.submit(work)))

    def due(self, now_s: float) -> list[Result]:
        """Results due by now, oldest first; waits for those that are late. Raises what the work raised."""
        results = []
        while self._waiting and self._waiting[0][0] <= now_s + 1e-6:
            results.append(self._waiting.popleft()[1].result())
        return results

    @property
    def next_due_s(self) -> float:
        """When the oldest result that is not handed out yet is due; infinite when there is none."""
        return self._waiting[0][0] if self._waiting else inf

    def close(self) -> None:
        """Forget what is not due yet."""
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._waiting.clear()
