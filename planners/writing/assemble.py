"""Written steps to the nodes of a plan (equation 7): required skill, wished robot, and whose hand holds what."""

from collections.abc import Sequence

from planners.parse import Written
from planners.tasks.planning import plan_id
from planners.writing.dialogue import Dialogue
from wire.messages.plan import Plan, PlanNode, PlanReply, PlanRequest, Refusal

_TEXT_LIMIT = 2000
NOBODY = "no robot is there"


def nodes_of(steps: Sequence[Written]) -> tuple[PlanNode, ...]:
    """One node a step. A step that uses a thing in the hand is for the robot of the step that took it."""
    before = _before(steps)
    takers = {step.object: step.id for step in steps if step.do == "pickup"}
    nodes = []
    for step in steps:
        taker = _taker(step, steps, before, takers)
        nodes.append(
            PlanNode(
                id=step.id,
                action=step.do,
                object=step.object,
                item=step.item,
                room=step.room,
                point_m=step.point_m,
                looking_for=step.looking_for,
                params=dict(step.params or {}),
                req_skills=(step.do,),
                preferred_robot=step.robot,
                same_robot_as=taker,
                after=step.after,
            )
        )
    return tuple(nodes)


def _before(steps: Sequence[Written]) -> dict[str, set[str]]:
    """Step -> every step that is surely done before it; of circles, whatever they reach."""
    after = {step.id: step.after for step in steps}
    found: dict[str, set[str]] = {}
    for id in after:
        reached: set[str] = set()
        todo = list(after[id])
        while todo:
            other = todo.pop()
            if other not in reached:
                reached.add(other)
                todo.extend(after.get(other, ()))
        found[id] = reached
    return found


def _taker(
    step: Written, steps: Sequence[Written], before: dict[str, set[str]], takers: dict[str | None, str]
) -> str | None:
    """The last step surely before that takes the item of this one."""
    if step.item is None or step.item not in takers:
        return None
    own = [
        other.id
        for other in steps
        if other.do == "pickup" and other.object == step.item and other.id in before[step.id]
    ]
    return max(own, key=lambda id: len(before[id]), default=None)


def reply_with(
    request: PlanRequest, planner: str, nodes: tuple[PlanNode, ...], more: bool, dialogue: Dialogue
) -> PlanReply:
    """A plan without goals: it is done when its nodes are. `more`: then a further one is asked for."""
    plan = Plan(
        id=plan_id(request),
        task=request.task,
        planner=planner,
        goals=(),
        nodes=nodes,
        complete=not more,
    )
    return PlanReply(task=request.task, epoch=request.epoch, plan=plan, calls=tuple(dialogue.judged))


def refuse_with(request: PlanRequest, reason: str, dialogue: Dialogue) -> PlanReply:
    """Nothing can be planned."""
    refusal = Refusal(reason=reason[:_TEXT_LIMIT])
    return PlanReply(task=request.task, epoch=request.epoch, refusal=refusal, calls=tuple(dialogue.judged))
