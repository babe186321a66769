"""The reasoning layer of the second paper: decompose and allocate, then choose motion functions for each sub-task.

What robots from above and others have seen is made one map before (`global_map`).
"""

from collections.abc import Mapping, Sequence

from planners.asking import Model
from planners.hierarchical.global_map import integrated
from planners.parse import Cannot, Faulty, Written, entries, is_more, object_with, read_steps
from planners.prompt import Names
from planners.writing.assemble import NOBODY, nodes_of, refuse_with, reply_with
from planners.writing.dialogue import Dialogue
from planners.writing.history import History
from planners.writing.offered import Offered, offer, reply_schema, step_schema
from planners.writing.subtasks import Subtask, join, read_subtasks, subtask_schema
from wire.messages.plan import PlanReply, PlanRequest
from wire.site import Site

NAME = "hierarchical"
DECOMPOSE, FUNCTIONS = "decompose", "functions"
_MOST_TOKENS = 1500
_MOST_STEP_TOKENS = 3000
_OF = frozenset({"subtask"})


class Hierarchical:
    """See planners.planner.Planner."""

    def __init__(self, site: Site, model: Model) -> None:
        self._model, self._names, self._history = model, Names(), History()

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Raises ModelFailed when the answers to one of the questions cannot be used."""
        past = self._history.of(request.task)
        dialogue = Dialogue(self._model, past.seed())
        self._names.learn(request.world)
        world = integrated(request, self._names, dialogue)
        offered = offer(request.model_copy(update={"world": world}), self._names)
        if not offered.robots:
            return refuse_with(request, NOBODY, dialogue)
        try:
            subtasks, more = self._decompose(offered, past.text(offered), dialogue)
        except Cannot as cannot:
            return refuse_with(request, str(cannot), dialogue)
        steps = self._functions(offered, subtasks, dialogue) if subtasks else {}
        nodes = nodes_of(join(subtasks, steps))
        past.keep(offered, nodes)
        return reply_with(request, NAME, nodes, more, dialogue)

    def _decompose(self, offered: Offered, past: str, dialogue: Dialogue) -> tuple[tuple[Subtask, ...], bool]:
        user = "\n".join(filter(None, (offered.team, offered.world, past, offered.failures(), offered.task)))

        def read(text: str) -> tuple[tuple[Subtask, ...], bool]:
            document = object_with(text, "subtasks")
            return read_subtasks(document, offered), is_more(document)

        return dialogue.ask(DECOMPOSE, user, subtask_schema(offered), read, _MOST_TOKENS)

    def _functions(
        self, offered: Offered, subtasks: Sequence[Subtask], dialogue: Dialogue
    ) -> Mapping[str, Sequence[Written]]:
        """Sub-task -> its steps, each an announced skill of the robot that it is for."""
        listed = "\n".join(subtask.line for subtask in subtasks)
        user = "\n".join(filter(None, (offered.team, offered.world, offered.failures(), f"sub-tasks:\n{listed}")))
        item = step_schema(offered, subtask={"enum": [subtask.id for subtask in subtasks]})
        schema = reply_schema("steps", item)
        return dialogue.ask(FUNCTIONS, user, schema, lambda text: steps_of(text, offered, subtasks), _MOST_STEP_TOKENS)


def steps_of(text: str, offered: Offered, subtasks: Sequence[Subtask]) -> Mapping[str, Sequence[Written]]:
    """The steps of a reply by their sub-tasks, in the order in which they stand there. Raises Faulty."""
    try:
        raw = entries(object_with(text, "steps"), "steps")
    except Cannot as cannot:
        raise Faulty([f"the sub-tasks stand: choose skills for them ({cannot})"]) from None
    ids = [subtask.id for subtask in subtasks]
    of = [str(entry.get("subtask", "")).strip().lower() for entry in raw]
    faults = [
        f'step {n}: there is no sub-task "{id[:40]}"; there are {", ".join(ids)}'
        for n, id in enumerate(of, 1)
        if id not in ids
    ]
    faults += [f"sub-task {id} has no steps" for id in ids if id not in of]
    if faults:
        raise Faulty(faults)
    steps = read_steps(raw, offered, _OF)
    doers = {subtask.id: subtask.robot for subtask in subtasks}
    pairs = [
        (step, robot) for step, id in zip(steps, of, strict=True) if (robot := step.robot or doers[id]) is not None
    ]
    faults = [f"step {step.id}: {why}" for step, robot in pairs if (why := offered.cannot(robot, step.do))]
    if faults:
        raise Faulty(faults)
    return {id: [step for step, owner in zip(steps, of, strict=True) if owner == id] for id in ids}
