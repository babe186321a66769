"""Pieces of work: a job is a chain of steps for one robot, and may wait for other jobs."""

from dataclasses import dataclass, field

from wire.messages.plan import Action
from wire.messages.world import ObjectState
from wire.model import Vec2

STEP_S: dict[Action, float] = {
    "goto": 1.0,
    "explore": 35.0,
    "inspect": 6.0,
    "pickup": 7.0,
    "put": 7.0,
    "open": 6.0,
    "close": 6.0,
    "toggle_on": 5.0,
    "toggle_off": 5.0,
    "slice": 7.0,
    "clean": 8.0,
    "inspect_from_above": 15.0,
    "construct_map": 60.0,
}
"""About how long a step takes once the robot is there."""


class Impossible(Exception):
    """A goal that cannot be reached; the text says why, for the operator."""


@dataclass(frozen=True)
class Step:
    """One node to be."""

    action: Action
    point_m: Vec2
    object: str | None = None
    item: str | None = None
    room: str | None = None
    looking_for: tuple[str, ...] = ()


@dataclass
class Job:
    """Steps in order. `waits`: (own step, other job) pairs: the step comes after the whole other job."""

    steps: list[Step]
    goal: int | None
    waits: list[tuple[int, int]] = field(default_factory=list)
    robot: str | None = None
    """Who must do it: the one that holds the thing already."""
    about: frozenset[str] = frozenset()
    """Things that it changes: jobs about the same thing follow each other."""
    rank: int = 0
    """Among jobs about one thing: states 0, moves 1, slicing 2 (a sliced thing cannot be moved)."""
    weight: float = 0.0
    """Of a search: how probable it is to find what is looked for."""

    @property
    def entry_m(self) -> Vec2:
        return self.steps[0].point_m

    @property
    def exit_m(self) -> Vec2:
        return self.steps[-1].point_m


def on(action: Action, obj: ObjectState, item: ObjectState | None = None) -> Step:
    """A step on a thing where it is."""
    point = (obj.position_enu_m[0], obj.position_enu_m[1])
    return Step(action, point, obj.id, item.id if item is not None else None)
