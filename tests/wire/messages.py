"""Hypothesis strategies for every message of the key tables, read off their models."""

import types
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from hypothesis import strategies as st
from pydantic.fields import FieldInfo

from wire.keys import SERVICES, TOPICS
from wire.model import Message

DEEPEST = 3


def message_types() -> list[type[Message]]:
    """Each once, by name."""
    kinds = {t.message for t in TOPICS} | {s.request for s in SERVICES} | {s.reply for s in SERVICES}
    return sorted(kinds, key=lambda kind: kind.__name__)


def messages(message_type: type[Message], depth: int = 0) -> st.SearchStrategy[Any]:
    fields = {name: _field(field, depth) for name, field in message_type.model_fields.items()}
    return st.fixed_dictionaries(fields).map(lambda values: message_type(**values))


def _field(field: FieldInfo, depth: int) -> st.SearchStrategy[Any]:
    return _value(field.annotation, _bounds(field.metadata), depth)


def _bounds(metadata: Any) -> dict[str, Any]:
    names = ("ge", "gt", "le", "lt", "min_length", "max_length", "pattern")
    found: dict[str, Any] = {}
    for item in metadata:
        parts = item.metadata if isinstance(item, FieldInfo) else [item]
        for part in parts:
            found |= {n: v for n in names if (v := getattr(part, n, None)) is not None}
    return found


def _value(kind: Any, bounds: dict[str, Any], depth: int) -> st.SearchStrategy[Any]:
    origin, args = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return _value(args[0], bounds | _bounds(args[1:]), depth)
    if origin is Literal:
        return st.sampled_from(args)
    if origin in (Union, types.UnionType):
        kinds = [a for a in args if a is not type(None) and not (_is_message(a) and depth >= DEEPEST)]
        empty = [st.none()] if type(None) in args else []
        return st.one_of(*empty, *(_value(a, bounds, depth) for a in kinds))
    if origin is tuple:
        return _tuple(args, bounds, depth)
    if origin is dict:
        return st.dictionaries(_value(args[0], {}, depth), _value(args[1], {}, depth), max_size=3)
    if _is_message(kind):
        return messages(kind, depth + 1)
    return _scalar(kind, bounds)


def _tuple(args: tuple[Any, ...], bounds: dict[str, Any], depth: int) -> st.SearchStrategy[Any]:
    if args[-1] is not Ellipsis:
        return st.tuples(*(_value(a, {}, depth) for a in args))
    if _is_message(args[0]) and depth >= DEEPEST:
        return st.just(())
    return st.lists(_value(args[0], {}, depth), min_size=bounds.get("min_length", 0), max_size=2).map(tuple)


def _scalar(kind: Any, bounds: dict[str, Any]) -> st.SearchStrategy[Any]:
    if kind is bool:
        return st.booleans()
    if kind is int:
        low = bounds["gt"] + 1 if "gt" in bounds else bounds.get("ge", -(2**63))
        return st.integers(low, bounds.get("le", 2**63 - 1))
    if kind is float:
        low, high = bounds.get("ge", bounds.get("gt")), bounds.get("le", bounds.get("lt"))
        strict = {"exclude_min": "gt" in bounds, "exclude_max": "lt" in bounds}
        return st.floats(low, high, allow_nan=False, allow_infinity=False, **strict)
    if kind is bytes:
        return st.binary(min_size=bounds.get("min_length", 0), max_size=64)
    assert kind is str, f"no strategy for {kind}"
    if "pattern" in bounds:
        return st.from_regex(bounds["pattern"].removesuffix("$") + r"\Z")
    return st.text(min_size=bounds.get("min_length", 0), max_size=min(bounds.get("max_length", 20), 20))


def _is_message(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, Message)
