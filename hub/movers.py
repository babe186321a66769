"""What traffic knows of a robot, and what it tells it."""

from dataclasses import dataclass

from wire.model import Vec2

KEPT_M = 0.45
"""Of two that fly, one is over the other when this much is between them; less is the downwash of one on the other."""


@dataclass(frozen=True, slots=True)
class Mover:
    """One robot as traffic sees it."""

    id: str
    position_m: Vec2
    path_m: tuple[Vec2, ...]
    """What is left of its way, nearest first; empty when it wants nothing."""
    radius_m: float = 0.38
    heights_m: tuple[float, float] | None = None
    """Of what flies: the lowest and the highest that it is on its way. None is in the way of everybody."""

    @property
    def way(self) -> list[Vec2]:
        return [self.position_m, *self.path_m]


@dataclass(frozen=True, slots=True)
class Ruling:
    """What one robot is told."""

    go: bool
    step_aside_m: Vec2 | None = None
    because: str = ""
    held_by: str = ""
    """Who is waited for."""


def share_height(a: Mover, b: Mover) -> bool:
    """Whether two robots can meet at all: not when one flies well over the other all the way."""
    if a.heights_m is None or b.heights_m is None or a.id == b.id:
        return True
    return max(a.heights_m[0] - b.heights_m[1], b.heights_m[0] - a.heights_m[1]) < KEPT_M
