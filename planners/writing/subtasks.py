"""Sub-tasks between an instruction and its steps: how they are read, told to the next question, and joined to a plan."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from planners.parse import Faulty, Written, entries, name_of, names_of
from planners.prompt import one_line
from planners.writing.offered import Offered, names_schema, reply_schema
from wire.model import Id

MOST_SUBTASKS = 32
WHAT_LIMIT = 200
_KEYS = frozenset({"id", "what", "robot", "after"})


@dataclass(frozen=True)
class Subtask:
    """Something that one robot does in one go. `what` is in the words of the model."""

    id: str
    what: str
    robot: Id | None = None
    after: tuple[str, ...] = ()

    @property
    def line(self) -> str:
        by = f" by {self.robot}" if self.robot is not None else ""
        waits = f" after {' '.join(self.after)}" if self.after else ""
        return f'{self.id}{by}{waits}: "{one_line(self.what, WHAT_LIMIT)}"'


def subtask_schema(offered: Offered, **more: Any) -> dict[str, Any]:
    """Of a list of sub-tasks."""
    fields = {
        "id": {"type": "string", "maxLength": 16},
        "what": {"type": "string", "maxLength": WHAT_LIMIT},
        "robot": {"enum": [*offered.robots]},
        "after": names_schema(),
        **more,
    }
    item = {"type": "object", "properties": fields, "required": ["id", "what"], "additionalProperties": False}
    return reply_schema("subtasks", item, MOST_SUBTASKS)


def read_subtasks(
    document: Mapping[str, object], offered: Offered, extra: frozenset[str] = frozenset()
) -> tuple[Subtask, ...]:
    """The sub-tasks of a reply. Raises Faulty."""
    faults: list[str] = []
    found = []
    for number, raw in enumerate(entries(document, "subtasks"), 1):
        id = name_of(raw.get("id", f"t{number}"), f"sub-task {number}", faults)
        where = f"sub-task {id}"
        foreign = [key for key in raw if key not in _KEYS | extra]
        faults += [f"{where}: {one_line(key, 40)} is no part of a sub-task" for key in foreign[:1]]
        what = raw.get("what")
        if not isinstance(what, str) or not what.strip():
            faults.append(f'{where}: "what" must say in words what is to be done')
        robot = robot_of(raw.get("robot"), offered, where, faults)
        found.append(Subtask(id, one_line(str(what), WHAT_LIMIT), robot, names_of(raw.get("after"), where, faults)))
    faults += order_faults(found)
    if faults:
        raise Faulty(faults)
    return tuple(found)


def robot_of(value: object, offered: Offered, where: str, faults: list[str]) -> Id | None:
    """A robot that is there, or None where none is named."""
    if value is None or value == "":
        return None
    if isinstance(value, str) and value in offered.robots:
        return value
    faults.append(f'{where}: there is no robot "{one_line(str(value), 40)}"; there are {", ".join(offered.robots)}')
    return None


def order_faults(subtasks: Sequence[Subtask]) -> list[str]:
    """Ids given twice, waits for what is not there, waits in a circle."""
    ids = [subtask.id for subtask in subtasks]
    faults = [f"two sub-tasks have the id {id}: give each its own" for id in sorted(set(ids)) if ids.count(id) > 1]
    for subtask in subtasks:
        faults += [
            f"sub-task {subtask.id} waits for {id}, which is no sub-task" for id in subtask.after if id not in ids
        ]
    return faults or _circle(subtasks)


def _circle(subtasks: Sequence[Subtask]) -> list[str]:
    left = {subtask.id: set(subtask.after) for subtask in subtasks}
    while left:
        free = {id for id, after in left.items() if not after & left.keys()}
        if not free:
            return [f"the sub-tasks {', '.join(sorted(left))} wait for each other in a circle"]
        left = {id: after for id, after in left.items() if id not in free}
    return []


def join(subtasks: Sequence[Subtask], steps: Mapping[str, Sequence[Written]]) -> list[Written]:
    """One list of steps: those of a sub-task in a chain, the first after the last of those that the sub-task waits for.

    A sub-task without steps hands on what it waits for itself.
    """
    ends: dict[str, tuple[str, ...]] = {}
    joined: list[Written] = []
    left = list(subtasks)
    while left:
        subtask = next(s for s in left if all(id in ends for id in s.after))
        left.remove(subtask)
        before = tuple(dict.fromkeys(end for id in subtask.after for end in ends[id]))
        for number, step in enumerate(steps.get(subtask.id, ()), 1):
            id = f"{subtask.id}-{number}"
            joined.append(replace(step, id=id, after=before, robot=step.robot or subtask.robot))
            before = (id,)
        ends[subtask.id] = before
    return joined
