"""Which changes of W matter to the running plan: only those that touch what it still has to do."""

from hub.containment import hidden
from hub.effects import CHANGES
from hub.plan import PlanRun, Step
from hub.records import Thing
from hub.world import World

_MOVED_M = 0.8
_SURE = 0.85
_FOUND = 0.55


class Watch:
    """What the plan was made on, to be compared with what comes to be believed."""

    def __init__(self, run: PlanRun, world: World) -> None:
        self._run, self._world = run, world
        self._made_on: dict[str, tuple[float, float, str | None, str | None, bool]] = {}
        self._values: dict[tuple[str, str], bool | None] = {}
        looked_for = {type for step in run.steps.values() for type in step.node.looking_for}
        self._known = frozenset(t.id for t in world.things if t.type in looked_for)
        for step in run.steps.values():
            self.refresh(step)

    def refresh(self, step: Step) -> None:
        """Take a step's things as they are now for granted: our own robots have just changed them."""
        for id in (step.node.object, step.node.item):
            thing = self._world.things.get(id)
            if thing is not None:
                shut = hidden(thing, self._world.things)
                self._made_on[thing.id] = (thing.x, thing.y, thing.receptacle, thing.room, shut)
        if step.node.action in CHANGES and step.node.object is not None:
            name = CHANGES[step.node.action][0]
            self._values[(step.node.object, name)] = self._value(step.node.object, name)

    def relevant(self, changed: list[str]) -> str | None:
        """Why the plan no longer suits, given the ids of things that changed or went; None while it does."""
        touched = set(changed)
        open_steps = [s for s in self._run.steps.values() if s.status in ("pending", "running")]
        wanted = {type for step in open_steps for type in step.node.looking_for}
        if wanted:
            found = self._found(touched, wanted)
            if found is not None:
                return f"found: {found.type} {found.id} in {found.room}"
        for step in open_steps:
            for id in (step.node.object, step.node.item):
                if id in touched and id is not None:
                    reason = self._changed(id, step)
                    if reason is not None:
                        return reason
        return None

    def senseless(self) -> list[tuple[Step, str]]:
        """Steps whose effect has come about by itself since the plan was made."""
        result = []
        for step in self._run.steps.values():
            if step.status not in ("pending", "running") or step.node.action not in CHANGES or not step.node.object:
                continue
            name, wanted = CHANGES[step.node.action]
            before = self._values.get((step.node.object, name))
            thing = self._world.things.get(step.node.object)
            fact = thing.facts.get(name) if thing is not None else None
            if fact is None or before is None or before == wanted:
                continue
            if fact.value == wanted and fact.confidence >= _SURE and fact.source != step.robot:
                result.append((step, f"{step.node.object} is so already, says {fact.source}"))
        return result

    def _found(self, touched: set[str], wanted: set[str]) -> Thing | None:
        for id in sorted(touched):
            thing = self._world.things.get(id)
            if thing is None or thing.id in self._known or thing.type not in wanted:
                continue
            if thing.shown >= 0 and thing.shown_confidence >= _FOUND:
                return thing
        return None

    def _changed(self, id: str, step: Step) -> str | None:
        thing = self._world.things.get(id)
        if thing is None:
            return f"{id} is no longer believed to be there"
        made_on = self._made_on.get(id)
        if made_on is None or thing.receptacle in self._world.fleet.robots:
            return None
        x, y, holder, room, shut = made_on
        if holder in self._world.fleet.robots:
            return None
        if thing.shape.kind == "pickup" and thing.room != room:
            return f"{thing.type} {id} is now in {thing.room}"
        if hidden(thing, self._world.things) and not shut and step.node.action != "open":
            return f"{thing.type} {id} has been shut in {thing.receptacle}"
        loose = thing.shape.kind == "pickup"  # furniture only comes to be seen better
        if loose and step.status == "running" and abs(thing.x - x) + abs(thing.y - y) > _MOVED_M:
            return f"{thing.type} {id} has moved"
        return None

    def _value(self, id: str, name: str) -> bool | None:
        thing = self._world.things.get(id)
        fact = thing.facts.get(name) if thing is not None else None
        return fact.value if fact is not None else None
