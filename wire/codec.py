"""msgpack <-> message. What is too big, too deep or not of the agreed shape is refused here and gets no further."""

from typing import Any, TypeVar

import msgpack
from pydantic import ValidationError

from wire.faults import describe
from wire.messages.driver import CameraFrame
from wire.messages.look import LookRequest
from wire.messages.operator import TaskState, WhyReply
from wire.messages.plan import PlanReply, PlanRequest, PlanState
from wire.messages.truth import TruthState
from wire.messages.world import WorldDelta, WorldState
from wire.model import Message

M = TypeVar("M", bound=Message)

PICTURE_BYTES = 8_000_000
LOOK_BYTES = 800_000
WORLD_BYTES = 2_000_000
SMALL_BYTES = 300_000
_MAX_BYTES: dict[type[Message], int] = {
    CameraFrame: PICTURE_BYTES,
    LookRequest: LOOK_BYTES,
    **dict.fromkeys((WorldState, WorldDelta, TruthState, PlanRequest, PlanReply, PlanState), WORLD_BYTES),
    **dict.fromkeys((TaskState, WhyReply), WORLD_BYTES),
}
_MAX_ENTRIES = 64
"""Of one map: fields of a message, or its properties."""
_MAX_ELEMENTS = 16_384
"""Of one array."""


class WireError(ValueError):
    """Bytes that are not the message they should be; one sentence with key, field and what would be right."""


def max_bytes(message_type: type[Message]) -> int:
    """The most that one message of this type may take on the wire."""
    return _MAX_BYTES.get(message_type, SMALL_BYTES)


def encode(message: Message) -> bytes:
    """The bytes that `decode` turns into an equal message."""
    payload: bytes = msgpack.packb(message.model_dump())
    if len(payload) > max_bytes(type(message)):
        raise WireError(_too_big(type(message), len(payload), type(message).__name__))
    return payload


def decode(message_type: type[M], payload: bytes, key: str = "") -> M:
    """The message in `payload`. `key` only serves the text of the WireError."""
    where = key or message_type.__name__
    if len(payload) > max_bytes(message_type):
        raise WireError(_too_big(message_type, len(payload), where))
    value = _unpack(payload, message_type, where)
    try:
        return message_type.model_validate(value)
    except ValidationError as error:
        raise WireError(f"{where}: {describe(error, message_type)}") from None


def _unpack(payload: bytes, message_type: type[Message], where: str) -> Any:
    try:
        return msgpack.unpackb(
            payload,
            use_list=False,
            max_map_len=_MAX_ENTRIES,
            max_array_len=_MAX_ELEMENTS,
            max_ext_len=0,
        )
    except msgpack.StackError:
        fault = "nested too deeply"
    except (ValueError, TypeError) as error:
        # ValueError covers msgpack's ExtraData and FormatError too; a map key that cannot be hashed is a TypeError
        fault = f"not valid msgpack ({str(error) or type(error).__name__})"
    raise WireError(f"{where}: {fault}; a map with the fields of {message_type.__name__} is expected")


def _too_big(message_type: type[Message], size: int, where: str) -> str:
    return f"{where}: {size} bytes are too many; a {message_type.__name__} may take {max_bytes(message_type)}"
