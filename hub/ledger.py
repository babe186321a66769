"""What the hub decides, kept where it belongs: the journal, the process's log, the published state of the task."""

import json
import logging

from hub.journal import Journal
from hub.memory import write_world
from hub.task import Task
from hub.voice import Voice
from hub.world import World
from wire.messages.plan import PlanReply

log = logging.getLogger("hub")


class Ledger:
    """One entry for each decision."""

    def __init__(self, world: World, journal: Journal, voice: Voice) -> None:
        self._world, self._journal, self._voice = world, journal, voice

    def keep(
        self, task: Task, now_s: float, kind: str, body: str, *, line: str | None = None, remember: bool = False
    ) -> None:
        """Journal a decision with the state after it (and the world with `remember`), log it, show the task.

        `line` is what the log says where people would not read `body`.
        """
        task.changed_s = now_s
        task.measure(self._world)
        state = {f"task/{task.id}": task.write()}
        if remember:
            state["world"] = write_world(self._world)
        self._journal.decide(now_s, kind, body, state)
        log.info("%s at %.1f s: %s: %s", task.id, now_s, kind, body if line is None else line)
        self._voice.show(task)

    def spend(self, task: Task, reply: PlanReply, now_s: float) -> None:
        """Journal every call of a model that was made for a reply, and count it, whether or not the reply is used."""
        task.spend(reply)
        for call in reply.calls:
            body = json.dumps({"task": task.id, "call": call.model_dump()}, separators=(",", ":"))
            counts = f"{call.prompt_tokens} + {call.completion_tokens} tokens"
            line = f"{call.model} for {call.purpose}: {call.outcome}, {counts}{' (stand-in)' if call.stand_in else ''}"
            self.keep(task, now_s, "call", body, line=line)
