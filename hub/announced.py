"""Nodes whose action only the robots know that announce it: are the parameters those of the announced schema?"""

import json
from collections.abc import Mapping

from wire.messages.plan import Param, PlanNode

_KINDS: dict[str, tuple[type, ...]] = {
    "boolean": (bool,),
    "integer": (int,),
    "number": (int, float),
    "string": (str,),
}
"""JSON schema's names for what a parameter of a skill's own can be."""


def parameter_fault(node: PlanNode, schema: str) -> str:
    """What of the node's parameters does not suit the skill, in a sentence; empty when they do.

    Names and types are compared here; ranges are checked by the device, which refuses with a sentence of its own.
    """
    properties, required = _announced(schema)
    if properties is None:
        return f"its robot announces parameters of {node.action} that are no JSON schema"
    given = _given(node)
    missing = [name for name in required if name not in given]
    if missing:
        return f"{', '.join(map(_named, missing))} is missing; {_takes(properties)}"
    return _foreign(given, properties) or _first_wrong(node, properties)


def own_parameter_fault(node: PlanNode, schema: str) -> str:
    """The same of `params` alone: for actions whose object, item and room the hub itself knows."""
    properties, _ = _announced(schema)
    if properties is None:
        return f"its robot announces parameters of {node.action} that are no JSON schema"
    return _foreign(node.params, properties) or _first_wrong(node, properties)


def _announced(schema: str) -> tuple[dict[str, object] | None, list[str]]:
    """Properties (None when the text is no schema) and the names of those that must be given."""
    try:
        announced = json.loads(schema)
    except (ValueError, RecursionError):
        return None, []
    if not isinstance(announced, dict):
        return None, []
    properties, required = announced.get("properties", {}), announced.get("required", [])
    if not isinstance(properties, dict) or not isinstance(required, list):
        return None, []
    return properties, required


def _takes(properties: Mapping[str, object]) -> str:
    return f"it takes {', '.join(map(_named, properties)) or 'nothing'}"


def _foreign(given: Mapping[str, object], properties: Mapping[str, object]) -> str:
    names = [name for name in given if name not in properties]
    return f"{', '.join(map(_named, names))} is no parameter of it; {_takes(properties)}" if names else ""


def _first_wrong(node: PlanNode, properties: Mapping[str, object]) -> str:
    return next((fault for name, value in node.params.items() if (fault := _wrong(name, value, properties[name]))), "")


def _given(node: PlanNode) -> Mapping[str, object]:
    fields = {
        "target": node.object,
        "item": node.item,
        "room": node.room,
        "point_m": node.point_m,
        "looking_for": node.looking_for or None,
    }
    return {name: value for name, value in fields.items() if value is not None} | node.params


def _named(name: str) -> str:
    """A command's `target` is what a node calls its object."""
    return "object" if name == "target" else name


def _wrong(name: str, value: Param, announced: object) -> str:
    kind = announced.get("type") if isinstance(announced, dict) else None
    kinds = _KINDS.get(kind) if isinstance(kind, str) else None
    if kinds is None or (isinstance(value, kinds) and isinstance(value, bool) == (kind == "boolean")):
        return ""
    return f"{name} must be a {kind}, not {value!r}"
