"""What the hub keeps of a thing between messages: mutable slots, made for speed. The wire's models come from them."""

from typing import Literal

from hub.kinds import shape

Kind = Literal["cctv", "robot", "device"]


class Claim:
    """What one source says of one property."""

    __slots__ = ("changed_s", "handled", "probability", "stamp_s")

    def __init__(self, probability: float, stamp_s: float, handled: bool = False) -> None:
        self.probability = probability
        self.stamp_s = stamp_s
        self.changed_s = stamp_s
        """When this source last changed its mind."""
        self.handled = handled
        """A robot did it with its own hand: the strongest word there is."""


class Fact:
    """One entry of the vector pi of equation 3, with every source's claim."""

    __slots__ = ("claims", "confidence", "contradicted_by", "source", "stamp_s", "value", "weighed", "weighed_s")

    def __init__(self) -> None:
        self.claims: dict[str, Claim] = {}
        self.value: bool | None = None
        self.confidence = 0.5
        self.source = ""
        self.stamp_s = 0.0
        self.contradicted_by: tuple[str, ...] = ()
        self.weighed, self.weighed_s = 0, -1e9
        """How many claims were weighed last, and when."""


class Sight:
    """What one source has seen of one thing."""

    __slots__ = (
        "absent_looks",
        "absent_s",
        "confidence",
        "hits",
        "place",
        "placed_s",
        "robot",
        "stamp_s",
        "support",
        "votes",
        "x",
        "y",
        "z",
    )

    def __init__(self, robot: bool) -> None:
        self.robot = robot
        self.support = 0.0
        """Its part of the log-odds that the thing is there."""
        self.stamp_s = -1.0
        self.absent_s = -1.0
        self.absent_looks = 0
        self.confidence = 0.0
        self.hits = 0
        self.placed_s = -1e9
        """When one of its looks last counted for the place."""
        self.place = self.votes = 0
        """Where the source stood when it last voted on the type, and how often it has from there."""
        self.x = self.y = self.z = 0.0


class Thing:
    """One object: equation 3 with uncertainty and provenance."""

    __slots__ = (
        "belief",
        "cell",
        "distinct",
        "facts",
        "first_hand_s",
        "from_above",
        "handled_s",
        "hits",
        "id",
        "last_source",
        "locked",
        "looked_into",
        "mark",
        "placed_x",
        "placed_y",
        "placed_z",
        "receptacle",
        "room",
        "shape",
        "shown",
        "shown_confidence",
        "shown_stamp_s",
        "shown_x",
        "shown_y",
        "shown_z",
        "sights",
        "stamp_s",
        "touched",
        "type",
        "verified",
        "version",
        "votes",
        "x",
        "xx",
        "xy",
        "y",
        "yy",
        "z",
        "zz",
    )

    def __init__(self, id: str, type: str, position_m: tuple[float, float, float], stamp_s: float) -> None:
        self.id = id
        self.retype(type)
        self.votes: dict[str, float] = {}
        self.x, self.y, self.z = position_m
        self.xx = self.yy = self.zz = 1.0
        self.xy = 0.0
        self.stamp_s = stamp_s
        self.belief = PRIOR
        """Log-odds that it is there: the prior and what every source adds."""
        self.hits = 0
        self.last_source = ""
        self.first_hand_s = -1e9
        """When a robot last saw it from close by."""
        self.handled_s = -1e9
        """When a robot last took or put it."""
        self.verified = False
        self.from_above = False
        """A robot has hovered over it in this task and looked down."""
        self.looked_into = False
        """A robot has looked into it, open, in this task."""
        self.receptacle: str | None = None
        self.room: str | None = None
        self.facts: dict[str, Fact] = {}
        self.sights: dict[str, Sight] = {}
        self.distinct: set[str] = set()
        """Ids of things that were seen beside it in one picture: never merged with it."""
        self.locked = False
        """In a robot's hand or in something closed: sights neither move, confirm nor deny it."""
        self.mark = -1
        self.cell = 0
        self.touched = False
        self.version = 0
        """Grows with every change that a reader could notice besides position and stamp."""
        self.shown = -1
        self.shown_confidence = -1.0
        self.shown_stamp_s = -1e9
        self.shown_x = self.shown_y = self.shown_z = 1e9
        self.placed_x = self.placed_y = self.placed_z = 1e9
        """Where it was when its room and receptacle were last worked out."""

    def retype(self, type: str) -> None:
        self.type = type
        self.shape = shape(type)


PRIOR = -1.2
"""Log-odds that something a detector claims once is really there, before the claim is weighed."""
