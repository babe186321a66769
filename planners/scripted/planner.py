"""The default planner: words to goals through the grammar, goals to a plan; no model, no tokens."""

from planners.scripted.goals import read_goals
from planners.scripted.syntax import Unclear
from planners.scripted.texts import TEXT_LIMIT
from planners.scripted.told import read_told
from planners.tasks.planning import TaskPlanner
from wire.messages.plan import PlanReply, PlanRequest, Refusal
from wire.site import Site

NAME = "scripted"


class ScriptedPlanner:
    """See planners.planner.Planner."""

    def __init__(self, site: Site) -> None:
        self._tasks = TaskPlanner(site, NAME)

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Goals already settled for the task are planned for as they are; else the instruction is read."""
        try:
            told = read_told(request, NAME)
            if told is not None:
                return PlanReply(task=request.task, epoch=request.epoch, plan=told)
            goals = request.goals if request.goals is not None else read_goals(request.instruction, request.world)
        except Unclear as unclear:
            refusal = Refusal(
                reason=unclear.reason[:TEXT_LIMIT], part=unclear.part[:TEXT_LIMIT], question=unclear.question
            )
            return PlanReply(task=request.task, epoch=request.epoch, refusal=refusal)
        return self._tasks.plan(request, goals)
