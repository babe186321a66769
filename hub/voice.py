"""The hub's side of asking: commands, cancellations, plans, cards; every answer finds the one who waits for it."""

from collections.abc import Callable

from hub.task import Task
from wire.bus import Node, Reply
from wire.messages.command import CancelRequest, CardRequest, Command, CommandAck, DeviceCard, GoalsReply, GoalsRequest
from wire.messages.observation import EventLog
from wire.messages.plan import PlanReply, PlanRequest

_TRIES = 3
Answered = Callable[[Reply, float], None]


class Voice:
    """Implements what the conductor needs over a node."""

    def __init__(self, node: Node, epoch: int, planners: frozenset[str] = frozenset(), plan_s: float = 60.0) -> None:
        """`planners`: processes that make plans; `plan_s`: how long one may take."""
        self._node, self._epoch, self._plan_s = node, epoch, plan_s
        self._planners, self._planners_here = planners, set[str]()
        self._waiting: dict[int, Answered] = {}
        self._planning = 0
        """Number of the newest question to the planner."""
        self._changed: dict[str, Task] = {}
        self._events = 0
        self.on_plan: Callable[[PlanReply | None, str], None] = lambda reply, error: None
        self.on_refused: Callable[[Command, str], None] = lambda command, reason: None
        self.on_goals: Callable[[GoalsReply], None] = lambda reply: None
        self.on_card: Callable[[DeviceCard], None] = lambda card: None

    def answered(self, reply: Reply, now_s: float) -> None:
        """Hand a reply to whom it concerns."""
        handler = self._waiting.pop(reply.ask, None)
        if handler is not None:
            handler(reply, now_s)

    def ask_plan(self, request: PlanRequest) -> None:
        self._planning = number = self._node.ask("make_plan", request, timeout_s=self._plan_s)

        def heard(reply: Reply, now_s: float) -> None:
            if number != self._planning:
                return  # the answer to a question that has been asked anew since
            self.on_plan(reply.message if isinstance(reply.message, PlanReply) else None, reply.error)

        self._waiting[number] = heard

    def planner_is_missing(self) -> bool:
        """There should be a planner, and there is none."""
        return bool(self._planners) and not self._planners_here

    def planner_presence(self, id: str, alive: bool) -> None:
        """One that has gone will not answer, and one that has just come knows nothing of what was asked before it."""
        (self._planners_here.add if alive else self._planners_here.discard)(id)
        if self._waiting.pop(self._planning, None) is not None:
            self.on_plan(None, "it went away before it answered")

    def command(self, command: Command) -> None:
        self._command(command, _TRIES)

    def _command(self, command: Command, tries: int) -> None:
        """Ask until it is acknowledged; a goal id makes the repeat harmless."""
        number = self._node.ask("goal", command, command.robot)

        def heard(reply: Reply, now_s: float) -> None:
            if isinstance(reply.message, CommandAck):
                if not reply.message.accepted:
                    self.on_refused(command, reply.message.reason)
            elif tries > 1 and now_s < command.valid_until_s:
                self._command(command, tries - 1)

        self._waiting[number] = heard

    def cancel(self, robot: str, goal_id: str | None) -> None:
        self._cancel(robot, goal_id, _TRIES)

    def _cancel(self, robot: str, goal_id: str | None, tries: int) -> None:
        number = self._node.ask("cancel", CancelRequest(robot=robot, goal_id=goal_id, epoch=self._epoch), robot)

        def heard(reply: Reply, now_s: float) -> None:
            if reply.message is None and tries > 1:
                self._cancel(robot, goal_id, tries - 1)

        self._waiting[number] = heard

    def ask_goals(self, robot: str) -> None:
        number = self._node.ask("goals", GoalsRequest(), robot)

        def heard(reply: Reply, now_s: float) -> None:
            if isinstance(reply.message, GoalsReply):
                self.on_goals(reply.message)

        self._waiting[number] = heard

    def ask_card(self, device: str) -> None:
        number = self._node.ask("card", CardRequest(), device)

        def heard(reply: Reply, now_s: float) -> None:
            if isinstance(reply.message, DeviceCard):
                self.on_card(reply.message)

        self._waiting[number] = heard

    def show(self, task: Task) -> None:
        self._changed[task.id] = task

    def publish(self, now_s: float) -> None:
        """What changed in this step: task and plan states, and the lines for people."""
        for id in sorted(self._changed):
            task = self._changed[id]
            self._node.publish("task_state", task.state(now_s), id)
            if task.run is not None:
                self._node.publish("plan_state", task.run.state(now_s, task.replans))
            for text in task.unsaid:
                self._events += 1
                line = EventLog(source=self._node.id, seq=self._events, stamp_s=now_s, text=f"{id}: {text}"[:2000])
                self._node.publish("event", line, self._node.id)
            task.unsaid.clear()
        self._changed.clear()
