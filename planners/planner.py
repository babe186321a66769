"""What a planner is, and the planners there are: a name in the site file chooses one."""

from collections.abc import Callable
from typing import Protocol

from planners.baselines.emos import Emos
from planners.baselines.smart_llm import SmartLlm
from planners.goals.planner import GoalsPlanner
from planners.hierarchical.planner import Hierarchical
from planners.modelled import modelled
from planners.scripted.planner import ScriptedPlanner
from planners.single_shot import SingleShot
from wire.messages.plan import PlanReply, PlanRequest
from wire.site import Site


class Planner(Protocol):
    """P of the papers: from a task and a world state to a plan or a refusal. Reads no clock, opens nothing."""

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Exactly one of plan and refusal, for this request's task and epoch."""


PLANNERS: dict[str, Callable[[Site], Planner]] = {
    "scripted": ScriptedPlanner,
    "goals": modelled(GoalsPlanner),
    "single_shot": modelled(SingleShot),
    "hierarchical": modelled(Hierarchical),
    "smart_llm": modelled(SmartLlm),
    "emos": modelled(Emos),
}
"""Name -> factory. A new planner is one file and one row here."""
