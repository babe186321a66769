"""The parse tree's nodes as the values of `syntax`."""

from dataclasses import replace
from typing import Any, cast

from lark import Token, Transformer, v_args

from planners.scripted.lexicon import Word
from planners.scripted.states import STATES, adjective
from planners.scripted.syntax import (
    Act,
    Body,
    Group,
    Groups,
    Item,
    LeftOut,
    Phrase,
    Place,
    Quant,
    Rooms,
    State,
    Thing,
)

Children = list[Any]


def _word(token: Token) -> Word:
    return cast(Word, token.value)


def _of(children: Children, kind: type[Any]) -> list[Any]:
    return [child for child in children if isinstance(child, kind)]


def _types(children: Children) -> list[str]:
    return [child.type for child in children if isinstance(child, Token)]


def _apart(children: Children) -> tuple[LeftOut, ...]:
    """The exceptions among the children."""
    return next(iter(_of(children, tuple)), ())


@v_args(meta=True)
class Builder(Transformer[Token, Any]):
    """One method for each alternative of the grammar."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self._text = text

    def _span(self, meta: Any) -> str:
        return "" if meta.empty else self._text[meta.start_pos : meta.end_pos]

    # Nouns

    def quant(self, meta: Any, children: Children) -> tuple[Quant, int, str]:
        numbers = [int(_word(t).meaning.base) if t.type == "NUM" else 0 for t in children]
        count = max(numbers, default=0)
        kinds = _types(children)
        text = self._span(meta)
        bases = [_word(t).meaning.base for t in children]
        if "ALL" in kinds:
            return ("count", count, text) if count else ("all", 1, text)
        if "BOTH" in kinds:
            return "both", 2, text
        if count:
            return "count", count, text
        return ("any" if bases == ["any"] else "a" if bases in (["a"], ["an"]) else "the"), 1, text

    def simple(self, meta: Any, children: Children) -> Thing:
        (token,) = children
        meaning = _word(token).meaning
        if token.type == "ID":
            return Thing(self._span(meta), "id", types=meaning.types, id=meaning.ids[0])
        if token.type == "ONES":
            return Thing(self._span(meta), "one", plural=_word(token).text.lower() == "ones")
        return Thing(self._span(meta), "noun", types=meaning.types, plural=meaning.plural)

    def compound(self, meta: Any, children: Children) -> Thing:
        room, noun = children
        return replace(self.simple(meta, [noun]), text=self._span(meta), room_choice=_word(room).meaning.ids)

    def noun_phrase(self, meta: Any, children: Children) -> Thing:
        thing: Thing = children[-1]
        states = tuple(STATES[adjective(_word(t))] for t in _of(children, Token) if t.type == "ADJ")
        for quant, count, _ in _of(children, tuple):
            thing = replace(thing, quant=quant, count=count)
        return replace(thing, text=self._span(meta), states=states)

    def none_phrase(self, meta: Any, children: Children) -> Thing:
        return replace(self.noun_phrase(meta, children), quant="none")

    def pronoun(self, meta: Any, children: Children) -> Thing:
        return Thing(self._span(meta), "it" if children[0].type == "IT" else "them")

    def everything(self, meta: Any, children: Children) -> Thing:
        return Thing(self._span(meta), "everything", quant="all", plural=True)

    def nothing(self, meta: Any, children: Children) -> Thing:
        return Thing(self._span(meta), "everything", quant="none", plural=True)

    # Places

    def room(self, meta: Any, children: Children) -> tuple[tuple[str, ...], bool]:
        meaning = _word(children[-1]).meaning
        quant, count = children[0][:2] if len(children) > 1 else ("bare", 1)
        if quant in ("count", "both"):
            return meaning.ids, count == len(meaning.ids)
        return meaning.ids, meaning.plural or quant == "all"

    def rooms(self, meta: Any, children: Children) -> Rooms:
        rooms = _of(children, tuple)
        return Rooms(self._span(meta), tuple(ids for ids, _ in rooms), tuple(every for _, every in rooms))

    def preposition(self, meta: Any, children: Children) -> str:
        return str(children[0].type)

    def in_rooms(self, meta: Any, children: Children) -> Place:
        return Place(self._span(meta), children[0], children[1])

    at_thing = in_rooms

    def there(self, meta: Any, children: Children) -> Place:
        return Place(self._span(meta), children[0] if not isinstance(children[0], Token) else "IN", "there")

    def anywhere(self, meta: Any, children: Children) -> Place:
        return Place(self._span(meta), "IN", "anywhere")

    def related(self, meta: Any, children: Children) -> Place | State:
        told: Place | State = children[-1]
        return replace(told, related=True) if isinstance(told, Place) else told

    def group(self, meta: Any, children: Children) -> Group:
        thing: Thing = children[0]
        states = tuple(child for child in children[1:] if isinstance(child, str))
        thing = replace(thing, states=thing.states + cast("tuple[State, ...]", states))
        return Group(self._span(meta), thing, tuple(_of(children[1:], Place)))

    def excepted(self, meta: Any, children: Children) -> tuple[Group | Place, ...]:
        return tuple(child for child in children if isinstance(child, Group | Place))

    def groups(self, meta: Any, children: Children) -> Groups:
        excepted = next(iter(_of(children, tuple)), ())
        return Groups(self._span(meta), tuple(_of(children, Group)), excepted)

    # States

    def plain(self, meta: Any, children: Children) -> State:
        return STATES[children[0].type]

    def kept(self, meta: Any, children: Children) -> State:
        first = children[0]
        return STATES[first.type] if isinstance(first, Token) else cast(State, first)

    def particle(self, meta: Any, children: Children) -> State:
        return STATES[children[0].type]

    def state(self, meta: Any, children: Children) -> State | tuple[Place, ...]:
        places = tuple(_of(children, Place))
        return places or cast(State, children[0])

    def body(self, meta: Any, children: Children) -> Body:
        state = children[-1]
        places = state if isinstance(state, tuple) else ()
        plain = None if isinstance(state, tuple) else state
        return Body(self._span(meta), children[0], plain, places, "NOT" in _types(children))

    def turned(self, meta: Any, children: Children) -> Body:
        groups, particle, *places = children
        return Body(self._span(meta), groups, particle, tuple(places))

    # Clauses

    def _act(self, meta: Any, verb: str, children: Children, **more: Any) -> Act:
        tokens = _of(children, Token)
        groups = _of(children, Groups)
        word = _word(tokens[0]).meaning.base if tokens else ""
        return Act(self._span(meta), verb, word, groups[0] if groups else None, **more)

    def transport(self, meta: Any, children: Children) -> Act:
        kind = children[0].type
        return self._act(
            meta, "put" if kind == "PUT" else "take", children, away="AWAY" in _types(children), apart=_apart(children)
        )

    def discard(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "put", children, away=True)

    def change(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "change", children, state=STATES.get(children[0].type))

    def turn(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "change", children, state=children[1])

    def turn_each(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "be", children, bodies=tuple(_of(children, Body)), apart=_apart(children))

    ensure = should = turn_each

    def elided(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "elided", children, stops=tuple(_of(children, Rooms)))

    def check(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "check", children)

    def touch(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "touch", children)

    def find(self, meta: Any, children: Children) -> Act:
        return self._act(meta, "find", children)

    def go(self, meta: Any, children: Children) -> Act:
        stops = [child for child in children if isinstance(child, Rooms | Group)]
        return self._act(meta, "go", children, stops=tuple(stops), apart=_apart(children))

    def above(self, meta: Any, children: Children) -> Act:
        everywhere = "house" in children
        return replace(self.go(meta, children), verb="above", everywhere=everywhere)

    def chart(self, meta: Any, children: Children) -> Act:
        return replace(self.above(meta, children), verb="chart")

    def left_out(self, meta: Any, children: Children) -> tuple[LeftOut]:
        what = children[-1]
        return (Place(what.text, "IN", what) if isinstance(what, Rooms) else what,)

    def house(self, meta: Any, children: Children) -> str:
        return "house"

    def survey(self, meta: Any, children: Children) -> Act:
        everywhere = "house" in children
        return self._act(meta, "survey", children, apart=_apart(children), everywhere=everywhere)

    def go_find(self, meta: Any, children: Children) -> Act:
        rooms = _of(children, Rooms)[0]
        act = self._act(meta, "find", children)
        place = Place(rooms.text, "IN", rooms)
        members = tuple(replace(g, places=(*g.places, place)) for g in act.groups.members) if act.groups else ()
        return replace(act, groups=Groups(act.text, members))

    def leave(self, meta: Any, children: Children) -> Act:
        states = [child for child in children if isinstance(child, str) and not isinstance(child, Token)]
        return self._act(meta, "leave", children, state=states[0] if states else None, apart=_apart(children))

    def demand(self, meta: Any, children: Children) -> Act:
        return cast(Act, children[0])

    def forbid(self, meta: Any, children: Children) -> Act:
        act: Act = children[-1]
        return replace(act, forbidden=True, text=self._span(meta))

    # Order

    def before(self, meta: Any, children: Children) -> Phrase:
        early, _, late = children
        return Item(self._span(meta), "", "", ((early,), (late,)), trailing=True)

    def after(self, meta: Any, children: Children) -> Phrase:
        late, _, early = children
        return Item(self._span(meta), "", "", ((early,), (late,)), trailing=True, late_first=True)

    def set_apart(self, meta: Any, children: Children) -> Item:
        out = next((Place(r.text, "IN", r) for r in _of(children, Rooms)), None)
        act = replace(children[-1], apart=(out,) if out is not None else children[0], text=self._span(meta))
        return Item(act.text, "", "", ((act,),), apart=True)

    def first_last(self, meta: Any, children: Children) -> Item:
        acts = _of(children, Act)
        return Item(self._span(meta), "", "", ((acts[-1],), tuple(acts[:-1])), late_first=True, fronted=True)

    def first_then(self, meta: Any, children: Children) -> Item:
        acts = _of(children, Act)
        return Item(self._span(meta), "", "", (tuple(acts[:-1]), (acts[-1],)), fronted=True)

    def item(self, meta: Any, children: Children) -> Item:
        timed = next(child for child in children if isinstance(child, Act | Item))
        item = timed if isinstance(timed, Item) else Item(timed.text, "", "", ((timed,),))
        return replace(item, first="FIRST" in _types(children))

    def joint(self, meta: Any, children: Children) -> tuple[str, str]:
        return children[0].type, _word(children[0]).meaning.base

    def start(self, meta: Any, children: Children) -> tuple[Item, ...]:
        items: list[Item] = []
        joint: tuple[Any, str] = ("", "")
        for child in children:
            if isinstance(child, Item):
                items.append(replace(child, joint=joint[0], joint_text=joint[1]))
            else:
                joint = child
        return tuple(items)
