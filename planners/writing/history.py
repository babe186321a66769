"""What has become of a task since its last plan: the plan, and how the world differs from the one that it was made in."""

from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from planners.prompt import FLAGS, Names
from planners.writing.offered import Offered
from wire.messages.plan import PlanNode
from wire.messages.world import WorldState

TASKS_KEPT = 16
_MOST_LINES = 24
_SEEDS = 8
"""A question and its repairs have seeds of their own."""
Facts = Mapping[str, tuple[str, tuple[str, ...]]]
"""Short name -> where it is, and what is said of it."""


@dataclass
class Past:
    """Of one task."""

    facts: Facts | None = None
    nodes: tuple[PlanNode, ...] = ()
    plans: int = 0
    """So many have been asked for."""

    def seed(self) -> int:
        """Another one for each plan: a question that has been answered badly is not answered in the same way again."""
        self.plans += 1
        return (self.plans - 1) * _SEEDS

    def text(self, offered: Offered) -> str:
        """For the prompt; empty at the first plan."""
        if self.facts is None:
            return ""
        lines = [f"your last plan: {'; '.join(_deed(node, offered.names) for node in self.nodes) or 'no steps'}"]
        changes = _changes(self.facts, facts_of(offered.request.world, offered.names))
        lines.append(f"since then: {'; '.join(changes) or 'nothing has changed'}")
        return "\n".join(lines)

    def keep(self, offered: Offered, nodes: Sequence[PlanNode]) -> None:
        self.facts, self.nodes = facts_of(offered.request.world, offered.names), tuple(nodes)


class History:
    """Of the last tasks. Without it (the process was restarted) a model is told of the world as it is, nothing more."""

    def __init__(self) -> None:
        self._past: OrderedDict[str, Past] = OrderedDict()

    def of(self, task: str) -> Past:
        past = self._past.setdefault(task, Past())
        self._past.move_to_end(task)
        while len(self._past) > TASKS_KEPT:
            self._past.popitem(last=False)
        return past


def facts_of(world: WorldState, names: Names) -> Facts:
    """Things, and rooms that have been searched."""
    facts: dict[str, tuple[str, tuple[str, ...]]] = {
        area.id: ("", ("searched",)) for area in world.areas if area.searched
    }
    for obj in world.objects:
        holder = names.short(obj.receptacle) if obj.receptacle is not None else obj.room or "nobody knows where"
        said = tuple(flag for prop, flag in FLAGS.items() if prop in obj.props and obj.props[prop].value)
        facts[names.short(obj.id)] = (holder, said)
    return facts


def _changes(before: Facts, now: Facts) -> list[str]:
    """Short sentences: what is new, gone, elsewhere or otherwise."""
    lines = []
    for name, (place, said) in now.items():
        if name not in before:
            lines.append(" ".join(filter(None, (name, "new" if place else "", f"in {place}" if place else "", *said))))
            continue
        old_place, old_said = before[name]
        if place != old_place:
            lines.append(f"{name} now in {place}")
        lines += [f"{name} now {flag}" for flag in said if flag not in old_said]
        lines += [f"{name} no longer {flag}" for flag in old_said if flag not in said]
    lines += [f"{name} gone" for name in before if name not in now]
    return (
        lines if len(lines) <= _MOST_LINES else [*lines[:_MOST_LINES], f"and {len(lines) - _MOST_LINES} changes more"]
    )


def _deed(node: PlanNode, names: Names) -> str:
    things = (names.short(id) for id in (node.item, node.object) if id is not None)
    return " ".join((f"{node.id}:", node.action, *things, *filter(None, (node.room,))))
