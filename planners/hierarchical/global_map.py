"""Global map integration: what was seen from above and what others have seen, as one world with one name for each thing.

The paper hands all local maps to a model, which votes between them. Here fusion has done most of it; asked is only about
things that may still be one and the same, seen by a robot that flies and by others.
"""

from collections.abc import Sequence
from math import hypot
from typing import Any

from planners.parse import Cannot, Faulty, object_with
from planners.prompt import Names, label, quoted
from planners.writing.dialogue import Dialogue
from wire.messages.plan import PlanRequest
from wire.messages.world import ObjectState, WorldState

PURPOSE = "global_map"
NEAR_M = 1.2
"""Farther apart two sightings of one thing do not come to lie."""
MOST_PAIRS = 12
_FLYING = "construct_map"
_MOST_TOKENS = 400
Pair = tuple[ObjectState, ObjectState]


def integrated(request: PlanRequest, names: Names, dialogue: Dialogue) -> WorldState:
    """The world without the second entries of things, as the model decides; as it is where nothing is in doubt."""
    pairs = doubtful_pairs(request.world)
    if not pairs:
        return request.world
    things = {names.short(obj.id): obj for pair in pairs for obj in pair}
    user = "\n".join(("entries:", *(_entry(name, obj) for name, obj in things.items()), "may be the same:", *(
        f"{names.short(a.id)} {names.short(b.id)}: {_apart_m(a, b):.1f} m apart" for a, b in pairs
    )))  # fmt: skip
    allowed = {frozenset((names.short(a.id), names.short(b.id))) for a, b in pairs}
    same = dialogue.ask(PURPOSE, user, _schema([*things]), lambda text: _read(text, allowed), _MOST_TOKENS)
    dropped = {_worse(*(things[name] for name in pair)).id for pair in same}
    return request.world.model_copy(
        update={"objects": tuple(obj for obj in request.world.objects if obj.id not in dropped)}
    )


def doubtful_pairs(world: WorldState) -> list[Pair]:
    """Near each other, of one type or one that the other was taken for, one of them seen by what flies alone."""
    flyers = {robot.id for robot in world.robots if _FLYING in robot.skills}
    above = [obj for obj in world.objects if {obj.source, *obj.seen_by} <= flyers]
    others = [obj for obj in world.objects if not {obj.source, *obj.seen_by} <= flyers]
    pairs = [(a, b) for a in above for b in others if _alike(a, b) and _apart_m(a, b) <= NEAR_M]
    return sorted(pairs, key=lambda pair: (_apart_m(*pair), pair[0].id, pair[1].id))[:MOST_PAIRS]


def _alike(a: ObjectState, b: ObjectState) -> bool:
    return a.room == b.room and (a.type == b.type or a.type in b.maybe or b.type in a.maybe)


def _apart_m(a: ObjectState, b: ObjectState) -> float:
    return hypot(a.position_enu_m[0] - b.position_enu_m[0], a.position_enu_m[1] - b.position_enu_m[1])


def _entry(name: str, obj: ObjectState) -> str:
    x, y, _ = obj.position_enu_m
    by = ", ".join(sorted({obj.source, *obj.seen_by}))
    said = f"{name}: {label(obj.type)} at ({x:.1f}, {y:.1f}) in {obj.room or 'no room'}, seen by {quoted(by, 60)}"
    others = " ".join(f"maybe-{label(type)}" for type in sorted(obj.maybe))
    return f"{said}, sure {obj.confidence:.0%}{' ' if others else ''}{others}"


def _schema(names: Sequence[str]) -> dict[str, Any]:
    pair = {"type": "array", "minItems": 2, "maxItems": 2, "items": {"enum": [*names]}}
    fields = {"same": {"type": "array", "maxItems": MOST_PAIRS, "items": {
        "type": "object", "properties": {"names": pair, "why": {"type": "string", "maxLength": 120}},
        "required": ["names"], "additionalProperties": False,
    }}}  # fmt: skip
    return {"type": "object", "properties": fields, "required": ["same"], "additionalProperties": False}


def _read(text: str, allowed: set[frozenset[str]]) -> list[tuple[str, str]]:
    try:
        listed = object_with(text, "same")["same"]
    except Cannot as cannot:
        raise Faulty([f"say which entries are the same ({cannot})"]) from None
    found, faults = [], []
    for entry in listed if isinstance(listed, list) else []:
        pair = entry.get("names") if isinstance(entry, dict) else None
        names = [name for name in pair if isinstance(name, str)] if isinstance(pair, list) else []
        if frozenset(names) in allowed and len(names) == 2:
            found.append((names[0], names[1]))
        else:
            faults.append(f"{quoted(str(pair), 60)} is none of the pairs that may be the same")
    if faults:
        raise Faulty(faults)
    return found


def _worse(a: ObjectState, b: ObjectState) -> ObjectState:
    """The entry to be left out: the one that fewer have seen, less surely."""
    return min(a, b, key=lambda obj: (obj.verified, len({obj.source, *obj.seen_by}), obj.confidence, obj.id))
