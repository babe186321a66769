"""Which thing is it that a source sees? Gates of covariance and type; later, which two things are one."""

from collections.abc import Mapping

from hub.records import Thing
from hub.things import Things
from wire.messages.observation import ObjectObservation

GATE = 11.3
"""99 % of a chi-square with three degrees of freedom."""
LOCKED_M2 = 0.25**2
"""How far from its holder a thing in a hand or in something closed may be seen: one standard deviation."""
_REACH_M = 1.6
_CONFUSED = 5.0
"""A match across two types that look alike costs this much of the gate."""
_LIVE_S = 3.0
_MERGE_GATE = 6.0
_MERGE_M, _MERGE_M2 = 0.9, 0.81
_STANDS_M = 0.3
"""What begins lower than this stands on the floor."""
_OVERLAP = 0.6
_HEIGHT_M2 = 0.05**2


def find(things: Things, seen: ObjectObservation, source: str, stamp_s: float, mark: int) -> Thing | None:
    """The thing that an observation most probably is of, or None when it is a new one.

    A thing already matched in this picture (`mark`) is out: two things in one picture are two things.
    """
    x, y, _ = seen.position_enu_m
    best, best_cost = None, GATE
    for thing in things.near(x, y, _REACH_M):
        if thing.mark == mark:
            continue
        penalty = type_penalty(thing, seen.type)
        if penalty >= best_cost:
            continue
        if thing.locked:
            cost = penalty + ((x - thing.x) ** 2 + (y - thing.y) ** 2) / LOCKED_M2
        else:
            cost = penalty + distance_2(thing, seen, stamp_s)
        sight = thing.sights.get(source)
        if sight is not None and stamp_s - sight.stamp_s < _LIVE_S:
            cost += 1.0  # this source follows it under another name: less likely the same
        if cost < best_cost or (cost == best_cost and best is not None and thing.id < best.id):
            best, best_cost = thing, cost
    return best


def type_penalty(thing: Thing, type: str) -> float:
    if thing.type == type:
        return 0.0
    return _CONFUSED if type in thing.shape.confusable else GATE


def distance_2(thing: Thing, seen: ObjectObservation, stamp_s: float) -> float:
    """Squared Mahalanobis distance between where a thing is believed to be and where it is seen."""
    x, y, z = seen.position_enu_m
    rxx, rxy, ryy, rzz = seen.covariance_m2
    known = thing.shape
    extra = known.gate_m2 + known.walk_m2_per_s * max(stamp_s - thing.stamp_s, 0.0)
    sxx, sxy, syy = thing.xx + rxx + extra, thing.xy + rxy, thing.yy + ryy + extra
    dx, dy, dz = x - thing.x, y - thing.y, z - thing.z
    det = sxx * syy - sxy * sxy
    plane = (syy * dx * dx - 2.0 * sxy * dx * dy + sxx * dy * dy) / det
    return plane + dz * dz / (thing.zz + rzz + _HEIGHT_M2 + extra)


def duplicates(things: Things, changed: Mapping[str, Thing]) -> list[tuple[Thing, Thing]]:
    """Pairs that are one thing seen as two: (the one to keep, the one to give up). One of each has changed, by id."""
    pairs: list[tuple[Thing, Thing]] = []
    gone: set[str] = set()
    for thing in changed.values():
        if thing.id in gone or thing.id not in things.by_id:
            continue
        x, y, id = thing.x, thing.y, thing.id
        apart = thing.distinct if thing.shape.kind == "pickup" else ()
        for other in things.near(x, y, _MERGE_M):
            dx, dy = x - other.x, y - other.y
            apart_m2 = dx * dx + dy * dy
            if apart_m2 > _MERGE_M2:  # most of them
                continue
            if other.id in apart or other is thing or (other.id <= id and other.id in changed):
                continue
            if other.id in gone or not _one(thing, other, apart_m2):
                continue
            keep, drop = (thing, other) if _rank(thing) >= _rank(other) else (other, thing)
            pairs.append((keep, drop))
            gone.add(drop.id)
            if drop is thing:
                break
    return pairs


def _rank(thing: Thing) -> tuple[bool, bool, int, str]:
    return (thing.handled_s > 0.0, thing.verified, thing.hits, thing.id)


def _one(a: Thing, b: Thing, apart_m2: float) -> bool:
    if _same_floor(a, b, apart_m2):
        return True
    if b.id in a.distinct:
        return False
    penalty = type_penalty(a, b.type)
    if penalty >= GATE or a.locked or b.locked or a.receptacle == b.id or b.receptacle == a.id:
        return False
    if _seen_together(a, b):
        a.distinct.add(b.id)
        b.distinct.add(a.id)
        return False
    dx, dy, dz = a.x - b.x, a.y - b.y, a.z - b.z
    extra = a.shape.gate_m2
    sxx, sxy, syy = a.xx + b.xx + extra, a.xy + b.xy, a.yy + b.yy + extra
    plane = (syy * dx * dx - 2.0 * sxy * dx * dy + sxx * dy * dy) / (sxx * syy - sxy * sxy)
    return plane + dz * dz / (a.zz + b.zz + _HEIGHT_M2 + extra) + penalty < _MERGE_GATE


def _same_floor(a: Thing, b: Thing, apart_m2: float) -> bool:
    """Two pieces of furniture cannot stand in one place: one of them is the other, taken for another type."""
    if a.type == b.type or a.shape.kind == "pickup" or b.shape.kind == "pickup":
        return False
    if apart_m2 >= (_OVERLAP * min(a.shape.half_diagonal_m, b.shape.half_diagonal_m)) ** 2:
        return False
    return max(a.z - a.shape.height_m / 2.0, b.z - b.shape.height_m / 2.0) <= _STANDS_M


def _seen_together(a: Thing, b: Thing) -> bool:
    return any(
        sight.stamp_s == other.stamp_s
        for source, sight in a.sights.items()
        if (other := b.sights.get(source)) is not None
    )
