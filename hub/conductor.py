"""Algorithm 1 for the active task: plan, check, dispatch, watch, halt, plan again, until the goals hold."""

from collections.abc import Sequence

from hub import effects
from hub.dispatch import Dispatch
from hub.ledger import Ledger
from hub.monitor import Watch
from hub.orders import order
from hub.plan import PlanRun, Step
from hub.planning import Planning
from hub.task import Task, Then
from hub.voice import Voice
from hub.world import World
from wire.messages.command import Result
from wire.messages.operator import TaskStatus
from wire.messages.plan import Plan, PlanReply

_HALT_S = 8.0
_STUCK_S = 45.0
_POWER_S = 3.0
"""A battery that does not do for what is left is waited for no longer."""
_RETRY_S = 1.0
_REPLANS_PER_FAIL = 8
_FREE_CODES = frozenset({"not_there", "lost_hub", "interrupted", "cancelled", "closed"})
"""Failures that taught something new about the world: planned around, not counted."""


class Conductor:
    """Carries out one task at a time."""

    def __init__(
        self, world: World, dispatch: Dispatch, ledger: Ledger, voice: Voice, epoch: int, max_fails: int
    ) -> None:
        self._world, self._dispatch, self._ledger, self._voice = world, dispatch, ledger, voice
        self._epoch, self._max_fails = epoch, max_fails
        self._planning = Planning(world, voice, epoch)
        self.task: Task | None = None
        self._halted_s = self._moved_s = 0.0
        self._needless: set[str] = set()
        """Goal ids cancelled because their effect came about by itself."""

    def begin(self, task: Task, now_s: float) -> None:
        """Take on a task, new or from the journal."""
        self.task = task
        self._planning.begin(now_s)
        self._moved_s = self._halted_s = now_s
        if task.run is None:
            self._world.begin_task()
        else:
            task.watch = Watch(task.run, self._world)
            if task.halting is not None or (task.status != "running" and task.run.running()):
                then = task.halting or ("pause" if task.status == "paused" else "replan")
                self.halt(then, "the hub was restarted", now_s)
        task.measure(self._world)

    def advance(self, now_s: float) -> None:
        """Do what is due."""
        task = self.task
        if task is None or task.ended:
            return
        if task.halting is not None:
            self._wait_for_halt(task, now_s)
        elif task.status == "planning":
            self._planning.ask_if_due(task, now_s)
        elif task.status == "running" and task.run is not None:
            self._drive(task, task.run, now_s)

    def planned(self, reply: PlanReply | None, now_s: float, error: str = "") -> None:
        """The planner's answer, or None when there was none in time."""
        task = self.task
        if task is not None and reply is not None and reply.task == task.id:
            self._ledger.spend(task, reply, now_s)
        if task is None or task.status != "planning" or task.halting is not None:
            return
        if not self._planning.answers(task, reply):
            return
        if reply is None:
            self._failed(task, f"the planner gave no answer{': ' + error if error else ''}", now_s)
            return
        task.hear_note(reply.note, now_s)
        if reply.refusal is not None:
            task.refusal = reply.refusal
            self._end(task, "refused" if task.run is None else "failed", reply.refusal.reason, now_s)
        elif reply.plan is not None:
            self._adopt(task, reply.plan, now_s)
        else:
            self._failed(task, "the planner sent neither a plan nor a refusal", now_s)

    def _adopt(self, task: Task, plan: Plan, now_s: float) -> None:
        task.planner = plan.planner
        for line in self._world.take_for(plan.taken_for):
            task.say(now_s, line)
        found = self._planning.faults(plan, now_s)
        if found:
            task.failures += found
            task.rejected += 1
            self._failed(task, f"the plan cannot be carried out: {found[0]}", now_s)
            return
        task.rejected = 0
        if task.run is not None:
            task.done_before += task.run.done_count()
        task.goals, task.run = plan.goals, PlanRun(plan, {thing.id: thing.type for thing in self._world.things})
        task.watch = Watch(task.run, self._world)
        task.status, self._moved_s = "running", now_s
        line = f"plan {plan.id}: {len(plan.nodes)} nodes{'' if plan.complete else ', a search first'}"
        task.say(now_s, line)
        # With the world: the ids in the plan mean nothing to a restarted hub that has not heard of them.
        self._ledger.keep(task, now_s, "plan", plan.model_dump_json(), line=line, remember=True)

    def _drive(self, task: Task, run: PlanRun, now_s: float) -> None:
        """Dispatch what is ready; see whether the plan has come to its end."""
        if run.finished():
            self._finish(task, run, now_s)
            return
        running = run.running()
        busy = frozenset(s.robot for s in running if s.robot is not None)
        for step, robot in self._dispatch.match(run, run.ready(now_s), self._world.fleet.here(), busy, now_s):
            task.counter += 1
            goal_id = f"{task.id}-e{self._epoch}-{task.counter}"
            run.start(step, robot.id, goal_id, now_s)
            command = order(step, robot, goal_id, self._epoch, self._world.things, self._dispatch, now_s)
            body = f"{goal_id} {robot.id} {step.node.id} {step.node.action}"
            self._ledger.keep(task, now_s, "command", body, line=f"{body} {_about(step, run)}")
            self._voice.command(command)
            self._moved_s = now_s
        if not running and now_s - self._moved_s > _POWER_S:
            ready = run.ready(now_s)
            why = self._dispatch.without_power(ready, self._world.fleet.here())
            if why or now_s - self._moved_s > _STUCK_S:
                self._moved_s = now_s
                self.fail(why or f"no robot could start any of {', '.join(s.node.id for s in ready)}", now_s)

    def _finish(self, task: Task, run: PlanRun, now_s: float) -> None:
        task.rename(self._world.things)
        good = task.judge(self._world.snapshot(now_s))
        if not run.plan.complete:
            self._replan(task, "the search is over", now_s)
        elif good:
            self._end(task, "done", "all goals hold" if task.goals else "every step is done", now_s)
        else:
            missing = [g.text or g.predicate for g, h in zip(task.goals, task.holding, strict=True) if not h]
            self._failed(task, f"the plan is done, but not reached: {'; '.join(missing)}", now_s)

    def result(self, result: Result, now_s: float) -> None:
        """A goal of a robot has ended."""
        task = self.task
        step = task.run.of_goal(result.goal_id) if task is not None and task.run is not None else None
        if task is None or task.run is None or step is None or step.status != "running" or step.robot is None:
            return
        result = effects.finished_anyway(step.node, result)
        effects.apply(self._world, step.node, step.robot, result, task.run.types)
        self._moved_s = now_s
        if result.status == "done" or result.code == "already":
            self._done(task, step, result.reason, now_s)
        elif result.goal_id in self._needless:
            self._done(task, step, "so already", now_s)
        elif result.status in ("cancelled", "expired"):
            task.run.put_back(step, result.reason)
            self._ledger.keep(task, now_s, "node", f"{step.node.id} {result.status}")
        else:
            task.run.end(step, "failed", now_s, result.reason)
            counted = result.code not in _FREE_CODES
            self.fail(f"{step.robot} could not {step.deed}: {result.reason or result.code}", now_s, counted=counted)

    def _done(self, task: Task, step: Step, reason: str, now_s: float) -> None:
        if task.run is None:
            return
        task.run.end(step, "done", now_s, reason)
        named = {step.node.object, step.node.item} - {None}
        for other in task.run.steps.values():
            if task.watch is not None and named & {other.node.object, other.node.item}:
                task.watch.refresh(other)
        task.say(now_s, f"{step.robot or 'nobody'}: {step.deed} done")
        body = f"{step.node.id} done"
        line = f"{body}: {step.robot or 'nobody'} {step.node.action} {_about(step, task.run)}"
        self._ledger.keep(task, now_s, "node", body, line=line, remember=True)

    def changed(self, ids: Sequence[str], now_s: float) -> None:
        """IoTUpdate: things changed in W. Halt when that touches the plan."""
        task = self.task
        if task is None or task.run is None or task.watch is None or task.status != "running" or task.halting:
            return
        for step, reason in task.watch.senseless():
            if step.status == "pending":
                self._done(task, step, reason, now_s)
            elif step.goal_id is not None and step.goal_id not in self._needless and step.robot is not None:
                self._needless.add(step.goal_id)
                self._voice.cancel(step.robot, step.goal_id)
        reason_to_replan = task.watch.relevant(list(ids))
        if reason_to_replan is not None:
            self.halt("replan", reason_to_replan, now_s)

    def lost(self, robot: str, now_s: float) -> None:
        """A robot went away: what it did is planned anew."""
        task = self.task
        if task is None or task.run is None or task.ended:
            return
        mine = [s for s in task.run.running() if s.robot == robot]
        for step in mine:
            task.run.end(step, "failed", now_s, "its robot was lost")
        if mine:
            self.fail(f"{robot} was lost", now_s, counted=False)

    def look_for_help(self, now_s: float) -> None:
        """Somebody is there by now who can what nobody could when a plan was made that leaves goals open."""
        task = self.task
        if task is None or task.run is None or task.status != "running" or task.halting or task.run.plan.complete:
            return
        fresh = sorted({who for skill, who in self._world.fleet.able().items() if skill not in task.able})
        if fresh:
            self.halt("replan", f"{' and '.join(fresh)} can help now", now_s)

    def fail(self, reason: str, now_s: float, counted: bool = True) -> None:
        """Something went wrong while robots act: stop them, then plan again."""
        task = self.task
        if task is None:
            return
        task.failures.append(reason)
        task.fails += counted
        self.halt("replan", reason, now_s)

    def _failed(self, task: Task, reason: str, now_s: float) -> None:
        """A failure while nothing runs."""
        task.fails += 1
        task.failures.append(reason)
        task.say(now_s, reason)
        self._replan(task, reason, now_s)

    def halt(self, then: Then, reason: str, now_s: float) -> None:
        """Stop every robot of this task; `then` comes when all stand still."""
        task = self.task
        if task is None or task.ended:
            return
        task.say(now_s, reason)
        if task.halting is None or then != "replan":
            task.halting, self._halted_s = then, now_s
        self._planning.drop()
        for step in task.run.running() if task.run is not None else ():
            if step.robot is not None and step.goal_id is not None:
                self._voice.cancel(step.robot, step.goal_id)
        self._ledger.keep(task, now_s, "halt", f"{then}: {reason}")

    def _wait_for_halt(self, task: Task, now_s: float) -> None:
        running = task.run.running() if task.run is not None else []
        if running and now_s - self._halted_s < _HALT_S:
            return
        for step in running:
            if task.run is not None:
                task.run.put_back(step, "did not stop in time")
        then, task.halting = task.halting, None
        if then == "cancel":
            self._end(task, "cancelled", "cancelled by the operator", now_s)
        elif then == "pause":
            task.status = "paused"
            self._ledger.keep(task, now_s, "pause", task.id)
        else:
            self._replan(task, task.failures[-1] if task.failures else "all robots stand still", now_s)

    def resume(self, now_s: float) -> None:
        """Go on after a pause, with a fresh plan."""
        if self.task is not None and self.task.halting == "pause":
            self.task.halting = "replan"
            self._ledger.keep(self.task, now_s, "resume", self.task.id)
        elif self.task is not None and self.task.status == "paused":
            self._replan(self.task, "resumed", now_s)

    def _replan(self, task: Task, reason: str, now_s: float) -> None:
        if task.fails >= self._max_fails:
            self._end(task, "failed", f"gave up after {task.fails} failures, the last: {reason}", now_s)
            return
        task.replans += 1
        if task.replans > _REPLANS_PER_FAIL * self._max_fails:
            self._end(task, "failed", f"gave up after {task.replans} plans, the last reason: {reason}", now_s)
            return
        task.status = "planning"
        self._planning.plan_from(now_s + (_RETRY_S if task.fails else 0.1))
        self._ledger.keep(task, now_s, "replan", reason)

    def _end(self, task: Task, status: TaskStatus, reason: str, now_s: float) -> None:
        task.status, task.reason = status, reason
        task.say(now_s, f"{status}: {reason}")
        task.judge(self._world.snapshot(now_s))
        self._ledger.keep(task, now_s, "end", f"{status}: {reason}", remember=True)


def _about(step: Step, run: PlanRun) -> str:
    """What a step is about, for people."""
    node = step.node
    id = node.item if node.action == "put" else node.object
    if id is not None:
        return f"{run.types.get(id, '')} {id}".strip()
    return node.room or (f"({node.point_m[0]:g}, {node.point_m[1]:g})" if node.point_m is not None else "")
