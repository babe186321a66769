"""The believed world, indexed for planning: what is in what, what is closed, which belief may be trusted."""

from collections.abc import Iterator
from math import inf

from planners.tasks.bans import Bans
from planners.tasks.failures import Failures
from planners.tasks.memory import Notes
from planners.tasks.travel import Travel
from wire.catalogue import PROP_FLAG, type_row
from wire.goals import object_satisfies, select
from wire.messages.goal import Goal, Selector
from wire.messages.world import AreaState, ObjectState, RobotState, WorldState
from wire.model import Vec2

SURE = 0.9
MOST_LOOKS = 4
"""Plans that send a robot to look at the same thing before it is believed without."""
UNSURE_M, UNSEEN_M, ODD_M = 20.0, 3.0, 12.0
ABLE = frozenset({"idle", "executing", "canceling", "holding"})
"""States in which a robot can be counted on."""
_PROP = {
    "open": "isOpen",
    "closed": "isOpen",
    "on": "isToggled",
    "off": "isToggled",
    "clean": "isDirty",
    "sliced": "isSliced",
}


class Belief:
    """W_t with everything that planning asks of it."""

    def __init__(self, world: WorldState, travel: Travel, bans: Bans, failures: Failures, notes: Notes) -> None:
        self.world, self.travel, self.bans, self.failures, self.notes = world, travel, bans, failures, notes
        self.objects = {obj.id: obj for obj in world.objects}
        self.areas: dict[str, AreaState] = {area.id: area for area in world.areas}
        self.robots: list[RobotState] = sorted((r for r in world.robots if r.status in ABLE), key=lambda r: r.id)
        self._robot_ids = {r.id for r in world.robots}
        self._crowd: dict[str, int] = {}
        for obj in world.objects:
            if obj.receptacle is not None:
                self._crowd[obj.receptacle] = self._crowd.get(obj.receptacle, 0) + 1

    def matching(self, selector: Selector) -> list[ObjectState]:
        """Things that a selector means, in the order of their ids."""
        return sorted(select(selector, self.world), key=lambda o: o.id)

    def satisfies(self, goal: Goal, obj: ObjectState) -> bool:
        return object_satisfies(goal, obj, self.world)

    def trusted(self, goal: Goal, obj: ObjectState) -> bool:
        """Whether it is safe to leave a thing alone because a goal is believed to hold of it already.

        A thing counts as there when it is believed with at least 0.9 or a robot has verified it, and a property as
        known when a robot was the one who saw or set it; both when a robot has been sent to look in this task. What
        only a camera says of a property is looked at first: nothing would be done about it if it were wrong.
        """
        if goal.predicate in ("found", "visited", "seen_from_above") or self._looked_at(goal, obj):
            return True
        there = self.there(obj)
        name = _PROP.get(goal.predicate)
        if name is None:
            return there
        fact = obj.props.get(name)
        return there and fact is not None and fact.source in self._robot_ids

    def there(self, obj: ObjectState) -> bool:
        """Whether it is surely there."""
        return obj.verified or obj.confidence >= SURE

    def _looked_at(self, goal: Goal, obj: ObjectState) -> bool:
        """Whether a robot that was sent has seen it; a look that plan after plan never came to is not waited for."""
        first_s, times = self.notes.sent_to_look.get((obj.id, goal.predicate), (inf, 0))
        seen = obj.source in self._robot_ids and obj.stamp_s > first_s
        return seen or times >= MOST_LOOKS

    def look_planned(self, goal: Goal, obj: ObjectState) -> None:
        """Note that a plan sends a robot to look at it."""
        first_s, times = self.notes.sent_to_look.get((obj.id, goal.predicate), (self.world.stamp_s, 0))
        self.notes.sent_to_look[obj.id, goal.predicate] = (first_s, times + 1)

    def doubt_m(self, obj: ObjectState) -> float:
        """How much farther a surer thing of the type may be: a trip to something else is in vain.

        A property that the type cannot have (a tomato that is open) tells that sources take it for different things.
        """
        flags = type_row(obj.type).flags
        odd = any(PROP_FLAG.get(name) not in flags for name in obj.props)
        return UNSURE_M * (1.0 - obj.confidence) + UNSEEN_M * (not obj.verified) + ODD_M * odd

    def held_by(self, obj: ObjectState) -> RobotState | None:
        """The robot that has it in hand."""
        return next((r for r in self.world.robots if r.id == obj.receptacle or r.inventory == obj.id), None)

    def point_m(self, obj: ObjectState) -> Vec2:
        return (obj.position_enu_m[0], obj.position_enu_m[1])

    def crowd(self, holder: str) -> int:
        """How many things are in or on it."""
        return self._crowd.get(holder, 0)

    def is_open(self, obj: ObjectState) -> bool:
        fact = obj.props.get("isOpen")
        return fact is not None and fact.value

    def is_on(self, obj: ObjectState) -> bool:
        fact = obj.props.get("isToggled")
        return fact is not None and fact.value

    def shut(self, obj: ObjectState) -> bool:
        """It must be opened before a hand gets in."""
        return type_row(obj.type).must_open and not self.is_open(obj)

    def around(self, obj: ObjectState) -> Iterator[ObjectState]:
        """What it is in or on, from the inside out."""
        seen = {obj.id}
        holder = self.objects.get(obj.receptacle or "")
        while holder is not None and holder.id not in seen:
            yield holder
            seen.add(holder.id)
            holder = self.objects.get(holder.receptacle or "")

    def closures(self, obj: ObjectState) -> list[ObjectState]:
        """Receptacles that must be open to get at it, the outermost first."""
        return [holder for holder in self.around(obj) if type_row(holder.type).must_open][::-1]

    def nearest_m(self, point_m: Vec2) -> float:
        """Metres from the nearest robot."""
        starts = ((r.position_enu_m[0], r.position_enu_m[1]) for r in self.robots)
        return min((self.travel.metres(start, point_m) for start in starts), default=0.0)
