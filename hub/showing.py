"""From the hub's own records to the wire's models, at the rate of changes rather than of observations."""

from math import exp

from hub.records import Thing
from wire.messages.world import ObjectState, PropertyState

SHOWN_BELIEF = 0.4
"""Log-odds from which on a thing is told to others."""
_MOVED_M = 0.03
_STAMP_S = 2.0
_MAYBE = 0.15
"""Part of the votes from which on another type is worth a mention."""


def confidence(thing: Thing, now_s: float) -> float:
    """Belief that it is still there, fading with age unless it is held or shut in."""
    likely = 1.0 / (1.0 + exp(-thing.belief))
    if thing.locked:
        return likely
    age_s = now_s - thing.stamp_s
    return likely * 0.5 ** (age_s / thing.shape.half_life_s) if age_s > 1.0 else likely


def due(thing: Thing, now_s: float) -> bool:
    """Whether a reader should hear of a thing again."""
    if thing.shown < 0:
        return thing.belief > SHOWN_BELIEF
    return (
        thing.version != thing.shown
        or thing.stamp_s - thing.shown_stamp_s > _STAMP_S
        or abs(thing.x - thing.shown_x) + abs(thing.y - thing.shown_y) > _MOVED_M
        or abs(thing.z - thing.shown_z) > _MOVED_M
        or abs(confidence(thing, now_s) - thing.shown_confidence) > 0.05
    )


def show(thing: Thing, now_s: float) -> ObjectState:
    """The wire's view of a thing; remembers that it was shown."""
    sure = confidence(thing, now_s)
    thing.shown, thing.shown_confidence, thing.shown_stamp_s = thing.version, sure, thing.stamp_s
    thing.shown_x, thing.shown_y, thing.shown_z = thing.x, thing.y, thing.z
    return state(thing, now_s)


def state(thing: Thing, now_s: float) -> ObjectState:
    """Equation 3."""
    props = {
        name: PropertyState(
            value=fact.value,
            confidence=round(fact.confidence, 3),
            source=fact.source,
            stamp_s=fact.stamp_s,
            contradicted_by=fact.contradicted_by,
        )
        for name, fact in sorted(thing.facts.items())
        if fact.value is not None
    }
    return ObjectState(
        id=thing.id,
        type=thing.type,
        position_enu_m=(round(thing.x, 3), round(thing.y, 3), round(thing.z, 3)),
        covariance_m2=(thing.xx, thing.xy, thing.yy, thing.zz),
        receptacle=thing.receptacle,
        props=props,
        room=thing.room,
        source=thing.last_source,
        stamp_s=thing.stamp_s,
        confidence=round(confidence(thing, now_s), 3),
        seen_by=tuple(sorted(source for source, sight in thing.sights.items() if sight.hits)),
        verified=thing.verified,
        maybe=_maybe(thing),
        seen_from_above=thing.from_above,
        looked_into=thing.looked_into,
    )


def _maybe(thing: Thing) -> dict[str, float]:
    total = sum(thing.votes.values())
    shares = {type: votes / total for type, votes in sorted(thing.votes.items()) if type != thing.type}
    return {type: round(share, 2) for type, share in shares.items() if share >= _MAYBE}
