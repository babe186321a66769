"""What is wrong with a message or a site file, in words: the place, what is there, and what would be right."""

from difflib import get_close_matches
from typing import Any, get_args

from pydantic import ValidationError

from wire.model import Message

_NAMED = 3
_PATH_NAMED = 8


def describe(error: ValidationError, model: type[Message]) -> str:
    """One sentence for the first few faults."""
    faults = error.errors(include_url=False, include_context=False)
    texts = [_fault(fault["type"], fault["loc"], fault["msg"], model) for fault in faults[:_NAMED]]
    if len(faults) > _NAMED:
        texts.append(f"and {len(faults) - _NAMED} more")
    return "; ".join(texts)


def _fault(kind: str, place: tuple[int | str, ...], text: str, model: type[Message]) -> str:
    if not place:
        return f"a map with the fields of {model.__name__} is expected"
    path = ".".join(str(part)[:40] for part in place[:_PATH_NAMED]) + ("..." if len(place) > _PATH_NAMED else "")
    if kind == "missing":
        return f"{path}: is missing"
    if kind == "extra_forbidden":
        return f"{path}: {_unknown(str(place[-1]), _model_at(place[:-1], model))}"
    if kind == "model_type" and (at := _model_at(place, model)) is not None:
        return f"{path}: a map with the fields {', '.join(at.model_fields)} is expected"
    told = _wanted(place, model) if kind == "string_pattern_mismatch" else ""
    return f"{path}: {told} is expected" if told else f"{path}: {text[0].lower()}{text[1:]}"


def _wanted(place: tuple[int | str, ...], model: type[Message]) -> str:
    """What a field of this shape is called in words; nothing where nobody has said so."""
    at = _model_at(place[:-1], model)
    field = at.model_fields.get(str(place[-1])) if at is not None else None
    return (field.description or "") if field is not None else ""


def _unknown(name: str, model: type[Message] | None) -> str:
    if model is None:
        return "unknown field, leave it out"
    close = get_close_matches(name[:40], model.model_fields, n=1)
    if close:
        return f"unknown field, is {close[0]} meant?"
    return f"unknown field, leave it out; {model.__name__} has {', '.join(model.model_fields)}"


def _model_at(place: tuple[int | str, ...], model: type[Message]) -> type[Message] | None:
    """The model of the map at this place."""
    at: type[Message] | None = model
    for part in place:
        if isinstance(part, str) and at is not None:
            field = at.model_fields.get(part)
            at = None if field is None else _message_in(field.annotation)
    return at


def _message_in(kind: Any) -> type[Message] | None:
    if isinstance(kind, type) and issubclass(kind, Message):
        return kind
    found = (_message_in(part) for part in get_args(kind) if part is not Ellipsis)
    return next((inner for inner in found if inner is not None), None)
