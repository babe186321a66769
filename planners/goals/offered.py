"""What a model may choose from in one call: names of types, rooms and things, and the schema that allows no others."""

from dataclasses import dataclass
from typing import Any

from planners.prompt import NAME_LIMIT, Names, holding, one_line, room_text, world_text
from planners.vocabulary import known_types, mentioned_types
from wire.catalogue import type_row
from wire.messages.plan import FROM_ABOVE, PlanRequest
from wire.messages.world import ObjectState, WorldState

EVERYTHING = "Everything"
"""Stands for every type that a goal can be about."""
STATES = ("in", "at", "on", "off", "open", "closed", "clean", "sliced", "found", "visited")
MOST_GOALS, MOST_THINGS = 24, 24
INSTRUCTION_LIMIT = 600


@dataclass(frozen=True)
class Offered:
    """The names of one prompt. `things`: short name -> what is behind it."""

    types: tuple[str, ...]
    rooms: tuple[str, ...]
    things: dict[str, ObjectState]
    predicates: tuple[str, ...]
    lines: str
    """Their text, the same for the same world and mentioned types."""

    def type_of(self, name: str) -> str | None:
        """The type that a name of a type or a thing stands for."""
        return name if name in self.types else self.things[name].type if name in self.things else None

    def holders(self) -> tuple[str, ...]:
        """What something can be put in or on."""
        named = (*self.types, *self.things)
        return tuple(name for name in named if type_row(self.type_of(name) or "").can("receptacle"))


def offer(request: PlanRequest, names: Names) -> Offered:
    """Types that can be recognised or are there, rooms, and the things whose types the instruction mentions."""
    world = request.world
    names.learn(world)
    types = known_types(obj.type for obj in world.objects)
    things = {names.short(obj.id): obj for obj in _alike(request.instruction, world) if obj.type in types}
    things = things if len(things) <= MOST_THINGS else {}
    announced = {card.name for card in request.skills} | {skill for robot in world.robots for skill in robot.skills}
    above = tuple(predicate for skill, predicate in FROM_ABOVE.items() if skill in announced)
    lines = [f"types: {' '.join(types)} {EVERYTHING}", f"rooms: {' '.join(room_text(area) for area in world.areas)}"]
    if above:
        lines.append(f"also p: {' '.join(above)}")
    if things:
        lines.append(f"seen: {_seen(world, names, request.now_s, frozenset(obj.id for obj in things.values()))}")
    return Offered(types, tuple(area.id for area in world.areas), things, (*STATES, *above), "\n".join(lines))


def _alike(instruction: str, world: WorldState) -> list[ObjectState]:
    """Things that the instruction may mean one of: those of a type that it mentions and that there are several of."""
    mentioned = mentioned_types(instruction, {obj.type for obj in world.objects})
    many = {name for name in mentioned if sum(obj.type == name for obj in world.objects) > 1}
    return [obj for obj in world.objects if obj.type in many]


def _seen(world: WorldState, names: Names, now_s: float, shown: frozenset[str]) -> str:
    """Things with what they are in, room by room, in one line."""
    bare = world.model_copy(update={"robots": ()})
    rooms = world_text(bare, names, now_s, holding(shown, world)).splitlines()
    return "; ".join(line for line in rooms if not line.endswith(": -"))


def user_text(offered: Offered, instruction: str) -> str:
    """The part of a prompt that changes, what changes most last."""
    return f'{offered.lines}\ninstruction: "{one_line(instruction, INSTRUCTION_LIMIT)}"'


def schema(offered: Offered) -> dict[str, Any]:
    """JSON schema of a reply: names and predicates as enumerations, every list bounded."""
    places = [*offered.rooms, *offered.holders()]
    fields: dict[str, Any] = {
        "of": {"type": "string", "maxLength": 200},
        "p": {"enum": list(offered.predicates)},
        "a": {"enum": [*offered.types, EVERYTHING, *offered.rooms, *offered.things]},
        "b": {"enum": places},
        "a_in": {"enum": places},
        "b_in": {"enum": list(offered.rooms)},
        "all": {"type": "boolean"},
        "n": {"type": "integer", "minimum": 1, "maximum": 12},
        "except": {
            "type": "array",
            "maxItems": 6,
            "items": {"enum": [*offered.types, *offered.rooms, *offered.things]},
        },
        "step": {"type": "integer", "minimum": 1, "maximum": MOST_GOALS},
    }
    kept = {**fields, "p": {"enum": ["touched", *offered.predicates]}}
    texts = {"type": "array", "maxItems": 8, "items": {"type": "string", "maxLength": 120}}
    return {
        "type": "object",
        "properties": {
            "goals": {"type": "array", "maxItems": MOST_GOALS, "items": _item(fields)},
            "keep": {"type": "array", "maxItems": MOST_GOALS, "items": _item(kept)},
            "talk": texts,
            "unknown": {**texts, "items": {"type": "string", "maxLength": NAME_LIMIT}},
            "ask": {"type": "string", "maxLength": 160},
        },
        "required": ["goals"],
        "additionalProperties": False,
    }


def _item(fields: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": fields, "required": ["of", "p", "a"], "additionalProperties": False}
