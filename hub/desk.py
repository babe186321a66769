"""What people ask of the hub: tasks, their state, control, why. One task is carried out at a time, the others queue."""

import json

from hub.calls import calls_of
from hub.conductor import Conductor
from hub.journal import Journal
from hub.ledger import log
from hub.task import Task, read_task
from hub.voice import Voice
from hub.why import why
from hub.world import World
from wire.bus import Request
from wire.messages.operator import (
    CallsRequest,
    ControlReply,
    ControlRequest,
    TaskQuery,
    TaskRequest,
    TaskState,
    WhyRequest,
)
from wire.messages.world import SnapshotRequest

_CLOCK_S = 1.0


class Desk:
    """The tasks in the order in which they came, and the answers to requests."""

    def __init__(self, world: World, conductor: Conductor, journal: Journal, voice: Voice) -> None:
        self._world, self._conductor, self._journal, self._voice = world, conductor, journal, voice
        self._tasks: dict[str, Task] = {}

    def restore(self, now_s: float) -> bool:
        """The tasks of an earlier run of the hub; True when one of them is to be gone on with.

        A clock that stands before the last decision is another clock: then nothing is gone on with.
        """
        another = self._journal.last_s() > now_s + _CLOCK_S
        for id in json.loads(self._journal.read("tasks") or "[]"):
            text = self._journal.read(f"task/{id}")
            if text is not None:
                task = self._tasks[id] = read_task(text)
                if another and not task.ended:
                    task.status, task.reason = "cancelled", "the mesh was started anew in between; ask again"
                elif not task.ended:
                    log.info("%s at %.1f s: goes on, from the journal: %s", id, now_s, task.status)
        return any(not task.ended for task in self._tasks.values())

    def step(self, now_s: float) -> None:
        """Start the next task when none is being carried out."""
        active = self._conductor.task
        if active is not None and not active.ended:
            return
        waiting = next((t for t in self._tasks.values() if not t.ended), None)
        if waiting is not None:
            waiting.reason = ""
            self._conductor.begin(waiting, now_s)
            self._voice.show(waiting)

    def answer(self, request: Request, now_s: float) -> None:
        message = request.message
        if isinstance(message, TaskRequest):
            request.reply(self._take(message, now_s))
        elif isinstance(message, TaskQuery):
            request.reply(self._state(message, now_s))
        elif isinstance(message, CallsRequest):
            request.reply(calls_of(message.task, list(self._tasks), self._journal))
        elif isinstance(message, ControlRequest):
            request.reply(self._control(message, now_s))
        elif isinstance(message, WhyRequest):
            request.reply(why(self._world, message.object, now_s))
        elif isinstance(message, SnapshotRequest):
            request.reply(self._world.snapshot(now_s))

    def _take(self, request: TaskRequest, now_s: float) -> TaskState:
        known = self._tasks.get(request.task)
        if known is not None:
            return known.state(now_s)
        task = self._tasks[request.task] = Task(request.task, request.instruction, now_s)
        active = self._conductor.task
        if active is not None and not active.ended:
            task.reason = f"waits for task {active.id} to end"
        task.say(now_s, f"asked: {request.instruction}")
        state = {"tasks": json.dumps(list(self._tasks)), f"task/{task.id}": task.write()}
        self._journal.decide(now_s, "task", request.model_dump_json(), state)
        log.info("%s at %.1f s: asked: %s", task.id, now_s, request.instruction)
        self._voice.show(task)
        return task.state(now_s)

    def _state(self, query: TaskQuery, now_s: float) -> TaskState:
        if query.task is not None and query.task in self._tasks:
            return self._tasks[query.task].state(now_s)
        if query.task is None and self._tasks:
            return next(reversed(self._tasks.values())).state(now_s)
        known = ", ".join(self._tasks) or "none yet"
        return TaskState(
            task=query.task or "none",
            instruction="",
            status="refused",
            stamp_s=now_s,
            started_s=now_s,
            reason=f"there is no such task; known are: {known}",
        )

    def _control(self, request: ControlRequest, now_s: float) -> ControlReply:
        if request.verb == "stop":
            return self._stop(now_s)
        task = self._chosen(request.task)
        if task is None:
            return self._nothing_to(request)
        if task is not self._conductor.task:
            if request.verb != "cancel":
                return ControlReply(ok=False, text=f"{task.id} has not begun; it can only be cancelled")
            self._cancel_waiting(task, now_s)
            return ControlReply(ok=True, text=f"{task.id} cancelled before it began")
        if task.halting == "cancel":
            return ControlReply(ok=request.verb == "cancel", text=f"{task.id} is being cancelled")
        return self._control_active(request, task, now_s)

    def _nothing_to(self, request: ControlRequest) -> ControlReply:
        """No such task goes on. Fine for who wants everything to stand still, but not for who waits for it to go on."""
        if request.task is None:
            done = "paused" if request.verb == "resume" else "running"
            return ControlReply(
                ok=request.verb != "resume", text=f"no task is {done}; there is nothing to {request.verb}"
            )
        task = self._tasks.get(request.task)
        if task is not None:
            return ControlReply(
                ok=False, text=f"{task.id} has ended: {task.status}; there is nothing to {request.verb}"
            )
        known = ", ".join(t.id for t in self._tasks.values() if not t.ended) or "none"
        return ControlReply(ok=False, text=f"there is no task {request.task}; running or waiting: {known}")

    def _control_active(self, request: ControlRequest, task: Task, now_s: float) -> ControlReply:
        """What is so already is answered as if it had just been done: a terminal asks again when an answer was lost."""
        pausing = task.status == "paused" or task.halting == "pause"
        if request.verb == "resume":
            if not pausing:
                return ControlReply(ok=True, text=f"{task.id} is not paused: it is {task.status}")
            self._conductor.resume(now_s)
            return ControlReply(ok=True, text=f"{task.id} goes on")
        if request.verb == "pause":
            if task.status == "paused":
                return ControlReply(ok=True, text=f"{task.id} is paused already")
            if not pausing:
                self._conductor.halt("pause", "paused by the operator", now_s)
            return ControlReply(ok=True, text=f"{task.id} pauses as soon as its robots stand still")
        self._conductor.halt("cancel", "cancelled by the operator", now_s)
        return ControlReply(ok=True, text=f"{task.id} is being cancelled")

    def _stop(self, now_s: float) -> ControlReply:
        robots = sorted(r.id for r in self._world.fleet.here())
        open_tasks = [task for task in self._tasks.values() if not task.ended]
        log.info("at %.1f s: stop of %s and of %s", now_s, ", ".join(robots) or "no robot", _named(open_tasks))
        for robot in robots:
            self._voice.cancel(robot, None)
        for task in open_tasks:
            if task is self._conductor.task:
                self._conductor.halt("cancel", "stopped by the operator", now_s)
            else:
                self._cancel_waiting(task, now_s)
        told = f"stopping {', '.join(robots) or 'no robot: none is there'}"
        return ControlReply(ok=True, text=told if open_tasks else f"no task is running; {told} all the same")

    def _cancel_waiting(self, task: Task, now_s: float) -> None:
        task.status, task.reason = "cancelled", "cancelled before it began"
        self._journal.decide(now_s, "end", f"{task.id} cancelled", {f"task/{task.id}": task.write()})
        log.info("%s at %.1f s: end: %s", task.id, now_s, task.reason)
        self._voice.show(task)

    def _chosen(self, id: str | None) -> Task | None:
        """The task named, or the active one."""
        task = self._tasks.get(id) if id is not None else self._conductor.task
        return None if task is None or task.ended else task


def _named(tasks: list[Task]) -> str:
    return ", ".join(task.id for task in tasks) or "no task"
