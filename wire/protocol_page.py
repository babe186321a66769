"""Writes `docs/protocol.md` from the key tables and the message models: `python -m wire.protocol_page docs/protocol.md`."""

import sys
import types
from collections.abc import Iterable
from inspect import getdoc
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo

from wire.codec import max_bytes
from wire.keys import PRESENCE_PATH, ROLES, SERVICES, TOPICS, Role
from wire.link import MAX_MESSAGE_BYTES
from wire.messages.plan import KNOWN_ACTIONS
from wire.model import Message

INTRODUCTION = f"""# The protocol

Generated from `wire/keys.py` and `wire/messages/`; `python -m wire.protocol_page docs/protocol.md` writes it anew.

Every key begins with the site's realm (`r2x` unless the site file says otherwise). A payload is a msgpack map of the
message's fields; an unknown field, a wrong type, a number that is not finite or too many bytes are refused, and the
receiver's log says so. What is larger than {MAX_MESSAGE_BYTES} bytes goes no further than the router, which keeps no
word of it. Beside each payload travels an attachment: the tick in which it was sent (8 bytes, little-endian, -1 for a sender outside
lockstep), the sender's own count (8 bytes) and the sender's id. `{{id}}` is one chunk of lower-case letters, digits and hyphens.

Delivery `every` blocks the sender rather than lose a message; of `latest` a slow reader sees the newest only. A process
that is there holds the liveliness token `{PRESENCE_PATH}`.

In lockstep a process is handed, at tick n, what the owner of the clock sent up to tick n and what everybody else sent
before tick n, sorted by topic, id, sender and count: the same in every run.

An action of a plan or a command is the name of a skill. The hub and the planners know the effects of
{", ".join(f"`{action}`" for action in sorted(KNOWN_ACTIONS))}; any other may be used that a robot announces, with the
parameters of its announced schema.
"""


def page() -> str:
    """The whole page."""
    kinds = _closure([t.message for t in TOPICS] + [k for s in SERVICES for k in (s.request, s.reply)])
    parts = [INTRODUCTION, _topics(), _services(), "## Messages\n"]
    parts += [_message(kind) for kind in sorted(kinds, key=lambda kind: kind.__name__)]
    return "\n".join(parts)


def _topics() -> str:
    rows = ["## Topics\n", "| topic | key | message | delivery | Hz | published by | heard by | |", "|---" * 8 + "|"]
    for t in TOPICS:
        rate = f"{t.rate_hz:g}" if t.rate_hz else "on events"
        rows.append(
            f"| {t.name} | `{t.path}` | {_link(t.message)} | {t.delivery} | {rate} "
            f"| {_roles(t.publishers)} | {_roles(t.subscribers)} | {t.about} |"
        )
    return "\n".join(rows) + "\n"


def _services() -> str:
    rows = ["## Services\n", "| service | key | request | reply | within | served by | asked by | |", "|---" * 8 + "|"]
    for s in SERVICES:
        rows.append(
            f"| {s.name} | `{s.path}` | {_link(s.request)} | {_link(s.reply)} | {s.timeout_s:g} s "
            f"| {_roles(s.servers)} | {_roles(s.callers)} | {s.about} |"
        )
    return "\n".join(rows) + "\n"


def _message(kind: type[Message]) -> str:
    doc = " ".join((getdoc(kind) or "").split()) if kind.__doc__ else ""
    head = f"### {kind.__name__}\n\n{doc + chr(10) if doc else ''}"
    if not kind.model_fields:
        return f"{head}No fields. At most {max_bytes(kind)} bytes.\n"
    rows = ["| field | type | default |", "|---|---|---|"]
    for name, field in kind.model_fields.items():
        default = "" if field.is_required() else f"`{field.get_default(call_default_factory=True)!r}`"
        rows.append(f"| {name} | {_type(field.annotation)}{_bounds(field)} | {default} |")
    return f"{head}\n" + "\n".join(rows) + "\n"


def _closure(kinds: Iterable[type[Message]]) -> set[type[Message]]:
    """These messages and all that are inside them."""
    found: set[type[Message]] = set()
    left = list(kinds)
    while left:
        kind = left.pop()
        if kind not in found:
            found.add(kind)
            left += [inner for field in kind.model_fields.values() for inner in _inside(field.annotation)]
    return found


def _inside(kind: Any) -> list[type[Message]]:
    if isinstance(kind, type) and issubclass(kind, Message):
        return [kind]
    return [inner for part in get_args(kind) if part is not Ellipsis for inner in _inside(part)]


def _type(kind: Any) -> str:
    origin, args = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return _type(args[0])
    if origin is Literal:
        return "one of " + ", ".join(f"`{value}`" for value in args)
    if origin in (Union, types.UnionType):
        return " or ".join("nil" if part is type(None) else _type(part) for part in args)
    if origin is tuple:
        inner = _type(args[0]) if args[-1] is Ellipsis else ", ".join(_type(part) for part in args)
        return f"array of {inner}" if args[-1] is Ellipsis else f"[{inner}]"
    if origin is dict:
        return f"map of {_type(args[0])} to {_type(args[1])}"
    if isinstance(kind, type) and issubclass(kind, Message):
        return _link(kind)
    return str(getattr(kind, "__name__", kind))


def _bounds(field: FieldInfo) -> str:
    signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<", "min_length": "length ≥", "max_length": "length ≤"}
    texts = [
        f"{sign} {getattr(item, name)}"
        for item in field.metadata
        for name, sign in signs.items()
        if getattr(item, name, None) is not None
    ]
    return f", {', '.join(texts)}" if texts else ""


def _link(kind: type[Message]) -> str:
    return f"[{kind.__name__}](#{kind.__name__.lower()})"


def _roles(roles: tuple[Role, ...]) -> str:
    return "everybody" if roles == ROLES else ", ".join(roles)


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page())
