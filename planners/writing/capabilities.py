"""The robot capabilities of equation 6 as text: every announced skill with what it takes, and who has which."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from planners.prompt import KINDS, NAME_LIMIT, quoted
from wire.messages.plan import Action, PlanRequest, SkillCard
from wire.messages.world import RobotState

_FIELDS = {"target": "object", "item": "item", "room": "room", "point_m": "point_m", "looking_for": "looking_for"}
"""Fields of a command -> what a step calls them."""
_USUAL: dict[Action, tuple[str, ...]] = {
    "goto": ("object", "room"),
    "explore": ("room", "looking_for"),
    "put": ("object", "item"),
}
"""What actions take whose card is not there."""
_KINDS = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}
_DOC_LIMIT = 120


@dataclass(frozen=True)
class Capability:
    """One skill, whoever has it. `takes`: fields of a step; `own`: the parameters of its own and their kinds."""

    name: Action
    doc: str
    takes: tuple[str, ...]
    own: Mapping[str, str]

    @property
    def line(self) -> str:
        own = (f"{name}: {kind}" for name, kind in self.own.items())
        return f"{self.name}({', '.join((*self.takes, *own))}){': ' if self.doc else ''}{self.doc}"


def capabilities(request: PlanRequest) -> dict[Action, Capability]:
    """By name, those of every robot that is not lost."""
    there = [robot for robot in request.world.robots if robot.status != "lost"]
    names = dict.fromkeys(skill for robot in there for skill in robot.skills)
    cards: dict[Action, list[SkillCard]] = {}
    for card in request.skills:
        cards.setdefault(card.name, []).append(card)
    return {name: _capability(name, cards.get(name, ())) for name in names}


def _capability(name: Action, cards: Sequence[SkillCard]) -> Capability:
    """Robots of several kinds may have a skill of one name: it takes what any of them takes."""
    if not cards:
        return Capability(name, "", _USUAL.get(name, ("object",)), {})
    takes: dict[str, None] = {}
    own: dict[str, str] = {}
    for card in cards:
        for field, schema in _properties(card.parameters).items():
            if field in _FIELDS:
                takes[_FIELDS[field]] = None
            else:
                own[field] = _kind(schema)
    doc = cards[0].doc.split("\n")[0].split(";")[0]
    return Capability(name, quoted(doc, _DOC_LIMIT) if doc else "", tuple(takes), own)


def _properties(parameters: str) -> Mapping[str, object]:
    try:
        schema = json.loads(parameters)
    except (ValueError, RecursionError):
        return {}
    found = schema.get("properties") if isinstance(schema, dict) else None
    named = found if isinstance(found, dict) else {}
    return {name: value for name, value in named.items() if name.isidentifier() and len(name) <= NAME_LIMIT}


def _kind(schema: object) -> str:
    if not isinstance(schema, dict):
        return "text"
    options = [schema, *(option for option in schema.get("anyOf", ()) if isinstance(option, dict))]
    return next((_KINDS[kind] for option in options if (kind := option.get("type")) in _KINDS), "text")


def kind_text(robot: RobotState) -> str:
    """As the world text calls it."""
    return robot.kind if robot.kind in KINDS else quoted(robot.kind, NAME_LIMIT)


def who_can(robots: Iterable[RobotState]) -> str:
    """One line for all robots with the same skills: `dog-1 dog-2 (quadruped): goto explore`."""
    alike: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for robot in robots:
        if robot.status != "lost":
            alike.setdefault((kind_text(robot), robot.skills), []).append(robot.id)
    return "\n".join(f"{' '.join(ids)} ({kind}): {' '.join(skills) or '-'}" for (kind, skills), ids in alike.items())


def skill_lines(skills: Iterable[Capability]) -> str:
    """One line a skill."""
    return "\n".join(skill.line for skill in skills)
