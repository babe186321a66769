"""Clauses that leave something to the clause before them ("... and then the microwave"), or say it apart."""

from dataclasses import replace

from planners.scripted.syntax import Act, Group, Groups, Item, Place, Rooms, Unclear

SWITCHING = ("turn", "switch", "power")


def with_verb(item: Item, before: Item | None) -> Item:
    """The item with the verb of the one before it, where it has none and "then" joins it. Raises Unclear otherwise."""
    acts = [act for stage in item.stages for act in stage]
    if all(act.verb != "elided" for act in acts):
        return item
    last = before.stages[-1][-1] if before is not None and len(before.stages) == 1 else None
    filled = _same_deed(acts[0], last) if last is not None and item.joint == "SEPTHEN" and len(acts) == 1 else None
    if filled is None:
        act = next(act for act in acts if act.verb == "elided")
        raise Unclear(f"what should be done with '{act.text}'?", act.text, question=True)
    return replace(item, stages=((filled,),))


def _same_deed(act: Act, before: Act) -> Act | None:
    """What the clause before asks for, asked of other things."""
    if act.forbidden or before.forbidden or act.apart:
        return None
    words, state = before.word, before.state
    if before.verb == "be" and before.word in SWITCHING and len(before.bodies) == 1:
        state = before.bodies[0].state
    text = f"{words} {state} {act.text}" if words in SWITCHING else f"{words} {act.text}"
    if before.verb in ("go", "above", "chart"):
        stops = act.stops or (act.groups.members if act.groups is not None and not act.groups.excepted else ())
        return replace(before, stops=stops, apart=(), text=text) if stops else None
    if act.groups is None:
        return None
    if before.verb in ("put", "take", "change", "find"):
        return replace(before, groups=act.groups, apart=(), text=text)
    if before.verb == "be" and words in SWITCHING and state is not None:
        return replace(before, verb="change", state=state, groups=act.groups, bodies=(), apart=(), text=text)
    return None


def with_exceptions(act: Act) -> Act:
    """The exceptions that stand before or after a clause given to its list. Raises Unclear where there is none."""
    if not act.apart or act.verb in ("go", "survey", "above", "chart"):
        return act
    if act.groups is not None and not act.groups.excepted:
        return replace(act, groups=replace(act.groups, excepted=act.apart), apart=())
    if len(act.bodies) == 1 and not act.bodies[0].groups.excepted:
        body = act.bodies[0]
        excepted = replace(body, groups=replace(body.groups, excepted=act.apart))
        return replace(act, bodies=(excepted,), apart=())
    text = " and ".join(exception.text for exception in act.apart)
    raise Unclear(f"from what is '{text}' excepted? Say it after the list that it belongs to", text, question=True)


def stops_without(act: Act) -> tuple[tuple[Rooms, ...], Groups | None, Rooms | None]:
    """Of a clause of going: rooms, things, and rooms that are left out."""
    rooms = tuple(stop for stop in act.stops if isinstance(stop, Rooms))
    things = tuple(stop for stop in act.stops if isinstance(stop, Group))
    out = act.apart[0] if act.apart else None
    if isinstance(out, Place) and isinstance(out.what, Rooms) and not things:
        return rooms, None, out.what
    if out is not None and (rooms or not things):
        raise Unclear(f"from what is '{out.text}' excepted?", out.text, question=True)
    return rooms, Groups(act.text, things, act.apart) if things else None, None
