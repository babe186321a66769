"""Goals that do not hold yet, as jobs: what to do with which thing, what to open for it, what to look for.

For each goal the things it means are sorted into those of which it holds (looked at first when only a weak belief says
so), those to act on, and those still unknown, which are searched for. Things that are opened on the way are closed
again unless they should stay open.
"""

from collections.abc import Sequence

from planners.tasks.belief import Belief
from planners.tasks.handling import Handling
from planners.tasks.overhead import OVERHEAD, check_able, over_room, over_thing
from planners.tasks.places import holder_types
from planners.tasks.search import Search, Wanted
from planners.tasks.settle import MOVES
from planners.tasks.work import Impossible, Job
from wire.goals import ROOM_GOALS, holds, of_room
from wire.messages.goal import Goal
from wire.messages.world import ObjectState

ACTION_ON = frozenset({"open", "closed", "on", "off", "clean", "sliced"})
SWITCHED = frozenset({"open", "closed", "on", "off"})


class Decomposition:
    """The jobs of one plan."""

    def __init__(self, goals: Sequence[Goal], belief: Belief, search: Search) -> None:
        self._goals, self._belief, self._search = goals, belief, search
        self._handling = Handling(goals, belief)
        self._wanted: list[Wanted] = []
        self._pending: set[int] = set()
        """Goals of which something is left for a later plan."""
        self._taken: dict[str, int] = {}
        """Things that a transport goal has claimed."""
        self.hopeless: list[str] = []

    @property
    def complete(self) -> bool:
        return not self._pending and not self.hopeless

    def jobs(self) -> list[Job]:
        """All jobs, each goal's after those of the goals before it."""
        self._claim()
        for index, goal in enumerate(self._goals):
            if goal.forbidden:
                continue
            if any(self._unreached(i) for i in goal.after):
                self._pending.add(index)
                continue
            try:
                self._plan_goal(index, goal)
            except Impossible as reason:
                self.hopeless.append(str(reason))
                self._pending.add(index)
        searches, in_vain = self._search.jobs(self._wanted)
        self.hopeless += in_vain
        self._handling.finish(tidy=not searches)
        return self._handling.jobs + searches

    def _unreached(self, index: int) -> bool:
        """An earlier goal that this plan does not reach: what comes after it must wait for another plan."""
        if index in self._pending:
            return True
        known = any(job.goal == index for job in self._handling.jobs)
        return not known and not holds(self._goals[index], self._belief.world)

    def _claim(self) -> None:
        """Things that a goal names by id, or that are where it wants them already, are not taken for another one."""
        moves = [(i, goal) for i, goal in enumerate(self._goals) if goal.predicate in MOVES and not goal.forbidden]
        for index, goal in moves:
            if goal.subject.id is not None:
                self._taken.setdefault(goal.subject.id, index)
        for index, goal in moves:
            good = [o for o in self._belief.matching(goal.subject) if self._belief.satisfies(goal, o)]
            limit = len(good) if goal.subject.count is None else goal.subject.count
            for obj in good[:limit]:
                self._taken.setdefault(obj.id, index)

    def _plan_goal(self, index: int, goal: Goal) -> None:
        if goal.predicate == "touched":
            raise Impossible("touching is not a goal")
        if goal.predicate in OVERHEAD and not holds(goal, self._belief.world):
            check_able(goal.predicate, self._belief)
        if goal.predicate in ROOM_GOALS and of_room(goal.subject):
            if not holds(goal, self._belief.world):
                self._handling.add(self._over(index, goal))
            return
        things = [o for o in self._belief.matching(goal.subject) if self._may_take(index, goal, o)]
        good = [o for o in things if self._belief.satisfies(goal, o)]
        rest = [o for o in things if not self._belief.satisfies(goal, o)]
        doubtful = self._doubtful(goal, good)
        for obj in doubtful:
            self._inspect(index, goal, obj)
        missing = len(rest) if goal.subject.count is None else goal.subject.count - len(good)
        if self._presupposed(goal, good):
            others = [o for o in rest if self._belief.there(o)]
            missing = max(missing, min(goal.subject.count or 0, len(others)))
            if not others and not doubtful:
                self._look_everywhere(index, goal)
        rest.sort(key=lambda o: (*self._handling.preference(goal, o), o.id))
        reasons, done = self._act(index, goal, rest, missing)
        if goal.subject.count is None:
            self._look_everywhere(index, goal)
            if reasons:
                raise Impossible(reasons[0])
        elif done < missing:
            self._want(index, goal, reasons[0] if reasons else "")

    def _over(self, index: int, goal: Goal) -> Job:
        """Through a room, or above it."""
        room = goal.subject.room or ""
        if goal.predicate in OVERHEAD:
            return over_room(goal.predicate, room, index, self._search.centre_m(room), self._belief)
        return self._search.visit(room, index)

    def _may_take(self, index: int, goal: Goal, obj: ObjectState) -> bool:
        """One thing is moved for one goal; it may be washed for another."""
        return goal.predicate not in MOVES or goal.subject.id is not None or self._taken.get(obj.id, index) == index

    def _presupposed(self, goal: Goal, good: list[ObjectState]) -> bool:
        """Who says "turn off the lamp" knows of one that is on: one that was off before is not the one that is meant."""
        loose = goal.subject.id is None and goal.subject.count is not None and goal.predicate in SWITCHED
        return loose and bool(good) and not any((o.id, goal.predicate) in self._belief.notes.changed for o in good)

    def _doubtful(self, goal: Goal, good: list[ObjectState]) -> list[ObjectState]:
        """Things left alone only because of a weak belief; with enough trusted ones none needs a look."""
        weak = [o for o in good if not self._belief.trusted(goal, o)]
        if goal.subject.count is not None:
            weak = weak[: max(goal.subject.count - (len(good) - len(weak)), 0)]
        return weak

    def _inspect(self, index: int, goal: Goal, obj: ObjectState) -> None:
        if self._belief.bans.forbids("inspect", obj) or self._belief.failures.spent("inspect", obj.id):
            return
        self._belief.look_planned(goal, obj)
        self._handling.look(index, obj)
        self._pending.add(index)

    def _act(self, index: int, goal: Goal, things: list[ObjectState], needed: int) -> tuple[list[str], int]:
        """Jobs for the first things with which it is possible; why it is not with the others, and how many there are."""
        reasons: list[str] = []
        done = 0
        for obj in things:
            if done >= needed:
                break
            try:
                if goal.predicate in MOVES:
                    if not self._handling.move(index, goal, obj):
                        self._want_holder(index, goal, obj)
                    self._taken[obj.id] = index
                elif goal.predicate in ACTION_ON:
                    self._handling.change(index, goal.predicate, obj)
                    self._belief.notes.changed.add((obj.id, goal.predicate))
                elif goal.predicate in OVERHEAD:
                    self._handling.add(over_thing(goal.predicate, obj, index, self._belief))
                else:
                    self._handling.look(index, obj)
                done += 1
            except Impossible as reason:
                reasons.append(str(reason))
        return reasons, done

    # Searching

    def _want_holder(self, index: int, goal: Goal, item: ObjectState) -> None:
        """No place is known to put it: look for one."""
        assert goal.object is not None
        types = holder_types(item.type, goal.object)
        rooms = frozenset({goal.object.room}) if goal.object.room is not None else None
        name = types[0] if goal.object.type else f"place for the {item.type}"
        self._pending.add(index)
        self._wanted.append(Wanted(types, index, rooms, name=name))

    def _want(self, index: int, goal: Goal, reason: str) -> None:
        """Look for more things of the type than are known, or than can be used (`reason`)."""
        if goal.subject.id is not None or goal.subject.type is None:
            raise Impossible(reason or f"nothing called {goal.subject.id or 'so'} is known")
        rooms = frozenset({goal.subject.room}) if goal.subject.room is not None else None
        self._pending.add(index)
        self._wanted.append(Wanted((goal.subject.type,), index, rooms, name=goal.subject.type, reason=reason))
        self._want_missing_holder(index, goal)

    def _want_missing_holder(self, index: int, goal: Goal) -> None:
        """While the item is looked for, a receptacle that is not known either is looked for too."""
        target = goal.object
        if target is None or target.type is None or self._belief.matching(target):
            return
        rooms = frozenset({target.room}) if target.room is not None else None
        self._wanted.append(Wanted((target.type,), index, rooms, name=target.type))

    def _look_everywhere(self, index: int, goal: Goal) -> None:
        """Every one that there is: rooms nobody has gone through may hold more of them."""
        if goal.subject.id is not None or goal.subject.type is None:
            return
        rooms = frozenset({goal.subject.room}) if goal.subject.room is not None else None
        want = Wanted((goal.subject.type,), index, rooms, every=True, name=goal.subject.type)
        if self._search.open_for(want):
            self._pending.add(index)
            self._wanted.append(want)
