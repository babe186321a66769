"""Where is it believed to be, who said so, when, how sure, and who says otherwise."""

import re

from hub.containment import hidden
from hub.records import Fact, Thing
from hub.showing import confidence, state
from hub.world import World
from wire.messages.operator import Claim, WhyEntry, WhyReply

_MOST = 12


def why(world: World, words: str, now_s: float) -> WhyReply:
    """Answer for an id or for words such as "mug in the kitchen"."""
    things = find(world, words)
    entries = tuple(WhyEntry(state=state(t, now_s), claims=tuple(claims(world, t, now_s))[:64]) for t in things[:_MOST])
    if not things:
        known = sorted({t.type for t in world.things if t.shown >= 0})
        text = f"nothing known of '{words}'; known are {', '.join(known) if known else 'no objects yet'}"
    else:
        text = "\n".join(tell(world, t, now_s) for t in things[:_MOST])
    return WhyReply(now_s=now_s, entries=entries, text=text[:2000])


def find(world: World, words: str) -> list[Thing]:
    """Things meant by an id, or by a type and perhaps a room."""
    asked = words.strip().lower()
    exact = world.things.get(asked)
    if exact is not None:
        return [exact]
    plain = " " + re.sub(r"[^a-z0-9]+", " ", asked) + " "
    rooms = [id for id in world.floor.polygons if f" {id.replace('-', ' ')} " in plain]
    found = [t for t in world.things if t.shown >= 0 and _named(t.type, plain)]
    if rooms:
        found = [t for t in found if t.room in rooms]
    return sorted(found, key=lambda t: t.id)


def _named(type: str, plain: str) -> bool:
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type).lower()
    return any(f" {name}{end} " in plain for name in {spaced, type.lower()} for end in ("", "s", "es"))


def tell(world: World, thing: Thing, now_s: float) -> str:
    """One sentence."""
    holder = world.things.get(thing.receptacle)
    if thing.receptacle in world.fleet.robots:
        place = f"in the hand of {thing.receptacle}"
    elif holder is not None:
        place = f"in or on {holder.type} {holder.id}" + (", which is closed" if hidden(thing, world.things) else "")
    else:
        place = f"at ({thing.x:.2f}, {thing.y:.2f}, {thing.z:.2f}) m"
    age_s = max(now_s - thing.stamp_s, 0.0)
    sure = round(100.0 * confidence(thing, now_s))
    return (
        f"{thing.type} {thing.id}: {place}, in {thing.room or 'no room'}, "
        f"{sure} % sure, last seen {age_s:.0f} s ago by {thing.last_source}"
    )


def claims(world: World, thing: Thing, now_s: float) -> list[Claim]:
    """Every source's word on the thing, newest first."""
    said = [
        Claim(
            source=source,
            stamp_s=max(sight.stamp_s, sight.absent_s, 0.0),
            confidence=min(max(sight.confidence, 0.0), 1.0),
            text=f"saw it {sight.hits} times" if sight.support > 0.0 else "looked and did not see it",
            contradicts=sight.support < 0.0,
        )
        for source, sight in thing.sights.items()
    ]
    for name, fact in sorted(thing.facts.items()):
        said += _fact_claims(name, fact)
    return sorted(said, key=lambda c: (-c.stamp_s, c.source, c.text))


def _fact_claims(name: str, fact: Fact) -> list[Claim]:
    return [
        Claim(
            source=source,
            stamp_s=said.stamp_s,
            confidence=max(said.probability, 1.0 - said.probability),
            text=f"{'made' if said.handled else 'saw'} {name} {'true' if said.probability > 0.5 else 'false'}",
            contradicts=fact.value is not None and (said.probability > 0.5) != fact.value,
        )
        for source, said in fact.claims.items()
    ]
