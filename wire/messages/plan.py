"""Plans as dependency graphs: equations 6 and 7 of the first paper."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from wire.messages.goal import Goal, Predicate
from wire.messages.world import WorldState
from wire.model import Id, Message, Stamp, Text, Vec2, Word

Action = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]{0,31}$")]
"""The name of a skill: one of `KNOWN_ACTIONS`, or any other that a robot announces."""
KNOWN_ACTIONS: frozenset[Action] = frozenset(
    {"goto", "explore", "inspect", "pickup", "put", "open", "close", "toggle_on", "toggle_off", "slice", "clean"}
)
"""Those whose preconditions and effects the hub and the planners know. What any other action changes, only
observations tell."""
FROM_ABOVE: dict[Action, Predicate] = {"inspect_from_above": "seen_from_above", "construct_map": "surveyed"}
"""Skills of what flies whose success is a goal reached: their parameters are those that the robot announces."""
Param = bool | int | float | Text
"""A parameter that only one skill has, such as a height."""
NodeStatus = Literal["pending", "running", "done", "failed", "cancelled"]


class SkillCard(Message):
    """One skill, as announced: its docstring is what a planner reads."""

    name: Action
    doc: Text
    parameters: Text
    """JSON schema: fields of `Command` (`target`, `item`, `room`, `point_m`, `looking_for`) and the skill's own."""


class PlanNode(Message):
    """v = (a, params, req_skills, r_pref), and the nodes it waits for."""

    id: Id
    action: Action
    object: Id | None = None
    """The object acted on; for `put` the receptacle; for `goto` optional."""
    item: Id | None = None
    """For `put`: the object in hand."""
    room: Id | None = None
    """For `explore` and `goto`."""
    point_m: Vec2 | None = None
    looking_for: tuple[Word, ...] = ()
    """For `explore`: types whose sighting ends the search."""
    params: dict[Word, Param] = {}
    """What the skill takes besides: the parameters of its own in its announced schema."""
    req_skills: tuple[Word, ...] = ()
    preferred_robot: Id | None = None
    same_robot_as: Id | None = None
    """The node whose robot must do this one too (a `put` after its `pickup`)."""
    after: tuple[Id, ...] = ()
    goal: int | None = None
    """Index of the goal it serves."""


class Plan(Message):
    """Pi = (V, E): the edges are the nodes' `after`."""

    id: Id
    task: Id
    planner: Word
    goals: tuple[Goal, ...]
    nodes: tuple[PlanNode, ...] = Field(max_length=512)
    taken_for: dict[Id, Word] = {}
    """Objects that the plan takes for another type than the world state says, because nothing else can be what is
    asked for."""
    complete: bool = True
    """False when the plan only gathers what is missing (a search) and planning goes on after it."""
    prompt_tokens: int = Field(default=0, ge=0)
    completion_tokens: int = Field(default=0, ge=0)


class Refusal(Message):
    """Why nothing is done, in one sentence, and the words of the instruction at fault."""

    reason: Text
    part: Text = ""
    question: bool = False
    """True when an answer of the operator would settle it."""


class PlanRequest(Message):
    """P(T, W_t): the task, the world, and what went wrong before."""

    task: Id
    epoch: int = Field(ge=0)
    instruction: Text
    goals: tuple[Goal, ...] | None = None
    """Goals settled by an earlier reply for the same task: plan for these, do not read the words again."""
    rejected: int = Field(default=0, ge=0)
    """So many plans for this task in a row could not be carried out; why stands in `failures`."""
    world: WorldState
    skills: tuple[SkillCard, ...] = ()
    """What the robots that are there have announced, each once; who has which stands in `world.robots`."""
    failures: tuple[Text, ...] = ()
    now_s: Stamp


CallOutcome = Literal[
    "ok",
    "unreachable",  # no server, or no such model there
    "busy",
    "timeout",
    "broken",  # the connection or the reply ended early, or the reply is not the protocol's
    "truncated",  # the prompt or the reply did not fit
    "looping",  # the server stopped a model that repeated itself
    "empty",
    "refused",  # the server answered with an error
    "invalid",  # a whole reply, but not what was asked for
    "unasked",  # nothing was sent: the task's budget is spent, or only kept replies are to be used
]


class ModelCall(Message):
    """One call of a language model, as it was counted."""

    purpose: Word
    model: Text
    outcome: CallOutcome
    prompt_tokens: int = Field(default=0, ge=0)
    completion_tokens: int = Field(default=0, ge=0)
    counted_by: Text = "server"
    """`server`: its own counters; otherwise the name of the tokenizer that a stand-in counts with."""
    latency_s: float = Field(default=0.0, ge=0.0)
    seed: int = 0
    schema_hash: Text = ""
    """First digits of the SHA-256 of the schema that the reply was held to; empty for free text."""
    stand_in: bool = False
    """The server is a stand-in without a model: nothing is learned of any model from this call."""
    cached: bool = False
    """Answered from the replies of an earlier run; its tokens were spent then."""


class PlanReply(Message):
    """Exactly one of plan and refusal. A plan without nodes says: all goals already hold."""

    task: Id
    epoch: int = Field(ge=0)
    plan: Plan | None = None
    refusal: Refusal | None = None
    calls: tuple[ModelCall, ...] = Field(default=(), max_length=64)
    """Every call of a model that was made for it, failed ones too."""
    note: Text = ""
    """What people should know of how it was made: that another planner than the chosen one acted, and why."""


class NodeState(Message):
    id: Id
    status: NodeStatus
    robot: Id | None = None
    reason: Text = ""
    started_s: Stamp | None = None
    ended_s: Stamp | None = None


class PlanState(Message):
    """The running plan, for views: published when a node changes."""

    task: Id
    stamp_s: Stamp
    plan: Plan
    nodes: tuple[NodeState, ...]
    replans: int = Field(ge=0)
