"""What a plan may be made of in one call: skills, robots, rooms, things by their short names, types to look for."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from planners.prompt import Names, failures_text, one_line, relevant, world_text
from planners.vocabulary import known_types
from planners.writing.capabilities import Capability, capabilities, skill_lines, who_can
from wire.catalogue import type_row
from wire.messages.plan import Action, PlanRequest
from wire.messages.world import ObjectState
from wire.model import Id

MOST_THINGS = 160
"""In a larger world only what the instruction may be about is told."""
MOST_STEPS, MOST_AFTER = 96, 24
INSTRUCTION_LIMIT = 600
_TOKEN = re.compile(r"[a-z0-9][a-z0-9-]*")


@dataclass(frozen=True)
class Offered:
    """`things`: short name -> the thing. Of large worlds they are not all."""

    request: PlanRequest
    names: Names
    skills: Mapping[Action, Capability]
    robots: tuple[Id, ...]
    rooms: tuple[Id, ...]
    things: Mapping[str, ObjectState]
    types: tuple[str, ...]

    @property
    def team(self) -> str:
        """What there is to act with and to look for; it rarely changes."""
        return (
            f"skills:\n{skill_lines(self.skills.values())}\nrobots can:\n{who_can(self.request.world.robots)}\n"
            f"types to look for: {' '.join(self.types)}"
        )

    @property
    def world(self) -> str:
        """What is known of the place now."""
        only = frozenset(thing.id for thing in self.things.values())
        lines = [f"world:\n{world_text(self.request.world, self.names, self.request.now_s, only)}"]
        doors = [name for name, thing in self.things.items() if type_row(thing.type).must_open]
        if doors:
            lines.append(f"closed unless (open): {' '.join(doors)}")
        return "\n".join(lines)

    @property
    def task(self) -> str:
        return f'task: "{one_line(self.request.instruction, INSTRUCTION_LIMIT)}"'

    def cannot(self, robot: Id, do: Action) -> str:
        """Why a robot is not to be given a step; empty when it has the skill."""
        able = [state.id for state in self.request.world.robots if do in state.skills and state.status != "lost"]
        return f"{robot} cannot {do}; {', '.join(able)} can" if able and robot not in able else ""

    def failures(self) -> str:
        """What went wrong in this task, with the hub's ids as their short names; empty where nothing did."""
        told = [self.spoken(sentence) for sentence in self.request.failures]
        return f"went wrong:\n{failures_text(told)}" if told else ""

    def spoken(self, sentence: str) -> str:
        return _TOKEN.sub(lambda word: self.names.short(word[0]), sentence)

    def only(self, robot: Id) -> "Offered":
        """To one robot of the team: its own skills and name."""
        own = next((state.skills for state in self.request.world.robots if state.id == robot), ())
        skills = {name: skill for name, skill in self.skills.items() if name in own}
        return replace(self, skills=skills, robots=(robot,))


def offer(request: PlanRequest, names: Names) -> Offered:
    """All of a small world, of a large one what the instruction may be about."""
    names.learn(request.world)
    types = known_types(obj.type for obj in request.world.objects)
    shown = relevant(request.instruction, request.world) if len(request.world.objects) > MOST_THINGS else None
    things = {names.short(obj.id): obj for obj in request.world.objects if shown is None or obj.id in shown}
    return Offered(
        request=request,
        names=names,
        skills=capabilities(request),
        robots=tuple(robot.id for robot in request.world.robots if robot.status != "lost"),
        rooms=tuple(area.id for area in request.world.areas),
        things=dict(list(things.items())[:MOST_THINGS]),
        types=types,
    )


def step_schema(offered: Offered, **more: Any) -> dict[str, Any]:
    """JSON schema of one step: nothing can be named that was not offered."""
    things = [*offered.things] or ["-"]
    own: dict[str, dict[str, object]] = {name: {} for skill in offered.skills.values() for name in skill.own}
    fields: dict[str, Any] = {
        "id": {"type": "string", "maxLength": 16},
        "do": {"enum": [*offered.skills]},
        "object": {"enum": things},
        "item": {"enum": things},
        "room": {"enum": [*offered.rooms] or ["-"]},
        "looking_for": {"type": "array", "maxItems": 8, "items": {"enum": [*offered.types] or ["-"]}},
        "point_m": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "number"}},
        "params": {"type": "object", "properties": own, "additionalProperties": False},
        "robot": {"enum": [*offered.robots]},
        "after": names_schema(),
        **more,
    }
    return {"type": "object", "properties": fields, "required": ["id", "do"], "additionalProperties": False}


def names_schema() -> dict[str, Any]:
    """A list of ids that the model has given itself."""
    return {"type": "array", "maxItems": MOST_AFTER, "items": {"type": "string", "maxLength": 16}}


def reply_schema(key: str, item: dict[str, Any], most: int = MOST_STEPS) -> dict[str, Any]:
    """An object with a list, and the two ways to say that the list is not all."""
    fields = {
        key: {"type": "array", "maxItems": most, "items": item},
        "more": {"type": "boolean"},
        "cannot": {"type": "string", "maxLength": 200},
    }
    return {"type": "object", "properties": fields, "required": [key], "additionalProperties": False}
