"""The shell of every device that takes goals: accept once, work, report, cancel, and exactly one result.

A goal is journaled before it is acknowledged and its result before it is published. The result is published once:
a hub that missed it learns it from `goals`, or from the acknowledgement of the same command sent again.
"""

from dataclasses import dataclass

from devices.goals_journal import GoalsJournal
from devices.reporter import Reporter
from devices.worker import Outcome, Worker
from wire.bus import CannotRun, Event, Node, Received, Request
from wire.messages.command import (
    CancelRequest,
    CardRequest,
    Command,
    CommandAck,
    GoalsReply,
    GoalsRequest,
    Result,
)
from wire.messages.world import RobotStatus

GIVE_UP = 15.0
"""A goal fails when the hub stays away this many times longer than what makes the device stand still."""


@dataclass
class Job:
    """The goal at hand."""

    command: Command
    deadline_s: float
    travelled_m: float
    action_steps: int
    cancelled: bool = False
    held_up_s: float = 0.0


class Device:
    """Takes goals for a worker."""

    def __init__(self, id: str, worker: Worker, journal: GoalsJournal, lost_hub_s: float) -> None:
        self.id, self._worker, self._journal = id, worker, journal
        self._lost_hub_s = lost_hub_s
        self._left_over = journal.open_goals()
        self._job: Job | None = None
        self._waiting: Command | None = None
        self._hub_seen_s: float | None = None
        self._stepped_s: float | None = None
        self._reporter = Reporter(id)

    def start(self, node: Node) -> None:
        self._node = node
        self._reporter.start(node)
        for service in ("goal", "cancel", "goals", "card"):
            node.serve(service, self.id)

    def hear(self, event: Event, now_s: float) -> None:
        """Handle what concerns goals; everything else only shows whether the hub is there."""
        if isinstance(event, Request):
            self._hub_seen_s = now_s
            self._answer(event, now_s)
        elif isinstance(event, Received) and event.topic in ("traffic", "health", "world_delta"):
            self._hub_seen_s = now_s

    def step(self, now_s: float) -> None:
        """Work on the goal, or stand still; then say so."""
        if self._stepped_s is None:
            self._check_names()
            self._hub_seen_s = now_s if self._hub_seen_s is None else self._hub_seen_s
            self._interrupt_left_over(now_s)
        passed_s = 0.0 if self._stepped_s is None else now_s - self._stepped_s
        self._stepped_s = now_s
        if self._job is None:
            self._start_waiting(now_s)
        if self.hub_lost(now_s):
            self._outlast(now_s, passed_s)
        elif self._job is None:
            self._worker.idle(now_s)
        else:
            self._work(self._job, now_s, passed_s)
        self._tell(now_s)

    def _check_names(self) -> None:
        """The hub asks the process for the card and commands what the card names: all three must be one."""
        card = self._worker.card(self._node.boot_id)
        if not self._node.id == self.id == card.id:
            raise CannotRun(
                f"process {self._node.id} serves the device {self.id} with a card of {card.id}: "
                "build the device and its card with the id of the process"
            )

    def hub_lost(self, now_s: float) -> bool:
        return self._hub_seen_s is not None and now_s - self._hub_seen_s > self._lost_hub_s

    @property
    def at_rest(self) -> bool:
        """It has no goal, so that nothing is to be done before somebody says something."""
        return self._job is None and self._waiting is None

    @property
    def goal(self) -> Command | None:
        return self._job.command if self._job else None

    # Requests

    def _answer(self, request: Request, now_s: float) -> None:
        message = request.message
        if isinstance(message, Command):
            request.reply(self._take(message, now_s))
        elif isinstance(message, CancelRequest):
            request.reply(self._cancel(message, now_s))
        elif isinstance(message, GoalsRequest):
            request.reply(self._remembered())
        elif isinstance(message, CardRequest):
            request.reply(self._worker.card(self._node.boot_id))

    def _remembered(self) -> GoalsReply:
        return GoalsReply(
            robot=self.id, boot_id=self._node.boot_id, epoch=self._journal.epoch, goals=self._journal.records()
        )

    def _take(self, command: Command, now_s: float) -> CommandAck:
        known = self._journal.record(command.goal_id)
        if known is not None:
            return CommandAck(goal_id=command.goal_id, accepted=True, status=known.status, reason=known.reason)
        if now_s > command.valid_until_s:
            reason = f"{command.goal_id} came {now_s - command.valid_until_s:.1f} s too late"
            return CommandAck(goal_id=command.goal_id, accepted=False, status="expired", reason=reason)
        reason = self._refusal(command)
        if reason:
            return CommandAck(goal_id=command.goal_id, accepted=False, reason=reason[:2000])
        self._journal.raise_epoch(command.epoch)
        if self._job is not None:
            self._journal.accept(command, "accepted")
            self._waiting = command
            return CommandAck(goal_id=command.goal_id, accepted=True, status="accepted", reason="after the cancelled")
        self._journal.accept(command, "running")
        self._begin(command, now_s)
        return CommandAck(goal_id=command.goal_id, accepted=True, status="running")

    def _refusal(self, command: Command) -> str:
        if command.robot != self.id:
            return f"this is {self.id}, the command is for {command.robot}"
        if command.epoch < self._journal.epoch:
            return f"epoch {command.epoch} is over: {self.id} has heard of epoch {self._journal.epoch}"
        if self._job is not None and (not self._job.cancelled or self._waiting is not None):
            return f"{self.id} is busy with {self._job.command.goal_id}"
        return self._worker.fault_of(command)

    def _cancel(self, request: CancelRequest, now_s: float) -> CommandAck:
        goal_id = request.goal_id or (self._job.command.goal_id if self._job else "")
        if request.robot != self.id or request.epoch < self._journal.epoch:
            reason = f"{self.id} in epoch {self._journal.epoch} takes no cancel for {request.robot} of {request.epoch}"
            return CommandAck(goal_id=goal_id, accepted=False, reason=reason)
        self._journal.raise_epoch(request.epoch)
        if self._waiting is not None and request.goal_id in (None, self._waiting.goal_id):
            waiting, self._waiting = self._waiting, None
            self._end(waiting.goal_id, now_s, Outcome("cancelled", "cancelled", "cancelled before it began"), None)
        if self._job is not None and request.goal_id in (None, self._job.command.goal_id):
            self._job.cancelled = True
            if not self._worker.committed:
                self._finish(now_s, Outcome("cancelled", "cancelled", "cancelled by the hub"))
        known = self._journal.record(goal_id)
        if known is None:
            return CommandAck(goal_id=goal_id, accepted=goal_id == "", reason="nothing to cancel")
        return CommandAck(goal_id=goal_id, accepted=True, status=known.status, reason=known.reason)

    # Work

    def _begin(self, command: Command, now_s: float) -> None:
        pose = self._worker.pose
        self._job = Job(
            command,
            now_s + command.timeout_s,
            pose.travelled_m if pose else 0.0,
            pose.action_steps if pose else 0,
        )
        self._worker.begin(command)

    def _start_waiting(self, now_s: float) -> None:
        command, self._waiting = self._waiting, None
        if command is None:
            return
        if now_s > command.valid_until_s:
            self._end(command.goal_id, now_s, None, None)
            return
        self._journal.run(command.goal_id)
        self._begin(command, now_s)

    def _work(self, job: Job, now_s: float, passed_s: float) -> None:
        outcome = self._worker.work(now_s)
        pose = self._worker.pose
        if pose is not None and pose.held_up and job.held_up_s < job.command.timeout_s:
            # Waiting for others is not the goal's time; but nobody waits for ever.
            job.held_up_s += passed_s
            job.deadline_s += passed_s
        if job.cancelled and (outcome is not None or not self._worker.committed):
            reason = outcome.reason if outcome is not None else "cancelled by the hub"
            outcome = Outcome("cancelled", "cancelled", reason, outcome.point_enu_m if outcome else None)
        elif outcome is None and now_s > job.deadline_s:
            note = self._worker.progress[1]
            outcome = Outcome("failed", "timeout", f"not done within {job.command.timeout_s:.0f} s: {note}")
        if outcome is not None:
            self._finish(now_s, outcome)

    def _outlast(self, now_s: float, passed_s: float) -> None:
        """Stand still while the hub is away; its time does not count as the goal's."""
        self._worker.halt()
        if self._job is None or self._hub_seen_s is None:
            return
        self._job.deadline_s += passed_s
        away_s = now_s - self._hub_seen_s
        if away_s > GIVE_UP * self._lost_hub_s:
            self._finish(now_s, Outcome("failed", "lost_hub", f"no sign of the hub for {away_s:.0f} s"))

    def _finish(self, now_s: float, outcome: Outcome) -> None:
        job, self._job = self._job, None
        self._worker.drop()
        if job is not None:
            self._end(job.command.goal_id, now_s, outcome, job)

    def _end(self, goal_id: str, now_s: float, outcome: Outcome | None, job: Job | None) -> None:
        """Journal and publish a result; without an outcome the goal has expired."""
        pose = self._worker.pose
        moved = job is not None and pose is not None
        result = Result(
            goal_id=goal_id,
            robot=self.id,
            stamp_s=now_s,
            status=outcome.status if outcome else "expired",
            code=outcome.code if outcome else "timeout",
            reason=(outcome.reason if outcome else "not started in time")[:2000],
            point_enu_m=outcome.point_enu_m if outcome else None,
            holding=pose.holding if pose else False,
            travelled_m=max(0.0, pose.travelled_m - job.travelled_m) if moved and pose and job else 0.0,
            action_steps=max(0, pose.action_steps - job.action_steps) if moved and pose and job else 0,
        )
        self._journal.end(result)
        self._node.publish("result", result, self.id)

    def _interrupt_left_over(self, now_s: float) -> None:
        for goal_id in self._left_over:
            result = Result(
                goal_id=goal_id,
                robot=self.id,
                stamp_s=now_s,
                status="interrupted",
                code="interrupted",
                reason=f"{self.id} was restarted while at it",
            )
            self._journal.end(result)
            self._node.publish("result", result, self.id)

    # What is said

    def _status(self, now_s: float) -> RobotStatus:
        pose = self._worker.pose
        if self.hub_lost(now_s) or (pose is not None and pose.lost):
            return "lost"
        if self._job is None:
            return "fault" if pose is not None and pose.taken else "idle"
        if self._job.cancelled:
            return "canceling"
        return "holding" if pose is not None and pose.standing_by_order else "executing"

    def _tell(self, now_s: float) -> None:
        goal_id = self._job.command.goal_id if self._job else None
        if goal_id is not None:
            self._reporter.tell_progress(now_s, goal_id, *self._worker.progress)
        self._reporter.tell(now_s, self._worker.pose, self._status(now_s), goal_id)
