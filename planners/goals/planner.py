"""The planner `goals`: the grammar reads first, a model translates what it refuses, code plans. A replan asks nobody."""

from planners.asking import Model
from planners.goals.beforehand import check_choices
from planners.goals.dialogue import Dialogue
from planners.goals.offered import offer
from planners.goals.reach import check_reachable
from planners.goals.words import Instruction
from planners.prompt import Names
from planners.scripted.goals import read_goals
from planners.scripted.syntax import Unclear
from planners.scripted.texts import TEXT_LIMIT
from planners.scripted.told import read_told
from planners.tasks.planning import TaskPlanner
from wire.messages.goal import Goal
from wire.messages.plan import ModelCall, PlanReply, PlanRequest, Refusal
from wire.site import Site

NAME = "goals"


class GoalsPlanner:
    """See planners.planner.Planner. Raises ModelFailed where the model has no answer, or none that holds."""

    def __init__(self, site: Site, model: Model) -> None:
        self._tasks = TaskPlanner(site, NAME)
        self._model = model
        self._names = Names()
        self._grammar_first = site.planner.grammar

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Goals already settled for the task are planned for as they are; else the instruction is read."""
        calls: list[ModelCall] = []
        try:
            told = read_told(request, NAME)
            if told is not None:
                return PlanReply(task=request.task, epoch=request.epoch, plan=told)
            goals = request.goals if request.goals is not None else self.read(request, calls)
        except Unclear as unclear:
            refusal = Refusal(
                reason=unclear.reason[:TEXT_LIMIT], part=unclear.part[:TEXT_LIMIT], question=unclear.question
            )
            return PlanReply(task=request.task, epoch=request.epoch, refusal=refusal, calls=tuple(calls))
        return self._tasks.plan(request, goals).model_copy(update={"calls": tuple(calls)})

    def read(self, request: PlanRequest, calls: list[ModelCall]) -> tuple[Goal, ...]:
        """By the grammar, else by the model, whose calls are added to `calls`. Raises Unclear, ModelFailed."""
        try:
            goals = read_goals(request.instruction, request.world)
            if self._grammar_first:
                return goals
        except Unclear as unclear:
            if unclear.question or unclear.final:
                raise
        instruction = Instruction(request.instruction, request.world)
        check_choices(instruction, request.instruction, request.world)
        dialogue = Dialogue(self._model, offer(request, self._names), instruction, request.world)
        try:
            goals = dialogue.goals()
        finally:
            calls += dialogue.calls
        check_reachable(goals, request)
        return goals
