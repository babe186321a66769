"""One task as the hub keeps it: what was asked, how it stands, what happened."""

import json
from collections import deque
from collections.abc import Sequence
from typing import Literal

from hub.memory import read_goals, read_run, write_goals, write_run
from hub.monitor import Watch
from hub.plan import PlanRun
from hub.things import Things
from hub.world import World
from wire.goals import holds
from wire.messages.goal import Goal, Selector
from wire.messages.operator import GoalState, TaskState, TaskStatus
from wire.messages.plan import ModelCall, Plan, PlanReply, Refusal
from wire.messages.world import WorldState

_LINES = 12
Then = Literal["replan", "pause", "cancel"]
"""What comes when all robots of a halted task stand still."""
ENDED: frozenset[TaskStatus] = frozenset({"done", "failed", "refused", "cancelled"})


class Task:
    """The state of one instruction from the asking to the end."""

    def __init__(self, id: str, instruction: str, now_s: float) -> None:
        self.id, self.instruction = id, instruction
        self.status: TaskStatus = "planning"
        self.halting: Then | None = None
        self.started_s = self.changed_s = now_s
        self.planner = ""
        self.goals: tuple[Goal, ...] = ()
        self.holding: tuple[bool, ...] = ()
        self.refusal: Refusal | None = None
        self.reason = ""
        self.run: PlanRun | None = None
        self.watch: Watch | None = None
        self.able: frozenset[str] = frozenset()
        """Skills that the robots had when the plan was asked for."""
        self.failures: list[str] = []
        self.fails = self.replans = 0
        self.done_before = 0
        """Nodes done under earlier plans."""
        self.counter = 0
        """Number of the last goal given to a robot."""
        self.tokens = (0, 0)
        self.model_calls = 0
        self.stand_in = False
        self.planner_note = ""
        self.rejected = 0
        """Plans in a row that the checks have refused."""
        self.start_steps: dict[str, tuple[float, int]] = {}
        """Odometer and step count of every robot when the task began."""
        self.spent = (0.0, 0)
        self.log: deque[str] = deque(maxlen=_LINES)
        self.unsaid: list[str] = []
        """Lines not yet published in the event log."""

    @property
    def ended(self) -> bool:
        return self.status in ENDED

    def say(self, now_s: float, text: str) -> None:
        """A line for people, with the time since the task was given."""
        self.log.append(f"{max(now_s - self.started_s, 0.0):.1f} s: {text}"[:300])
        self.unsaid.append(text)
        self.changed_s = now_s

    def hear_note(self, note: str, now_s: float) -> None:
        """What the planner has to say of itself; told once."""
        if note and note != self.planner_note:
            self.say(now_s, note)
        self.planner_note = note

    def spend(self, reply: PlanReply) -> None:
        """Count what a reply has cost, whatever became of it. A planner without records has its sums in the plan."""
        spent: Sequence[ModelCall | Plan] = reply.calls or ([reply.plan] if reply.plan is not None else [])
        self.tokens = (
            self.tokens[0] + sum(each.prompt_tokens for each in spent),
            self.tokens[1] + sum(each.completion_tokens for each in spent),
        )
        self.model_calls += len(reply.calls)
        self.stand_in |= any(call.stand_in for call in reply.calls)

    def measure(self, world: World) -> None:
        """Metres walked and steps made by the fleet since the task began."""
        path_m, steps = 0.0, 0
        for robot in world.fleet.robots.values():
            at_start = self.start_steps.setdefault(robot.id, (robot.travelled_m, robot.action_steps))
            path_m += max(robot.travelled_m - at_start[0], 0.0)
            steps += max(robot.action_steps - at_start[1], 0)
        self.spent = (path_m, steps)

    def rename(self, things: Things) -> None:
        """Follow things that turned out to be others through the goals."""
        if things.merged:
            self.goals = tuple(
                goal.model_copy(
                    update={
                        "subject": _renamed(goal.subject, things),
                        "object": _renamed(goal.object, things) if goal.object is not None else None,
                    }
                )
                for goal in self.goals
            )

    def judge(self, world: WorldState) -> bool:
        """Evaluate the goals over W; True when there are some and all hold."""
        self.holding = tuple(holds(goal, world) for goal in self.goals)
        return all(self.holding)

    def state(self, now_s: float) -> TaskState:
        run = self.run
        return TaskState(
            task=self.id,
            instruction=self.instruction,
            status=self.status,
            stamp_s=now_s,
            started_s=self.started_s,
            planner=self.planner,
            planner_note=self.planner_note,
            goals=tuple(
                GoalState(goal=goal, holds=i < len(self.holding) and self.holding[i], note=goal.text)
                for i, goal in enumerate(self.goals)
            ),
            refusal=self.refusal,
            reason=self.reason,
            nodes_done=self.done_before + (run.done_count() if run is not None else 0),
            nodes_total=self.done_before + (len(run.steps) if run is not None else 0),
            replans=self.replans,
            fails=self.fails,
            action_steps=self.spent[1],
            path_m=round(self.spent[0], 3),
            prompt_tokens=self.tokens[0],
            completion_tokens=self.tokens[1],
            model_calls=self.model_calls,
            stand_in=self.stand_in,
            log=tuple(self.log),
        )

    def write(self) -> str:
        """For the journal."""
        return json.dumps(
            {
                "id": self.id,
                "instruction": self.instruction,
                "status": self.status,
                "halting": self.halting,
                "started_s": self.started_s,
                "planner": self.planner,
                "goals": write_goals(self.goals),
                "refusal": self.refusal.model_dump() if self.refusal is not None else None,
                "reason": self.reason,
                "run": write_run(self.run) if self.run is not None else None,
                "failures": self.failures,
                "fails": self.fails,
                "replans": self.replans,
                "done_before": self.done_before,
                "counter": self.counter,
                "tokens": self.tokens,
                "model_calls": self.model_calls,
                "stand_in": self.stand_in,
                "planner_note": self.planner_note,
                "rejected": self.rejected,
                "start_steps": self.start_steps,
                "spent": self.spent,
                "holding": self.holding,
                "log": list(self.log),
            },
            separators=(",", ":"),
        )


def _renamed(selector: Selector, things: Things) -> Selector:
    """The same things under the ids that they have now."""
    return selector.model_copy(
        update={
            "id": things.standing_for(selector.id) if selector.id is not None else None,
            "exclude": tuple(_renamed(other, things) for other in selector.exclude),
        }
    )


def read_task(text: str) -> Task:
    """What `Task.write` wrote."""
    data = json.loads(text)
    task = Task(data["id"], data["instruction"], data["started_s"])
    task.status, task.planner, task.reason = data["status"], data["planner"], data["reason"]
    task.halting = data.get("halting")
    task.goals, task.holding = read_goals(data["goals"]), tuple(data["holding"])
    task.refusal = Refusal.model_validate(data["refusal"]) if data["refusal"] is not None else None
    task.run = read_run(data["run"]) if data["run"] is not None else None
    task.failures, task.fails, task.replans = data["failures"], data["fails"], data["replans"]
    task.done_before, task.counter = data["done_before"], data["counter"]
    task.tokens = (data["tokens"][0], data["tokens"][1])
    task.model_calls, task.stand_in = data.get("model_calls", 0), data.get("stand_in", False)
    task.planner_note, task.rejected = data.get("planner_note", ""), data.get("rejected", 0)
    task.start_steps = {id: (m, n) for id, (m, n) in data["start_steps"].items()}
    task.spent = (data["spent"][0], data["spent"][1])
    task.log.extend(data["log"])
    return task
