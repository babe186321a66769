"""The mesh's time, and the health of its processes."""

from typing import Annotated, Literal

from pydantic import Field

from wire.model import Id, Message, Stamp, Text, unset

MOST_WAKES = 256
Name = Annotated[str, Field(max_length=32)]


class Tick(Message):
    """One step of simulated time. In lockstep the owner waits for a `TickDone` of every follower whose turn it is."""

    tick: int = Field(ge=0)
    now_s: Stamp
    step_s: float = Field(gt=0.0)


class TickDone(Message):
    """A follower has handled everything that reached it before this tick and has published its answers."""

    tick: int = Field(ge=0)
    follower: Id
    next_turn: int = Field(default=0, ge=0)
    """The tick in which it wants to step again; until then it rests. Any that is past means the next."""
    wakes: tuple[Name, ...] = Field(default=(), max_length=MOST_WAKES, exclude_if=unset)
    """Whom it has asked or answered, processes or a role: their rest ends with the next tick."""


class Health(Message):
    """Two a second, sent by the deciding loop itself, so that a hung loop is noticed."""

    process: Id
    boot_id: str
    seq: int = Field(ge=0)
    stamp_s: Stamp
    loop_age_ms: float = Field(ge=0.0)
    mode: Literal["starting", "ready", "busy", "holding", "stopping"]
    note: Text = ""
