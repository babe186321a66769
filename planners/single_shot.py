"""The planner of the first paper: task, world, capabilities and schema in one prompt, a plan graph back (equations 6, 7)."""

from planners.asking import Model
from planners.parse import Cannot, Written, entries, is_more, object_with, read_steps
from planners.prompt import Names
from planners.writing.assemble import NOBODY, nodes_of, refuse_with, reply_with
from planners.writing.dialogue import Dialogue
from planners.writing.history import History
from planners.writing.offered import Offered, offer, reply_schema, step_schema
from wire.messages.plan import PlanReply, PlanRequest
from wire.site import Site

NAME = "single_shot"
PURPOSE = "plan"
_MOST_TOKENS = 3000
"""A plan of forty steps."""


class SingleShot:
    """See planners.planner.Planner. Each plan, first or later, is one question and its repairs."""

    def __init__(self, site: Site, model: Model) -> None:
        self._model, self._names, self._history = model, Names(), History()

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Raises ModelFailed when no answer can be used."""
        past = self._history.of(request.task)
        dialogue = Dialogue(self._model, past.seed())
        offered = offer(request, self._names)
        if not offered.robots:
            return refuse_with(request, NOBODY, dialogue)
        schema = reply_schema("steps", step_schema(offered))
        user = "\n".join(
            filter(None, (offered.team, offered.world, past.text(offered), offered.failures(), offered.task))
        )
        try:
            steps, more = dialogue.ask(PURPOSE, user, schema, lambda text: _read(text, offered), _MOST_TOKENS)
        except Cannot as cannot:
            return refuse_with(request, str(cannot), dialogue)
        nodes = nodes_of(steps)
        past.keep(offered, nodes)
        return reply_with(request, NAME, nodes, more, dialogue)


def _read(text: str, offered: Offered) -> tuple[list[Written], bool]:
    document = object_with(text, "steps")
    return read_steps(entries(document, "steps"), offered), is_more(document)
