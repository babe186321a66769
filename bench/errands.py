"""Robots kept on their way by an operator: task after task for the hub, with the plans of `bench.tour`."""

import time

from console.bring_up import Ready
from console.client import Client
from console.task import RUNNING
from devices.reporter import PROGRESS_S
from wire.messages.command import Progress
from wire.messages.operator import TaskQuery, TaskRequest, TaskState

WORDS = "go round"
LOOK_S = 0.2


class Errands:
    """Handed to `bench.pace.pace` for the measured time."""

    def __init__(self) -> None:
        self.tasks = 0
        self._told = 0

    def __call__(self, ready: Ready, seconds: float) -> None:
        """Task after task for so many seconds of the wall."""
        deadline = time.monotonic() + seconds
        with Client(ready.site, ready.mesh.credentials_dir) as client:
            client.on("progress", Progress, self._count)
            while time.monotonic() < deadline:
                self.tasks += 1
                id = f"errand-{self.tasks}"
                state = client.ask("task", TaskRequest(task=id, instruction=WORDS), TaskState)
                while state.status in RUNNING and time.monotonic() < deadline:
                    time.sleep(min(LOOK_S, max(0.0, deadline - time.monotonic())))
                    state = client.ask("task_query", TaskQuery(task=id), TaskState)

    def robots_at_work(self, simulated_s: float) -> float:
        """How many had a goal, on average: each of them tells of its progress at this period, in simulated time."""
        return self._told * PROGRESS_S / simulated_s

    def _count(self, progress: Progress) -> None:
        self._told += 1
