"""One thing that reached a node, still undecoded, and the stamp that travels beside every payload."""

import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

NO_TICK = -1
"""The tick of a sender that does not live in lockstep."""
_HEAD = struct.Struct("<qQ")


class Kind(IntEnum):
    """In the order in which letters of one tick are handed out."""

    PRESENCE = 0
    MESSAGE = 1
    REPLY = 2
    REQUEST = 3


@dataclass(slots=True)
class Letter:
    kind: Kind
    name: str
    """Of the topic or service; empty for presence."""
    id: str
    sender: str = ""
    tick: int = NO_TICK
    seq: int = 0
    payload: bytes = b""
    ask: int = 0
    """For a reply: the number of the question."""
    error: str = ""
    """For a reply: why there is none."""
    alive: bool = False
    """For presence."""
    answer: "Callable[[bytes], None] | None" = None
    refuse: "Callable[[str], None] | None" = None
    """For a request: how to answer it, and how to say that it cannot be understood."""


def write_stamp(tick: int, seq: int, sender: str) -> bytes:
    return _HEAD.pack(tick, seq) + sender.encode()


def read_stamp(stamp: bytes) -> tuple[int, int, str]:
    """(tick, seq, sender); ValueError when these bytes are no stamp."""
    if not _HEAD.size < len(stamp) <= _HEAD.size + 32:
        raise ValueError("not the stamp of a node")
    tick, seq = _HEAD.unpack_from(stamp)
    return tick, seq, stamp[_HEAD.size :].decode()


def stamp_of(attachment: Any) -> tuple[int, int, str] | None:
    """The stamp in Zenoh's attachment; None when there is none."""
    if attachment is None or len(attachment) > 64:
        return None
    try:
        return read_stamp(attachment.to_bytes())
    except ValueError:
        return None


def reply_letter(service: str, id: str, number: int, reply: Any) -> Letter:
    """Zenoh's reply to question `number`."""
    letter = Letter(Kind.REPLY, service, id, ask=number)
    if reply.ok is not None:
        stamp = stamp_of(reply.ok.attachment)
        if stamp is not None:
            letter.tick, letter.seq, letter.sender = stamp
        letter.payload = reply.ok.payload.to_bytes()
    elif reply.err is not None:
        letter.error = reply.err.payload.to_string() or "refused"
    return letter


def refuse_query(query: Any, text: str) -> None:
    """Tell whoever asked over Zenoh why there is no answer."""
    query.reply_err(text.encode())
    query.drop()
