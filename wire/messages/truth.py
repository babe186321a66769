"""Ground truth: published by the simulator on keys that only the evaluator may read."""

from wire.messages.goal import Goal
from wire.messages.operator import GoalState
from wire.messages.world import WorldState
from wire.model import Message, Stamp, Text


class TruthState(Message):
    """The world as it is. Object ids here are the simulator's own and mean nothing elsewhere."""

    stamp_s: Stamp
    world: WorldState


class TruthTask(Message):
    """The instruction that suits this scene, and the goals it stands for."""

    instruction: Text
    goals: tuple[Goal, ...]


class JudgeRequest(Message):
    """Judge these goals, or the scene's own task when None, from the world as it is."""

    goals: tuple[Goal, ...] | None = None
    since_s: Stamp = 0.0
    """When the task was given: the order of goals is judged from then on."""


class JudgeReply(Message):
    stamp_s: Stamp
    task: TruthTask
    goals: tuple[GoalState, ...]
    success: bool
    collisions: int
    sim_s: float
