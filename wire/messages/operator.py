"""What people ask of the hub."""

from typing import Literal

from pydantic import Field

from wire.messages.goal import Goal
from wire.messages.plan import ModelCall, Refusal
from wire.messages.world import ObjectState
from wire.model import Id, Message, Probability, Stamp, Text, unset

TaskStatus = Literal["planning", "running", "paused", "done", "failed", "refused", "cancelled"]


class TaskRequest(Message):
    """An instruction in plain words. The same `task` id again returns the state of the first one."""

    task: Id
    instruction: str = Field(min_length=1, max_length=2000)


class GoalState(Message):
    goal: Goal
    holds: bool
    note: Text = ""


class TaskState(Message):
    """How a task stands; published on every change, and the answer to most operator requests."""

    task: Id
    instruction: Text
    status: TaskStatus
    stamp_s: Stamp
    started_s: Stamp
    planner: str = ""
    """Who made the plan."""
    planner_note: Text = ""
    """Why that was not the chosen planner; empty when it was."""
    goals: tuple[GoalState, ...] = ()
    refusal: Refusal | None = None
    reason: Text = ""
    nodes_done: int = Field(default=0, ge=0)
    nodes_total: int = Field(default=0, ge=0)
    replans: int = Field(default=0, ge=0)
    fails: int = Field(default=0, ge=0)
    action_steps: int = Field(default=0, ge=0)
    path_m: float = Field(default=0.0, ge=0.0)
    prompt_tokens: int = Field(default=0, ge=0)
    completion_tokens: int = Field(default=0, ge=0)
    model_calls: int = Field(default=0, ge=0)
    stand_in: bool = False
    """Tokens of a stand-in are in the sums: they say nothing of any model."""
    log: tuple[Text, ...] = ()
    """The last few things that happened, newest last."""


class TaskQuery(Message):
    """One task, or the newest when None."""

    task: Id | None = None


class CallsRequest(Message):
    """Of one task, or of the newest when None."""

    task: Id | None = None


class TimedCall(Message):
    """A call of a model, and when the hub heard of it."""

    stamp_s: Stamp
    call: ModelCall


class CallsReply(Message):
    """The calls of a task from the journal, oldest first."""

    task: Id
    known: bool
    """False when there is no such task; `text` names those that there are."""
    text: Text = ""
    calls: tuple[TimedCall, ...] = Field(default=(), max_length=256)
    left_out: int = Field(default=0, ge=0)
    """So many older ones are not in `calls`; the sums have them."""
    prompt_tokens: int = Field(default=0, ge=0)
    completion_tokens: int = Field(default=0, ge=0)
    stand_in: bool = False


class ControlRequest(Message):
    """`stop` halts every robot and cancels all tasks; `pause` and `resume` keep the tasks."""

    verb: Literal["stop", "pause", "resume", "cancel"]
    task: Id | None = None


class ControlReply(Message):
    ok: bool
    text: Text


class WhyRequest(Message):
    """Where is it believed to be, who said so? By id, or by words ("mug", "mug in the kitchen")."""

    object: str = Field(min_length=1, max_length=120)


class Claim(Message):
    """What one source says of a thing or of one of its properties, and how sure it is of that."""

    source: Id
    stamp_s: Stamp
    confidence: Probability
    text: Text
    contradicts: bool = False


class WhyEntry(Message):
    state: ObjectState
    claims: tuple[Claim, ...]
    text: Text = ""
    """Where it is, in one sentence."""


class WhyReply(Message):
    now_s: Stamp
    entries: tuple[WhyEntry, ...] = ()
    more: int = Field(default=0, ge=0)
    """So many others are meant too and were left out."""
    text: Text = ""
    robot: Id | None = Field(default=None, exclude_if=unset)
    """The robot that was asked about: `text` says how high it is and how full."""
