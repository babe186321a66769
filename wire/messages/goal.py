"""Goals: what should be true when a task is done. Predicates over the world, never steps."""

from typing import Literal

from pydantic import Field

from wire.model import Id, Message, Word

Predicate = Literal[
    "in",  # subject rests in or on object (a receptacle)
    "at",  # subject is in the room or, for a robot, near the object
    "open",
    "closed",
    "on",
    "off",
    "clean",
    "sliced",
    "found",  # subject's place is known from a look in this task
    "visited",  # a robot has been in the room / beside the object
    "seen_from_above",  # a robot has hovered over the room or the object in this task and looked down
    "surveyed",  # a robot has flown over the whole room in lanes in this task
    "touched",  # a robot has handled the subject in any way; only ever forbidden
]


class Selector(Message):
    """Which things are meant: by type, optionally in a room, in or on a receptacle, or one thing by its id."""

    type: Word | None = None
    id: Id | None = None
    room: Id | None = None
    inside: Word | None = None
    """Only those in or on a receptacle of this type."""
    count: int | None = Field(default=1, ge=1)
    """How many; None means every one there is."""
    exclude: tuple["Selector", ...] = ()


class Goal(Message):
    """`predicate(subject[, object])`; `negated` asks that it be false at the end."""

    predicate: Predicate
    subject: Selector
    object: Selector | None = None
    negated: bool = False
    forbidden: bool = False
    """A restraint on the way ("do not open the box"): no step may bring this about. It asks nothing of the end, so it
    always holds. `in` without an object forbids every move of the subject; `visited` forbids entering the room."""
    after: tuple[int, ...] = ()
    """Indices of goals in the same list that must be reached first."""
    text: str = Field(default="", max_length=300)
    """The words of the instruction that this came from."""
