"""Where is it believed to be, who said so, when, how sure, and who says otherwise. Takes the words that tasks take."""

import re
from difflib import get_close_matches
from math import exp

from hub.containment import hidden
from hub.fleet import Robot
from hub.records import Fact, Thing
from hub.showing import confidence, state
from hub.world import World
from wire.catalogue import catalogue
from wire.messages.operator import Claim, WhyEntry, WhyReply
from wire.names import classes, names_of, plural, room_names, spaced

_MOST = 12
_LONGEST_PHRASE = 4
_ALIKE = 0.75
"""From this likeness on, a name may be a misspelling of another."""


def why(world: World, words: str, now_s: float) -> WhyReply:
    """Answer for an id or for words such as "mug in the kitchen"."""
    flyer = world.fleet.robots.get(words.strip().lower())
    if flyer is not None and (flyer.flies or flyer.airborne):
        return WhyReply(now_s=now_s, text=tell_flyer(world, flyer, now_s), robot=flyer.id)
    things = find(world, words)
    entries = tuple(
        WhyEntry(state=state(t, now_s), claims=tuple(claims(world, t, now_s))[:64], text=tell(world, t, now_s))
        for t in things[:_MOST]
    )
    text = "\n".join(entry.text for entry in entries) if entries else _nothing(world, words)
    return WhyReply(now_s=now_s, entries=entries, more=max(len(things) - _MOST, 0), text=text[:2000])


def find(world: World, words: str) -> list[Thing]:
    """Things meant by an id, by a type and perhaps a room, or all that are in a room."""
    exact = world.things.get(words.strip().lower())
    if exact is not None:
        return [exact]
    types, rooms = _meant(world, words)
    whole_room = bool(rooms) and words.strip().lower().removeprefix("the ") in _room_names(world)
    found = [t for t in _shown(world) if (whole_room or t.type in types) and (not rooms or t.room in rooms)]
    return sorted(found, key=lambda t: t.id)


def _shown(world: World) -> list[Thing]:
    return [t for t in world.things if t.shown >= 0]


def _meant(world: World, words: str) -> tuple[set[str], set[str]]:
    """The object types and the rooms that these words name. The longest name counts: a TV stand is no TV."""
    rooms = _room_names(world)
    nouns = {form: types for name, types in _type_names(world).items() for form in (name, plural(name))}
    types: set[str] = set()
    places: set[str] = set()
    pieces = re.findall(r"[^\W_]+", words.lower())
    while pieces:
        for size in range(min(_LONGEST_PHRASE, len(pieces)), 0, -1):
            phrase = " ".join(pieces[:size])
            if phrase in nouns or phrase in rooms:
                types |= nouns.get(phrase, set())
                places |= rooms.get(phrase, set())
                break
        del pieces[:size]
    return types, places


def _type_names(world: World) -> dict[str, set[str]]:
    """Phrase in the singular -> types."""
    named: dict[str, set[str]] = {}
    for type in {*catalogue(), *(t.type for t in world.things)}:
        for name in {*names_of(type), type.lower()}:
            named.setdefault(name, set()).add(type)
    for word, types in classes().items():
        named.setdefault(word, set()).update(types)
    return named


def _room_names(world: World) -> dict[str, set[str]]:
    named: dict[str, set[str]] = {}
    for room in world.floor.rooms:
        for name in {room.name.lower(), room.id.replace("-", " "), *room_names(room.kind)}:
            named.setdefault(name, set()).add(room.id)
    return named


def _nothing(world: World, words: str) -> str:
    """Why nothing was found: not seen, not there, or not spelled so."""
    seen = sorted({spaced(t.type) for t in _shown(world)})
    known = ", ".join(seen) or "no objects yet"
    robot = world.fleet.robots.get(words.strip().lower())
    if robot is not None:
        x_m, y_m = robot.xy
        return f"{robot.id} is a robot, at ({x_m:.2f}, {y_m:.2f}) m; `why` tells of objects, `justw view` shows robots"
    types, rooms = _meant(world, words)
    if types:
        sought = " or ".join(sorted(spaced(type) for type in types))
        return f"no {sought} is known{' in ' + ' or '.join(sorted(rooms)) if rooms else ''}; known are {known}"
    names = [*_type_names(world), *world.things.by_id]
    tried = [words.lower(), *(word for word in words.lower().split() if len(word) > 2)]
    near = next((found for text in tried if (found := get_close_matches(text, names, n=1, cutoff=_ALIKE))), None)
    if near:
        return f"nothing known of '{words}'; is {near[0]} meant?"
    return f"nothing known of '{words}'; known are {known}"


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


def tell_flyer(world: World, robot: Robot, now_s: float) -> str:
    """One sentence of what flies: where, how high, how full."""
    x, y, z = robot.position_m
    where = f"in the air, {z:.1f} m high," if robot.airborne else "on the floor"
    power = f", battery at {robot.battery:.0%}" if robot.battery is not None else ", battery not told"
    room, age_s = world.floor.room_at(x, y) or "no room", max(now_s - robot.stamp_s, 0.0)
    return f"{robot.id}: {where} at ({x:.2f}, {y:.2f}) m, in {room}{power}, {robot.status}, heard {age_s:.0f} s ago"


def claims(world: World, thing: Thing, now_s: float) -> list[Claim]:
    """Every source's word on the thing, newest first."""
    said = [
        Claim(
            source=source,
            stamp_s=max(sight.stamp_s, sight.absent_s, 0.0),
            confidence=min(max(sight.confidence, 0.0), 1.0)
            if sight.support >= 0.0
            else 1.0 / (1.0 + exp(sight.support)),
            text=f"saw it {sight.hits} times" if sight.support > 0.0 else "looked and did not see it",
            contradicts=sight.support < 0.0,
        )
        for source, sight in thing.sights.items()
    ]
    for name, fact in sorted(thing.facts.items()):
        said += _fact_claims(name, fact)
    return sorted(said, key=lambda c: (-c.stamp_s, c.source, c.text))


def _fact_claims(name: str, fact: Fact) -> list[Claim]:
    """Who had said otherwise before a robot changed it does not contradict."""
    made_s = max(
        (c.stamp_s for c in fact.claims.values() if c.handled and (c.probability > 0.5) == fact.value), default=0.0
    )
    said_so = []
    for source, said in fact.claims.items():
        value = said.probability > 0.5
        differs = fact.value is not None and value != fact.value
        said_so.append(
            Claim(
                source=source,
                stamp_s=said.stamp_s,
                confidence=max(said.probability, 1.0 - said.probability),
                text=f"{'made' if said.handled else 'saw'} {name} {'true' if value else 'false'}"
                + (", before it was changed" if differs and said.stamp_s < made_s else ""),
                contradicts=differs and said.stamp_s >= made_s,
            )
        )
    return said_so
