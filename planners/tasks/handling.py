"""Jobs on known things: move them, change their state, look at them; opening and closing what is in the way."""

from collections.abc import Sequence

from planners.tasks.bans import BRINGS_ABOUT
from planners.tasks.belief import Belief
from planners.tasks.order import order_by_goals, order_by_things
from planners.tasks.places import rank, suitable, unusable
from planners.tasks.work import Impossible, Job, on
from wire.catalogue import type_row
from wire.messages.goal import Goal
from wire.messages.plan import Action
from wire.messages.world import ObjectState

ACTIONS: dict[str, Action] = {predicate: action for action, predicate in BRINGS_ABOUT.items()}
STATES, MOVES, SLICING = 0, 1, 2
BLADES = ("Knife", "ButterKnife")
FAILED_M = 40.0


class Handling:
    """Collects jobs; remembers what is opened for which of them."""

    def __init__(self, goals: Sequence[Goal], belief: Belief) -> None:
        self._goals, self._belief = goals, belief
        self.jobs: list[Job] = []
        self._openings: dict[str, int] = {}
        """Receptacle -> the job that opens it."""
        self._uses: dict[str, list[int]] = {}
        """Receptacle -> the jobs that need it open."""

    def add(self, job: Job) -> int:
        self.jobs.append(job)
        return len(self.jobs) - 1

    def preference(self, goal: Goal, obj: ObjectState) -> tuple[float, float]:
        """Lower is better: what has not failed, is within reach, near a robot, surely there and surely of its type."""
        action = "pickup" if goal.predicate in ("in", "at") else ACTIONS.get(goal.predicate, "inspect")
        failed = FAILED_M * self._belief.failures.count(action, obj.id)
        shut = 5.0 * sum(self._belief.shut(h) for h in self._belief.around(obj))
        held = -50.0 if self._belief.held_by(obj) is not None else 0.0
        way = self._belief.nearest_m(self._belief.point_m(obj))
        return (failed + shut + held + way + self._belief.doubt_m(obj), -obj.confidence)

    # The three kinds of jobs

    def look(self, goal: int, obj: ObjectState) -> None:
        """See it from near by."""
        self._check("inspect", obj)
        job = Job([on("inspect", obj)], goal)
        self._reach_into(self.add(job), 0, obj, goal)

    def change(self, goal: int, predicate: str, obj: ObjectState) -> None:
        """Make a state true of it; what must be so before that is done first."""
        action = ACTIONS[predicate]
        self._check(action, obj)
        steps = [on(before, obj) for before in self._before(action, obj)]
        if action == "slice":
            self._slice(goal, obj)
            return
        if action == "open" and obj.id in self._openings:
            self.jobs[self._openings[obj.id]].goal = goal
            return
        job = Job([*steps, on(action, obj)], goal, about=frozenset({obj.id}), rank=STATES)
        index = self.add(job)
        if action == "open":
            self._openings[obj.id] = index
        self._reach_into(index, 0, obj, goal)

    def _before(self, action: Action, obj: ObjectState) -> list[Action]:
        """A microwave that runs is switched off before it opens, and closed before it runs; a laptop is opened."""
        before: list[Action] = []
        if obj.type == "Microwave" and action == "open" and self._belief.is_on(obj):
            before = ["toggle_off"]
        elif obj.type == "Microwave" and action == "toggle_on" and self._belief.is_open(obj):
            before = ["close"]
        elif obj.type == "Laptop" and action == "toggle_on" and not self._belief.is_open(obj):
            before = ["open"]
        for step in before:
            self._check(step, obj)
        return before

    def _slice(self, goal: int, obj: ObjectState) -> None:
        """A knife in the hand, and put back after it."""
        knives = [o for o in self._belief.world.objects if o.type in BLADES and not self._refused("pickup", o)]
        if not knives:
            raise Impossible(f"no knife is known to slice the {obj.type.lower()} with")
        knife = min(knives, key=lambda k: (self._belief.travel.metres(*self._pair(k, obj)), k.id))
        holder = self._belief.held_by(knife)
        home = self._belief.objects.get(knife.receptacle or "")
        near = (o for o in self._belief.world.objects if type_row(o.type).receptacle_mode == "on")
        places = [home] if home is not None else rank(obj, near, self._belief)[:1]
        if not places:
            raise Impossible("no place is known to put the knife back")
        steps = [] if holder is not None else [on("pickup", knife)]
        steps += [on("slice", obj, knife), on("put", places[0], knife)]
        about = frozenset({obj.id, knife.id})
        job = Job(steps, goal, robot=holder.id if holder else None, about=about, rank=SLICING)
        index = self.add(job)
        for step, thing in ((0, knife), (len(steps) - 2, obj)):
            self._reach_into(index, step, thing, goal)
        self._open_for(index, len(steps) - 1, places[0], goal)

    def _pair(self, a: ObjectState, b: ObjectState) -> tuple[tuple[float, float], tuple[float, float]]:
        return self._belief.point_m(a), self._belief.point_m(b)

    def move(self, index: int, goal: Goal, item: ObjectState) -> bool:
        """Carry it to where the goal wants it; False when no such place is known yet."""
        holder = self._belief.held_by(item)
        if holder is None:
            self._check("pickup", item)
        self._check_sliced(item)
        places = suitable(item, self._belief, goal)
        if not places:
            self._check_places(goal, item)
            return False
        steps = [] if holder is not None else [on("pickup", item)]
        steps.append(on("put", places[0], item))
        job = Job(steps, index, robot=holder.id if holder else None, about=frozenset({item.id}), rank=MOVES)
        number = self.add(job)
        if holder is None:
            self._reach_into(number, 0, item, index)
        self._open_for(number, len(steps) - 1, places[0], index)
        return True

    def _check_sliced(self, item: ObjectState) -> None:
        fact = item.props.get("isSliced")
        if fact is not None and fact.value:
            raise Impossible(f"the {item.type.lower()} {item.id} has been sliced and cannot be carried whole")

    def _check_places(self, goal: Goal, item: ObjectState) -> None:
        """Known receptacles that are all of no use: say so instead of looking for more of them."""
        assert goal.object is not None
        known = self._belief.matching(goal.object) if goal.object.type or goal.object.id else []
        if known and all(area.searched for area in self._belief.world.areas):
            raise Impossible(unusable(item, known[0], self._belief))

    def put_down(self, item: ObjectState, robot: str) -> None:
        """Free a hand of what no goal asks for."""
        near = (o for o in self._belief.world.objects if type_row(o.type).receptacle_mode == "on")
        places = rank(item, near, self._belief)
        if places:
            self.add(Job([on("put", places[0], item)], None, robot=robot, about=frozenset({item.id}), rank=MOVES))

    # Opening and closing

    def _reach_into(self, job: int, step: int, obj: ObjectState, goal: int) -> None:
        for holder in self._belief.closures(obj):
            self._open_for(job, step, holder, goal)

    def _open_for(self, job: int, step: int, holder: ObjectState, goal: int) -> None:
        """A step of a job needs this receptacle, and what is around it, open."""
        for outer in self._belief.closures(holder):
            self._open_for(job, step, outer, goal)
        if not type_row(holder.type).must_open:
            return
        self._uses.setdefault(holder.id, []).append(job)
        if self._belief.is_open(holder):
            return
        if holder.id not in self._openings:
            self._check("open", holder)
            steps = [on(before, holder) for before in self._before("open", holder)]
            opening = Job([*steps, on("open", holder)], goal, about=frozenset({holder.id}), rank=STATES)
            self._openings[holder.id] = self.add(opening)
            self._belief.notes.opened.add(holder.id)
        self.jobs[job].waits.append((step, self._openings[holder.id]))

    def finish(self, tidy: bool) -> None:
        """Put things in hands down, close what was opened, and set the order among jobs."""
        self._free_hands()
        closing = {job.steps[-1].object for job in self.jobs if job.steps[-1].action == "close"}
        for id in sorted(self._belief.notes.opened):
            obj = self._belief.objects.get(id)
            if obj is None or id in closing or self._stays_open(obj):
                continue
            opens = id in self._openings
            if opens or (self._belief.is_open(obj) and (tidy or id in self._uses or id in self._belief.notes.peeked)):
                self.add(Job([on("close", obj)], None, about=frozenset({id})))
        self._close_last()
        order_by_goals(self.jobs, self._goals)
        order_by_things(self.jobs)

    def _close_last(self) -> None:
        for index, job in enumerate(self.jobs):
            if job.steps[-1].action != "close" or job.steps[-1].object is None:
                continue
            for user in self._uses.get(job.steps[-1].object, ()):
                if user != index:
                    job.waits.append((0, user))
            opening = self._openings.get(job.steps[-1].object)
            if opening is not None and opening != index:
                job.waits.append((0, opening))

    def _stays_open(self, obj: ObjectState) -> bool:
        if self._refused("close", obj):
            return True
        asked = (g for g in self._goals if g.predicate == "open" and not g.forbidden)
        return any(obj in self._belief.matching(goal.subject) for goal in asked)

    def _free_hands(self) -> None:
        moved = {thing for job in self.jobs for thing in job.about}
        for robot in self._belief.robots:
            item = self._belief.objects.get(robot.inventory or "")
            if item is not None and item.id not in moved:
                self.put_down(item, robot.id)

    # What may not or cannot be done

    def _check(self, action: Action, obj: ObjectState) -> None:
        why = self._refused(action, obj)
        if why:
            raise Impossible(why)
        for holder in self._belief.around(obj):
            if self._belief.shut(holder) and self._refused("open", holder):
                raise Impossible(f"the {obj.type.lower()} is in {holder.id}: {self._refused('open', holder)}")

    def _refused(self, action: Action, obj: ObjectState) -> str:
        if self._belief.bans.forbids(action, obj):
            return f"it is forbidden to {action.replace('_', ' ')} {obj.id}"
        if self._belief.failures.spent(action, obj.id):
            return self._belief.failures.last(obj.id)
        return ""
