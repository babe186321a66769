"""The question to the planner: when it is due, what is in it, and which answer belongs to it."""

from hub.checks import faults
from hub.task import Task
from hub.voice import Voice
from hub.world import World
from wire.messages.plan import Plan, PlanReply, PlanRequest

_MISSING_S = 30.0
"""A planner that is restarted is waited for so long before the question is asked in vain."""


class Planning:
    """At most one question is open."""

    def __init__(self, world: World, voice: Voice, epoch: int) -> None:
        self._world, self._voice, self._epoch = world, voice, epoch
        self._missing_since_s: float | None = None
        self._asked = False
        self._due_s = self._begun_s = 0.0

    def begin(self, now_s: float) -> None:
        """A task is taken on, by this run of the hub: robots are given time to announce themselves."""
        self._begun_s = now_s
        self.plan_from(now_s)

    def plan_from(self, due_s: float) -> None:
        """A plan is wanted, not before `due_s`; what was asked before is not waited for."""
        self._asked, self._due_s = False, due_s

    def drop(self) -> None:
        """Whatever was asked, its answer is no longer wanted."""
        self._asked = False

    def ask_if_due(self, task: Task, now_s: float) -> None:
        """Ask once, when every robot has announced itself and there is somebody to ask."""
        if self._asked or now_s < self._due_s or not self._world.fleet.met(now_s - self._begun_s):
            return
        if self._voice.planner_is_missing():
            self._missing_since_s = now_s if self._missing_since_s is None else self._missing_since_s
            if now_s - self._missing_since_s < _MISSING_S:
                return
        self._missing_since_s = None
        self._asked = True
        task.able = frozenset(self._world.fleet.able())
        task.rename(self._world.things)
        request = PlanRequest(
            task=task.id,
            epoch=self._epoch,
            instruction=task.instruction,
            goals=task.goals or None,
            world=self._world.snapshot(now_s),
            skills=self._world.fleet.skills(),
            rejected=task.rejected,
            failures=tuple(text[:2000] for text in task.failures[-8:]),
            now_s=now_s,
        )
        self._voice.ask_plan(request)

    def answers(self, task: Task, reply: PlanReply | None) -> bool:
        """Whether this is the answer that is waited for (None: there was none in time). The question is closed by it."""
        if not self._asked or (reply is not None and (reply.task, reply.epoch) != (task.id, self._epoch)):
            return False
        self._asked = False
        return True

    def faults(self, plan: Plan, now_s: float) -> list[str]:
        """Why the plan cannot be carried out in W as it is now."""
        return faults(plan, self._world.snapshot(now_s), self._world.fleet.abilities(), self._world.floor)
