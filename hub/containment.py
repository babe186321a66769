"""What rests in or on what, from believed places and the catalogue's sizes; what a closed door hides."""

from math import hypot

from hub.kinds import Shape
from hub.records import Thing
from hub.things import Things
from wire.catalogue import catalogue

_REACH_M = 1.7
FARTHEST = 1.1
"""Half diagonals of a receptacle from its middle within which things may be on it."""
LEAST_HOLDER = 0.9
"""A receptacle's half diagonal is at least this part of that of what it holds."""
_ON_SLACK_M = 0.18
_SEATS = frozenset({"ArmChair", "Bed", "Chair", "Sofa"})
"""Things are put on these far below their tops: on the seat."""
_LEVELS = frozenset({"CoffeeMachine", "ShelvingUnit", "Toilet"})
"""Things may stand at any height of these."""
_LEAST = 0.35


def parent_of(thing: Thing, things: Things) -> str | None:
    """The receptacle that a small thing most probably rests in or on."""
    known = thing.shape
    if known.kind not in ("pickup", "moveable") or (known.kind == "moveable" and known.half_diagonal_m > 0.75):
        return None
    bottom_m = thing.z - known.height_m / 2.0
    best: tuple[float, str] | None = None
    for other in things.near(thing.x, thing.y, _REACH_M):
        mode, reach_m = other.shape.receptacle_mode, FARTHEST * other.shape.half_diagonal_m
        if mode is None or abs(thing.x - other.x) > reach_m or abs(thing.y - other.y) > reach_m:
            continue
        if other is thing or other.receptacle == thing.id or other.locked:
            continue
        if mode != "on" and (known.kind == "moveable" or closed(other)):
            continue  # what is seen is not in anything that is shut
        fit = _fit(thing, known, bottom_m, other)
        if fit > _LEAST and (best is None or (fit, other.id) > best):
            best = (fit, other.id)
    return best[1] if best is not None else None


def _fit(thing: Thing, known: Shape, bottom_m: float, other: Thing) -> float:
    """0 to 1: how well the thing's place suits this receptacle."""
    holder = other.shape
    if holder.receptacle_mode is None or holder.half_diagonal_m < LEAST_HOLDER * known.half_diagonal_m:
        return 0.0
    away = hypot(thing.x - other.x, thing.y - other.y) / holder.half_diagonal_m
    if away > (FARTHEST if holder.receptacle_mode == "on" else 0.9):
        return 0.0
    height = _height_fit(bottom_m, thing.z, other, holder)
    if height <= 0.0:
        return 0.0
    usual = 0.2 if other.type in _usual(thing.type) else 0.0
    kept = (0.6 if thing.handled_s > 0.0 else 0.15) if thing.receptacle == other.id else 0.0
    small = 0.15 / (1.0 + holder.half_diagonal_m)  # of two that fit, the smaller one: the plate on the table
    return 0.55 * height + 0.35 * (1.15 - away) + usual + kept + small - 0.15


def _usual(type: str) -> tuple[str, ...]:
    row = catalogue().get(type)
    return row.allowed_in if row is not None else ()


def _height_fit(bottom_m: float, middle_m: float, other: Thing, holder: Shape) -> float:
    low_m, high_m = other.z - holder.height_m / 2.0, other.z + holder.height_m / 2.0
    if holder.receptacle_mode == "on" and other.type not in _SEATS | _LEVELS:
        return 1.0 - abs(bottom_m - high_m) / (_ON_SLACK_M + 0.12)
    if other.type in _SEATS:
        return 1.0 - abs(bottom_m - low_m - 0.5 * holder.height_m) / 0.4
    slack = 0.08
    if other.type in _LEVELS:
        return 1.0 if low_m - slack <= bottom_m <= high_m + slack else 0.0
    if low_m - slack <= middle_m <= high_m + slack:
        return 1.0
    return 0.0


def must_be_open(thing: Thing) -> bool:
    """Whether what is in it can be seen and reached only while it is open."""
    known = thing.shape
    return known.encloses and known.must_open


def closed(thing: Thing) -> bool:
    """Whether it is believed to be shut."""
    fact = thing.facts.get("isOpen")
    return must_be_open(thing) and (fact is None or fact.value is not True)


def hidden(thing: Thing, things: Things) -> bool:
    """Whether something closed is around it, at any depth."""
    seen = {thing.id}
    holder = things.get(thing.receptacle)
    while holder is not None and holder.id not in seen:
        if closed(holder):
            return True
        seen.add(holder.id)
        holder = things.get(holder.receptacle)
    return False
