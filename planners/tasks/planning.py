"""Goals and a world state to a plan: settle, decompose, schedule, write. What every goal-based planner ends in."""

from collections.abc import Sequence

from planners.tasks.bans import Bans
from planners.tasks.belief import Belief
from planners.tasks.decompose import Decomposition
from planners.tasks.emit import Emitter
from planners.tasks.failures import Failures
from planners.tasks.likeness import as_taken, taken_for
from planners.tasks.memory import Memory
from planners.tasks.search import Search
from planners.tasks.settle import settle
from planners.tasks.travel import Travel
from planners.tasks.work import Impossible
from wire.goals import holds
from wire.messages.goal import Goal
from wire.messages.plan import Plan, PlanReply, PlanRequest, Refusal
from wire.site import Site


class TaskPlanner:
    """Plans for goals; remembers of each task what it has opened and looked at."""

    def __init__(self, site: Site, name: str) -> None:
        self._site, self._name = site, name
        self._travel = Travel(site)
        self._memory = Memory()

    def plan(self, request: PlanRequest, goals: Sequence[Goal], tokens: tuple[int, int] = (0, 0)) -> PlanReply:
        """A plan for the goals; without nodes when all hold; a refusal when nothing more can be done for them."""
        self._travel.forget()
        taken = taken_for(goals, request.world)
        world = as_taken(request.world, taken)
        belief = Belief(
            world,
            self._travel,
            Bans(goals, world),
            Failures(request.failures, (r.id for r in request.world.robots)),
            self._memory.of(request.task),
        )
        settled = settle(goals, belief)
        work = Decomposition(settled, belief, Search(self._site, belief))
        try:
            jobs = work.jobs()
            nodes = Emitter(self._site, belief).nodes(jobs) if jobs else ()
        except Impossible as reason:
            return _refused(request, str(reason))
        unreached = [goal for goal in settled if not holds(goal, world)]
        if not nodes and (work.hopeless or unreached):
            why = "; ".join(dict.fromkeys(work.hopeless)) or "nothing more can be done"
            return _refused(request, why, unreached[0].text if unreached else "")
        plan = Plan(
            id=plan_id(request),
            task=request.task,
            planner=self._name,
            goals=settled,
            nodes=nodes,
            taken_for=taken,
            complete=work.complete,
            prompt_tokens=tokens[0],
            completion_tokens=tokens[1],
        )
        return PlanReply(task=request.task, epoch=request.epoch, plan=plan)


def plan_id(request: PlanRequest) -> str:
    """Another one for each time that a task is planned."""
    return f"p{request.epoch}-{request.world.seq}-{len(request.failures)}"[:32]


def _refused(request: PlanRequest, reason: str, part: str = "") -> PlanReply:
    refusal = Refusal(reason=reason[:2000], part=part[:2000])
    return PlanReply(task=request.task, epoch=request.epoch, refusal=refusal)
