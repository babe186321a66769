"""Clauses that can mean two things, or more than a goal says: asked about, refused, or put another way."""

from dataclasses import replace

from planners.scripted.resolve import share
from planners.scripted.syntax import Act, Body, Group, Groups, Thing, Unclear

BASINS = frozenset({"Sink", "SinkBasin", "Bathtub", "BathtubBasin"})


def groups_of(act: Act) -> Groups:
    """The list of a clause that has one by its grammar."""
    assert act.groups is not None
    return act.groups


def each(member: Group) -> Group:
    """What may be done to no one thing of a kind may not be done to any."""
    thing = member.thing
    return replace(member, thing=replace(thing, quant="all")) if thing.quant == "any" else member


def of_none(body: Body) -> Body:
    """ "No lamp is on" is "every lamp is not on"."""
    heads = share(body.groups.members)
    if all(member.thing.quant != "none" for member in heads):
        return body
    if any(member.thing.quant != "none" for member in heads):
        raise Unclear(f"say each in a clause of its own: '{body.groups.text}'", body.text)
    members = tuple(replace(member, thing=replace(member.thing, quant="all")) for member in heads)
    return replace(body, groups=replace(body.groups, members=members), negated=not body.negated)


def check_washing(act: Act) -> None:
    """ "Wash the mug in the sink": the mug that is there, or the place to do it?"""
    if act.verb != "change" or act.state != "clean":
        return
    for member in groups_of(act).members:
        for place in member.places:
            where = place.what.types if isinstance(place.what, Thing) else ()
            if place.preposition in ("IN", "ON") and not place.related and set(where) & BASINS:
                thing = member.thing.text
                asked = f"is '{place.text}' where '{thing}' is, or where to do it? Say 'from' instead of 'in', "
                raise Unclear(asked + f"or leave out '{place.text}'", place.text, question=True)


def check_restraint(act: Act) -> None:
    """Refuse what a restraint cannot say: it holds of all things that it names, at any time."""
    groups = [g for g in (act.groups, *(body.groups for body in act.bodies)) if g is not None]
    if act.apart or any(g.excepted for g in groups):
        raise Unclear("a restraint with an exception is not understood", act.text)
    for member in (member for g in groups for member in g.members):
        if member.thing.quant in ("count", "both"):
            raise Unclear("a restraint with a number is not understood", member.thing.text)
        if member.thing.quant == "all":
            asked = f"is none of them meant by 'not ... {member.thing.text}', or not all of them?"
            raise Unclear(asked, member.thing.text, question=True)
        if member.thing.quant == "none":
            raise Unclear("'not' and 'no' together are not understood", act.text)
