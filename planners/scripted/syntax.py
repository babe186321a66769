"""What an instruction looks like once read: the parse tree as plain values, before anything is looked up."""

from dataclasses import dataclass
from typing import Literal

from wire.messages.goal import Predicate

Quant = Literal["bare", "the", "a", "any", "all", "both", "count", "none"]
State = Literal["on", "off", "open", "closed", "clean", "dirty", "sliced", "alone"]
OPPOSITE: dict[State, Predicate] = {"on": "off", "off": "on", "open": "closed", "closed": "open"}


class Unclear(Exception):
    """The instruction cannot be done as it stands; `question` when an answer would settle it, `final` when no other
    reading of the same words would."""

    def __init__(self, reason: str, part: str = "", *, question: bool = False, final: bool = False) -> None:
        super().__init__(reason)
        self.reason, self.part, self.question, self.final = reason, part, question, final


@dataclass(frozen=True)
class Phrase:
    """Anything with its words."""

    text: str


@dataclass(frozen=True)
class Rooms(Phrase):
    """Room phrases: for each the rooms that its words fit, and how many of them are meant."""

    choices: tuple[tuple[str, ...], ...]
    every: tuple[bool, ...]


@dataclass(frozen=True)
class Thing(Phrase):
    """A noun phrase."""

    head: Literal["noun", "id", "it", "them", "everything", "one"]
    quant: Quant = "bare"
    count: int = 1
    types: tuple[str, ...] = ()
    id: str | None = None
    plural: bool = False
    room_choice: tuple[str, ...] = ()
    """Of a compound ("the kitchen lamp"): the rooms that its first word fits."""
    states: tuple[State, ...] = ()
    """Adjectives and relative clauses ("the dirty plate", "lamps that are on")."""


@dataclass(frozen=True)
class Place(Phrase):
    """A prepositional phrase. `anywhere` ("in the house") restricts nothing; `there` is the last room named."""

    preposition: Literal["IN", "ON", "INTO", "TO", "FROM"]
    what: Rooms | Thing | Literal["there", "anywhere"]
    related: bool = False
    """It follows "that is": it tells which thing is meant, and is no destination."""


@dataclass(frozen=True)
class Group(Phrase):
    """One member of a list, with the places that follow it."""

    thing: Thing
    places: tuple[Place, ...] = ()


LeftOut = Group | Place
"""What is left out: things, or everything in a place."""


@dataclass(frozen=True)
class Groups(Phrase):
    """A list, and what is excepted from it."""

    members: tuple[Group, ...]
    excepted: tuple[LeftOut, ...] = ()


@dataclass(frozen=True)
class Body(Phrase):
    """What something should be: a state, or a place; or not."""

    groups: Groups
    state: State | None
    places: tuple[Place, ...] = ()
    negated: bool = False


@dataclass(frozen=True)
class Act(Phrase):
    """One clause. `verb` is the grammar's name of the command, `word` the verb's base form."""

    verb: str
    word: str
    groups: Groups | None = None
    bodies: tuple[Body, ...] = ()
    stops: tuple[Rooms | Group, ...] = ()
    state: State | None = None
    apart: tuple[LeftOut, ...] = ()
    """Exceptions said before or after the clause and not in its list."""
    everywhere: bool = False
    away: bool = False
    forbidden: bool = False


@dataclass(frozen=True)
class Item(Phrase):
    """A clause with those that are tied to it in time, and how it is joined to the item before it."""

    joint: Literal["", "SEP", "SEPAND", "SEPTHEN"]
    joint_text: str
    stages: tuple[tuple[Act, ...], ...]
    """In the order of doing."""
    first: bool = False
    trailing: bool = False
    """A `before` or `after` stands at the end of it."""
    late_first: bool = False
    """What is done last is said first."""
    fronted: bool = False
    """It begins with a `before` or `after`."""
    apart: bool = False
    """It begins with an exception."""
