"""EMOS, adapted: every robot has a resume, the team discusses who does what, each robot then acts for itself.

As in the publication (ICLR 2025) one speaker proposes, every robot checks the proposal against its own body and objects or
agrees, and each writes its own actions. Its robots choose action after action; here each writes those up to the next plan.
"""

from collections.abc import Mapping, Sequence
from itertools import groupby

from planners.asking import Model
from planners.baselines.resumes import Resumes
from planners.hierarchical.planner import steps_of
from planners.parse import Cannot, Faulty, Written, is_more, object_with
from planners.prompt import Names, one_line
from planners.writing.assemble import NOBODY, nodes_of, refuse_with, reply_with
from planners.writing.dialogue import Dialogue
from planners.writing.history import History
from planners.writing.offered import Offered, offer, reply_schema, step_schema
from planners.writing.subtasks import Subtask, join, read_subtasks, subtask_schema
from wire.messages.plan import PlanReply, PlanRequest
from wire.model import Id
from wire.site import Site

NAME = "emos"
ASSIGN, REFLECT, ACT = "emos_assign", "emos_reflect", "emos_act"
ROUNDS = 2
"""Of discussion; what is still objected to then is done as proposed."""
_MOST_TOKENS, _FEW_TOKENS = 1500, 200
_REFLECTION = {
    "type": "object",
    "properties": {"agree": {"type": "boolean"}, "why": {"type": "string", "maxLength": 200}},
    "required": ["agree"],
    "additionalProperties": False,
}


class Emos:
    """See planners.planner.Planner."""

    def __init__(self, site: Site, model: Model) -> None:
        self._model, self._names, self._history = model, Names(), History()
        self._resumes = Resumes()

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Raises ModelFailed when the answers to one of the questions cannot be used."""
        past = self._history.of(request.task)
        dialogue = Dialogue(self._model, past.seed())
        offered = offer(request, self._names)
        if not offered.robots:
            return refuse_with(request, NOBODY, dialogue)
        resumes = self._resumes.of(offered, dialogue)
        try:
            subtasks, more = self._discuss(offered, past.text(offered), resumes, dialogue)
        except Cannot as cannot:
            return refuse_with(request, str(cannot), dialogue)
        steps: dict[str, Sequence[Written]] = {}
        for robot, own in _by_robot(subtasks):
            steps |= self._act(offered.only(robot), resumes[robot], own, dialogue)
        nodes = nodes_of(join(subtasks, steps))
        past.keep(offered, nodes)
        return reply_with(request, NAME, nodes, more, dialogue)

    def _discuss(
        self, offered: Offered, past: str, resumes: Mapping[Id, str], dialogue: Dialogue
    ) -> tuple[tuple[Subtask, ...], bool]:
        """Proposals until nobody objects, or the rounds are over."""
        team = "\n".join(f"{robot}: {resume}" for robot, resume in resumes.items())
        user = "\n".join(filter(None, (f"resumes:\n{team}", offered.world, past, offered.failures(), offered.task)))
        said = ""
        for _ in range(ROUNDS):
            subtasks, more = dialogue.ask(
                ASSIGN, user + said, subtask_schema(offered), lambda text: _assigned(text, offered), _MOST_TOKENS
            )
            objections = [
                line for robot, own in _by_robot(subtasks) for line in self._reflect(robot, resumes, own, dialogue)
            ]
            if not objections:
                break
            said = "\nobjections:\n" + "\n".join(objections)
        return subtasks, more

    def _reflect(self, robot: Id, resumes: Mapping[Id, str], own: Sequence[Subtask], dialogue: Dialogue) -> list[str]:
        """A robot's objection, as a line; none where it agrees."""
        mine = "\n".join(subtask.line for subtask in own)
        user = f"you are {robot}\nyour resume: {resumes[robot]}\nproposed for you:\n{mine}"
        agrees, why = dialogue.ask(REFLECT, user, _REFLECTION, _reflection, _FEW_TOKENS)
        return [] if agrees else [f'- {robot}: "{one_line(why, 160)}"']

    def _act(
        self, offered: Offered, resume: str, own: Sequence[Subtask], dialogue: Dialogue
    ) -> Mapping[str, Sequence[Written]]:
        """The robot's own steps for what it was given."""
        (robot,) = offered.robots
        mine = "\n".join(subtask.line for subtask in own)
        user = "\n".join(filter(None, (
            f"you are {robot}\nyour resume: {resume}", offered.team, offered.world, offered.failures(),
            f"sub-tasks:\n{mine}",
        )))  # fmt: skip
        item = step_schema(offered, subtask={"enum": [subtask.id for subtask in own]})
        return dialogue.ask(
            ACT, user, reply_schema("steps", item), lambda text: steps_of(text, offered, own), _MOST_TOKENS
        )


def _assigned(text: str, offered: Offered) -> tuple[tuple[Subtask, ...], bool]:
    """Sub-tasks, each for a robot. Raises Faulty, Cannot."""
    document = object_with(text, "subtasks")
    subtasks = read_subtasks(document, offered)
    faults = [
        f"sub-task {s.id} has no robot; there are {', '.join(offered.robots)}" for s in subtasks if s.robot is None
    ]
    if faults:
        raise Faulty(faults)
    return subtasks, is_more(document)


def _reflection(text: str) -> tuple[bool, str]:
    document = object_with(text, "agree", listed=False)
    agrees, why = document.get("agree"), document.get("why", "")
    if not isinstance(agrees, bool):
        raise Faulty(['"agree" must be true or false'])
    if not agrees and not (isinstance(why, str) and why.strip()):
        raise Faulty(['who does not agree must say why, in "why"'])
    return agrees, str(why)


def _by_robot(subtasks: Sequence[Subtask]) -> list[tuple[Id, list[Subtask]]]:
    given = sorted((s for s in subtasks if s.robot is not None), key=lambda s: s.robot or "")
    return [(robot, list(own)) for robot, own in groupby(given, key=lambda s: s.robot or "")]
