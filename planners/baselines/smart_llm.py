"""SMART-LLM, adapted: decompose the task into action sequences, form coalitions by skills, allocate robots.

The stages are those of the publication (IROS 2024); what stood there as code of a simulator is here a list of steps. The
code of its last stage, which starts the sequences in threads, is the plan graph.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from planners.asking import Model
from planners.parse import Cannot, Faulty, Written, entries, is_more, object_with, read_steps
from planners.prompt import Names
from planners.writing.assemble import NOBODY, nodes_of, refuse_with, reply_with
from planners.writing.dialogue import Dialogue
from planners.writing.history import History
from planners.writing.offered import Offered, names_schema, offer, reply_schema, step_schema
from planners.writing.subtasks import Subtask, join, order_faults, read_subtasks, robot_of, subtask_schema
from wire.messages.plan import PlanReply, PlanRequest
from wire.model import Id
from wire.site import Site

NAME = "smart_llm"
DECOMPOSE, COALITION, ALLOCATE = "smart_decompose", "smart_coalition", "smart_allocate"
_MOST_TOKENS, _FEW_TOKENS = 3000, 1500
_STEPS = frozenset({"steps"})


@dataclass(frozen=True)
class _Decomposed:
    subtasks: tuple[Subtask, ...]
    steps: Mapping[str, Sequence[Written]]
    more: bool

    @property
    def lines(self) -> str:
        """Each sub-task with the skills that it needs."""
        return "\n".join(
            f"{s.line} needs {' '.join(dict.fromkeys(w.do for w in self.steps[s.id]))}" for s in self.subtasks
        )


class SmartLlm:
    """See planners.planner.Planner. Three questions for each plan."""

    def __init__(self, site: Site, model: Model) -> None:
        self._model, self._names, self._history = model, Names(), History()

    def make_plan(self, request: PlanRequest) -> PlanReply:
        """Raises ModelFailed when the answers to one of the questions cannot be used."""
        past = self._history.of(request.task)
        dialogue = Dialogue(self._model, past.seed())
        offered = offer(request, self._names)
        if not offered.robots:
            return refuse_with(request, NOBODY, dialogue)
        user = "\n".join(
            filter(None, (offered.team, offered.world, past.text(offered), offered.failures(), offered.task))
        )
        schema = _decompose_schema(offered)
        try:
            work = dialogue.ask(DECOMPOSE, user, schema, lambda text: _decomposed(text, offered), _MOST_TOKENS)
        except Cannot as cannot:
            return refuse_with(request, str(cannot), dialogue)
        subtasks = self._allocated(work, offered, dialogue) if work.subtasks else ()
        nodes = nodes_of(join(subtasks, work.steps))
        past.keep(offered, nodes)
        return reply_with(request, NAME, nodes, work.more, dialogue)

    def _allocated(self, work: _Decomposed, offered: Offered, dialogue: Dialogue) -> tuple[Subtask, ...]:
        """The sub-tasks with their robots and their order."""
        user = f"{offered.team}\nsub-tasks:\n{work.lines}"
        schema = _table_schema("coalitions", work, robots={"type": "array", "items": {"enum": [*offered.robots]}})
        teams = dialogue.ask(COALITION, user, schema, lambda text: _coalitions(text, work, offered), _FEW_TOKENS)
        policy = "\n".join(f"{id}: {' or '.join(robots)}" for id, robots in teams.items())
        user = f"{user}\nwho can:\n{policy}\n{offered.world}"
        schema = _table_schema("allocation", work, robot={"enum": [*offered.robots]}, after=names_schema())
        return dialogue.ask(ALLOCATE, user, schema, lambda text: _allocation(text, work, teams, offered), _FEW_TOKENS)


def _decompose_schema(offered: Offered) -> dict[str, Any]:
    step = step_schema(offered)
    step["properties"] = {k: v for k, v in step["properties"].items() if k not in ("id", "robot", "after")}
    step["required"] = ["do"]
    return subtask_schema(offered, steps={"type": "array", "minItems": 1, "maxItems": 12, "items": step})


def _decomposed(text: str, offered: Offered) -> _Decomposed:
    document = object_with(text, "subtasks")
    subtasks = read_subtasks(document, offered, _STEPS)
    steps: dict[str, Sequence[Written]] = {}
    faults: list[str] = []
    for subtask, raw in zip(subtasks, entries(document, "subtasks"), strict=True):
        listed = raw.get("steps")
        own = [entry for entry in listed if isinstance(entry, dict)] if isinstance(listed, list) else []
        if not own:
            faults.append(f"sub-task {subtask.id} has no steps")
            continue
        try:
            steps[subtask.id] = read_steps(own, offered, within=f"sub-task {subtask.id}, ")
        except Faulty as faulty:
            faults += faulty.faults
    if faults:
        raise Faulty(faults)
    return _Decomposed(subtasks, steps, is_more(document))


def _table_schema(key: str, work: _Decomposed, **columns: Any) -> dict[str, Any]:
    fields = {
        "subtask": {"enum": [s.id for s in work.subtasks]},
        **columns,
        "why": {"type": "string", "maxLength": 120},
    }
    item = {"type": "object", "properties": fields, "required": ["subtask"], "additionalProperties": False}
    return reply_schema(key, item, len(work.subtasks))


def _rows(text: str, key: str, work: _Decomposed) -> dict[str, dict[str, object]]:
    """One row for each sub-task. Raises Faulty."""
    try:
        listed = entries(object_with(text, key), key)
    except Cannot as cannot:
        raise Faulty([f"the sub-tasks stand: give {key} for them ({cannot})"]) from None
    ids = [subtask.id for subtask in work.subtasks]
    rows = {str(row.get("subtask", "")).strip().lower(): row for row in listed}
    faults = [f'there is no sub-task "{id[:40]}"; there are {", ".join(ids)}' for id in rows if id not in ids]
    faults += [f"sub-task {id} has no row" for id in ids if id not in rows]
    if faults:
        raise Faulty(faults)
    return rows


def _coalitions(text: str, work: _Decomposed, offered: Offered) -> dict[str, tuple[Id, ...]]:
    """Sub-task -> robots each of which can do it alone: a hand is not shared, so no coalition here is of two."""
    faults: list[str] = []
    teams: dict[str, tuple[Id, ...]] = {}
    skills = {robot.id: set(robot.skills) for robot in offered.request.world.robots}
    for id, row in _rows(text, "coalitions", work).items():
        listed = row.get("robots")
        chosen = [robot_of(r, offered, f"sub-task {id}", faults) for r in (listed if isinstance(listed, list) else [])]
        teams[id] = tuple(dict.fromkeys(robot for robot in chosen if robot is not None))
        needed = {step.do for step in work.steps[id]}
        for robot in teams[id]:
            lacks = sorted(needed - skills[robot])
            if lacks:
                faults.append(f"sub-task {id}: {robot} cannot {', '.join(lacks)}")
        if not teams[id]:
            faults.append(f"sub-task {id} has no robot")
    if faults:
        raise Faulty(faults)
    return teams


def _allocation(
    text: str, work: _Decomposed, teams: Mapping[str, tuple[Id, ...]], offered: Offered
) -> tuple[Subtask, ...]:
    faults: list[str] = []
    found = []
    rows = _rows(text, "allocation", work)
    for subtask in work.subtasks:
        row, where = rows[subtask.id], f"sub-task {subtask.id}"
        robot = robot_of(row.get("robot"), offered, where, faults)
        if robot is None or robot not in teams[subtask.id]:
            faults.append(f"{where}: its robot must be one of {', '.join(teams[subtask.id])}")
        listed = row.get("after")
        more = [str(id).strip().lower() for id in listed] if isinstance(listed, list) else []
        after = tuple(dict.fromkeys((*subtask.after, *more)))
        found.append(replace(subtask, robot=robot, after=after))
    faults += order_faults(found)
    if faults:
        raise Faulty(faults)
    return tuple(found)
