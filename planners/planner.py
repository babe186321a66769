"""What a planner is, and the planners there are: a name in the site file chooses one."""

from collections.abc import Callable
from typing import Protocol

from planners.goals.planner import GoalsPlanner
from planners.modelled import modelled
from planners.scripted.planner import ScriptedPlanner
from wire.messages.plan import PlanReply, PlanRequest
from wire.site import Site


class Planner(Protocol):
    """P of the papers: from a task and a world state to a plan or a refusal. Reads no clock, opens nothing."""

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Exactly one of plan and refusal, for this request's task and epoch."""


PLANNERS: dict[str, Callable[[Site], Planner]] = {
    "scripted": ScriptedPlanner,
    "goals": modelled(GoalsPlanner),
}
"""Name -> factory. A new planner is one file and one row here."""
