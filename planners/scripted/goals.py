"""Clauses as goals: what should be true at the end, what is forbidden on the way, and in what order."""

from collections.abc import Sequence
from dataclasses import replace

from planners.scripted.agreement import agree
from planners.scripted.clauses import check_restraint, check_washing, each, groups_of, of_none
from planners.scripted.elision import stops_without, with_exceptions, with_verb
from planners.scripted.exceptions import leave_out
from planners.scripted.lexicon import Lexicon
from planners.scripted.parse import parse
from planners.scripted.resolve import Resolver, share
from planners.scripted.syntax import OPPOSITE, Act, Body, Groups, Item, Rooms, Unclear
from planners.scripted.texts import TEXT_LIMIT, told_apart
from planners.scripted.transports import Move, ask_where, placed, read_transport
from wire.messages.goal import Goal, Predicate, Selector
from wire.messages.world import WorldState

TAKING = ("it", "them")
STOPS = ".;!?:"
GOING = ("go", "walk", "drive", "head", "navigate", "move")
ALONE = ("explore", "look around", "have a look around", "take a look around")
"""Verbs that mean the whole building where they name no place."""


def read_goals(instruction: str, world: WorldState) -> tuple[Goal, ...]:
    """What the instruction asks for in this world. Raises Unclear when any of it is not understood."""
    reader = _Reader(world)
    items = list(parse(instruction, Lexicon(world)))
    for index, item in enumerate(items):
        items[index] = with_verb(item, items[index - 1] if index else None)
        reader.read_item(items[index], items[index + 1] if index + 1 < len(items) else None)
    return told_apart(agree(reader.finish()), {area.id: area.name for area in world.areas})


class _Reader:
    """Goes through the clauses in the order of doing and collects goals."""

    def __init__(self, world: WorldState) -> None:
        self._resolver = Resolver(world)
        self._goals: list[Goal] = []
        self._stage: list[int] = []
        self._earlier: list[int] = []
        self._pending: Move | None = None
        self._restrained: str | None = None
        self._trailing: str | None = None
        self._apart: str | None = None
        self._fronted: tuple[bool, list[int]] | None = None
        """Goals of a "before ..." or "after ..." at the head of the sentence; True where they come last."""
        self._rooms = tuple(area.id for area in world.areas)

    def finish(self) -> list[Goal]:
        if self._pending is not None:
            raise ask_where(self._pending)
        if not self._goals:
            raise Unclear("it asks for nothing to be done")
        return self._goals

    def read_item(self, item: Item, following: Item | None) -> None:
        self._check_scope(item)
        if item.joint == "SEPTHEN" and self._stage:
            self._earlier, self._stage = self._stage, []
        first_new = len(self._goals)
        said = item.stages[::-1] if item.late_first else item.stages
        new = [[i for act in acts for i in self._read_act(act, following)] for acts in said]
        if len(new) > 1:
            self._order(item, *(new[::-1] if item.late_first else new))
        done = [index for stage in new for index in stage]
        if item.first and first_new:
            self._put_after(self._stage, done)
        self._carry_on(item, new, done)
        self._stage += done
        last = item.stages[-1][-1]
        self._restrained = last.text if last.forbidden else None
        self._trailing = item.text if item.trailing else None
        self._apart = " and ".join(out.text for out in last.apart) if item.apart else None

    def _carry_on(self, item: Item, new: Sequence[list[int]], done: Sequence[int]) -> None:
        """ "Before" and "after" at the head of a sentence hold for all of its clauses."""
        if item.fronted:
            self._fronted = (item.late_first, new[0])
        elif item.joint == "SEPTHEN" or set(item.joint_text) & set(STOPS):
            self._fronted = None
        elif self._fronted is not None:
            late, bound = self._fronted
            self._put_after(*((bound, done) if late else (done, bound)))

    def _order(self, item: Item, early: Sequence[int], late: Sequence[int]) -> None:
        for acts in item.stages:
            for act in acts:
                if act.forbidden:
                    raise Unclear("a restraint holds all the time, not before or after something", act.text)
        self._put_after(late, early)

    def _put_after(self, late: Sequence[int], early: Sequence[int]) -> None:
        for index in late:
            goal = self._goals[index]
            self._goals[index] = goal.model_copy(update={"after": tuple(dict.fromkeys((*goal.after, *early)))})

    def _check_scope(self, item: Item) -> None:
        """A plain "and" after "do not ..." or "... before ..." may or may not carry that on: ask. So may anything that
        follows "except for ...," in the same sentence."""
        if self._apart and not set(item.joint_text) & set(STOPS):
            asked = f"is '{self._apart}' also excepted from '{item.text}'? Say it in a sentence of its own"
            raise Unclear(asked, item.text, question=True)
        if item.joint != "SEPAND":
            return
        if self._restrained and not item.stages[0][0].forbidden:
            asked = f"does 'not' in '{self._restrained}' also hold for '{item.text}'? Put a comma or 'but' between them"
            raise Unclear(asked, item.text, question=True)
        if self._trailing:
            raise Unclear(f"when should '{item.text}' be done? Put a comma before it", item.text, question=True)

    def _read_act(self, act: Act, following: Item | None) -> list[int]:
        if self._pending is not None and not _speaks_of_it(act):
            raise ask_where(self._pending)
        if act.verb in ("put", "take"):
            self._pending = None
        act = with_exceptions(act)
        check_washing(act)
        new = self._forbid(act) if act.forbidden else self._demand(act, following)
        start = len(self._goals)
        for goal in new:
            order = () if goal.forbidden else tuple(self._earlier)
            self._goals.append(goal.model_copy(update={"text": act.text[:TEXT_LIMIT], "after": order}))
        return [start + i for i, goal in enumerate(new) if not goal.forbidden]

    # What is asked for

    def _demand(self, act: Act, following: Item | None) -> list[Goal]:
        if act.verb in ("put", "take"):
            continued = following is not None and _speaks_of_it(following.stages[0][0])
            return self._moves(read_transport(act, self._resolver, continued))
        if act.verb == "change":
            if act.state is None:
                raise Unclear(f"should it be on or off at the end? '{act.text}'", act.text, question=True)
            return self._states(groups_of(act), act.state)  # type: ignore[arg-type]
        if act.verb == "be":
            return [goal for body in act.bodies for goal in self._body(body)]
        if act.verb == "find":
            return self._find(act)
        if act.verb == "check":
            reason = "questions are not answered: say 'make sure that ...', or ask './justw why' about the thing"
            raise Unclear(reason, act.text, final=True)
        if act.verb in ("go", "survey"):
            return self._go(act)
        if act.verb in ("above", "chart"):
            return self._over(act, "seen_from_above" if act.verb == "above" else "surveyed")
        if act.verb == "leave":
            return self._leave(act)
        raise Unclear(f"I do not know how to '{act.text}'", act.text)

    def _moves(self, moves: Sequence[Move]) -> list[Goal]:
        goals = []
        for move in moves:
            if move.to is None:
                self._pending = move
            else:
                predicate: Predicate = "in" if move.to.type else "at"
                goals += [Goal(predicate=predicate, subject=s, object=move.to) for s in move.subjects]
                goals += [Goal(predicate=predicate, subject=s, object=move.to, forbidden=True) for s in move.restrained]
        last = self._resolver.last
        last.subjects = tuple(s for move in moves for s in move.subjects)
        last.places = tuple(m.to for m in moves if m.to is not None and m.to.type)
        return goals

    def _states(self, groups: Groups, predicate: Predicate) -> list[Goal]:
        heads = share(groups.members)
        subjects = [s for member in heads for s in self._resolver.subjects(member, predicate)]
        kept, restrained = leave_out(groups, heads, subjects, predicate, self._resolver)
        self._resolver.last.subjects, self._resolver.last.places = kept, ()
        goals = [Goal(predicate=predicate, subject=s) for s in kept]
        return goals + [Goal(predicate=predicate, subject=s, forbidden=True) for s in restrained]

    def _body(self, body: Body) -> list[Goal]:
        body = of_none(body)
        if body.places and body.state is None:
            if body.negated:
                raise Unclear(f"where should it be instead? '{body.text}'", body.text, question=True)
            return self._moves([placed(body, self._resolver)])
        state = body.state
        if body.negated:
            state = OPPOSITE.get(state) if state else None  # type: ignore[assignment]
        if state is None or state in ("dirty", "alone"):
            raise Unclear(f"I cannot bring it about that '{body.text}'", body.text)
        members = tuple(replace(g, places=(*g.places, *body.places)) for g in body.groups.members)
        return self._states(replace(body.groups, members=members), state)  # type: ignore[arg-type]

    def _find(self, act: Act) -> list[Goal]:
        if act.word.split()[0] in GOING:
            raise Unclear(f"should it be found or brought? '{act.text}'", act.text, question=True)
        return self._states(groups_of(act), "found")

    def _go(self, act: Act) -> list[Goal]:
        rooms, things, out = stops_without(act)
        wanted = [r for stop in rooms for r in self._resolver.rooms(stop)]
        if act.verb == "survey":
            if act.word.split()[0] in GOING if act.everywhere else act.word not in ALONE:
                raise Unclear(f"which room is meant? '{act.text}'", act.text, question=True)
            wanted = list(self._rooms)
        spared = self._resolver.rooms(out) if out is not None else ()
        wanted = [room for room in wanted if room not in spared]
        if not wanted and things is None:
            raise Unclear("the exception leaves nothing to do", act.text)
        goals = [Goal(predicate="visited", subject=Selector(room=room)) for room in wanted]
        return goals + (self._states(things, "visited") if things is not None else [])

    def _over(self, act: Act, predicate: Predicate) -> list[Goal]:
        """From the air: which rooms are flown over, and what is looked down on."""
        rooms, things, out = stops_without(act)
        if things is not None and predicate == "surveyed":
            raise Unclear(f"rooms are surveyed, things are looked at from above: '{things.text}'", things.text)
        wanted = [r for stop in rooms for r in self._resolver.rooms(stop)]
        spared = self._resolver.rooms(out) if out is not None else ()
        wanted = [room for room in (self._rooms if act.everywhere else wanted) if room not in spared]
        if not wanted and things is None:
            raise Unclear("the exception leaves nothing to do", act.text)
        goals = [Goal(predicate=predicate, subject=Selector(room=room)) for room in wanted]
        return goals + (self._states(things, predicate) if things is not None else [])

    def _leave(self, act: Act) -> list[Goal]:
        if act.state == "alone":
            return self._restrain(groups_of(act), "touched")
        if act.state is not None:
            return self._states(groups_of(act), act.state)  # type: ignore[arg-type]
        return self._moves(read_transport(replace(act, verb="put", word="leave"), self._resolver, continued=False))

    # What is forbidden

    def _forbid(self, act: Act) -> list[Goal]:
        check_restraint(act)
        if act.verb in ("put", "take"):
            return self._forbid_moves(act)
        if act.verb == "change" and act.state is not None:
            return self._restrain(groups_of(act), act.state)  # type: ignore[arg-type]
        if act.verb == "be" and act.word in ("turn", "switch", "power"):
            return [g for b in act.bodies for g in self._restrain(b.groups, b.state)]  # type: ignore[arg-type]
        if act.verb == "touch":
            return self._restrain(groups_of(act), "touched")
        if act.verb == "go" and all(isinstance(stop, Rooms) for stop in act.stops):
            rooms = [r for stop in act.stops if isinstance(stop, Rooms) for r in self._resolver.rooms(stop)]
            return [Goal(predicate="visited", subject=Selector(room=r), forbidden=True) for r in rooms]
        if act.verb == "leave" and act.state in OPPOSITE:
            return self._states(groups_of(act), OPPOSITE[act.state])
        raise Unclear(f"I do not know how to keep to '{act.text}'", act.text)

    def _forbid_moves(self, act: Act) -> list[Goal]:
        goals = []
        for move in read_transport(act, self._resolver, continued=False):
            predicate: Predicate = "in" if not move.to or move.to.type else "at"
            for subject in move.subjects:
                every = subject.model_copy(update={"count": None})
                goals.append(Goal(predicate=predicate, subject=every, object=move.to, forbidden=True))
        return goals

    def _restrain(self, groups: Groups, predicate: Predicate) -> list[Goal]:
        members = [each(member) for member in share(groups.members)]
        subjects = [s for member in members for s in self._resolver.subjects(member, predicate)]
        self._resolver.last.subjects, self._resolver.last.places = tuple(subjects), ()
        every = [s.model_copy(update={"count": None}) for s in subjects]
        return [Goal(predicate=predicate, subject=s, forbidden=True) for s in every]


def _speaks_of_it(act: Act) -> bool:
    """The clause is about what the clause before it took."""
    members = act.groups.members if act.groups is not None else ()
    return not act.forbidden and any(g.thing.head in TAKING for g in members)
