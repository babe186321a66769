"""One hand per robot: what a plan has in hands at the same time, and in whose."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hub.ability import Ability
from hub.graph import ancestors, chains
from wire.messages.plan import Plan, PlanNode
from wire.messages.world import WorldState


@dataclass
class _Grasp:
    """From the node that takes an item (None: it is in a hand now) to the one that puts it down (None: nobody does)."""

    item: str
    taker: str | None
    putter: str | None = None


class _Play:
    """The plan with its grasps; tells which of them cannot but overlap."""

    def __init__(self, plan: Plan, order: Sequence[str], world: WorldState, abilities: Mapping[str, Ability]) -> None:
        self.nodes = {node.id: node for node in plan.nodes}
        self.order = order
        self.before, self.chain = ancestors(plan, order), chains(plan)
        held = [_Grasp(r.inventory, None) for r in world.robots if r.inventory is not None and r.id in abilities]
        carriers = {r.id for r in world.robots if r.inventory is not None and r.id in abilities}
        self.hands = len(carriers | {id for id, has in abilities.items() if "pickup" in has.skills})
        self.grasps = held
        for id in order:
            self._take(self.nodes[id])

    def _take(self, node: PlanNode) -> None:
        if node.action == "pickup" and node.object is not None:
            self.grasps.append(_Grasp(node.object, node.id))
        elif node.action == "put":
            for grasp in self.grasps:
                if grasp.item == node.item and grasp.putter is None:
                    grasp.putter = node.id

    def held_at(self, node: str | None) -> list[_Grasp]:
        """What must be in a hand when a node is carried out, or (None) at the end, in whatever order all is done."""
        if node is None:
            return [g for g in self.grasps if g.putter is None]
        done = self.before[node] | {node}
        return [
            g
            for g in self.grasps
            if (g.taker is None or g.taker in done)
            and (g.putter is None or g.putter == node or node in self.before[g.putter])
        ]


def grasp_faults(plan: Plan, order: Sequence[str], world: WorldState, abilities: Mapping[str, Ability]) -> list[str]:
    """Nodes that need a free hand where none can be free."""
    play = _Play(plan, order, world, abilities)
    return _double(play) + _cleaning(play) or _too_many(play)


def _double(play: _Play) -> list[str]:
    """Pairs of pickups that one robot must do (or, one after the other, is wished to do) with one hand."""
    moments = [play.held_at(id) for id in (*play.order, None)]
    found = []
    taken = [g for g in play.grasps if g.taker is not None]
    for number, second in enumerate(taken):
        for first in taken[:number]:
            if not any(first in held and second in held for held in moments):
                continue
            robot = _one_robot(first, second, play)
            if robot is not None:
                found.append(
                    f"node {second.taker} (pickup): double grasp: {robot} still has {first.item} in its hand from node "
                    f"{first.taker}; put {first.item} down in a node that {second.taker} waits for, or leave "
                    f"{second.taker} to another robot"
                )
    return found


def _one_robot(first: _Grasp, second: _Grasp, play: _Play) -> str | None:
    """The robot that both pickups are meant for, in words; None when they may be done by two."""
    if first.taker is None or second.taker is None:
        return None
    if play.chain[first.taker] == play.chain[second.taker]:
        return f"the robot of {first.taker}"
    wished = play.nodes[first.taker].preferred_robot
    if wished is None or wished != play.nodes[second.taker].preferred_robot:
        return None
    in_turn = first.taker in play.before[second.taker] and first in play.held_at(second.taker)
    return wished if in_turn else None


def _cleaning(play: _Play) -> list[str]:
    found = []
    for id in play.order:
        if play.nodes[id].action != "clean":
            continue
        for grasp in play.held_at(id):
            if grasp.taker is not None and play.chain[grasp.taker] == play.chain[id]:
                found.append(
                    f"node {id} (clean): cleaning needs an empty hand, and the robot of {grasp.taker} still has "
                    f"{grasp.item} in it; put {grasp.item} down in a node that {id} waits for"
                )
    return found


def _too_many(play: _Play) -> list[str]:
    """The first moment at which more things must be in hands than there are hands."""
    for id in (*play.order, None):
        items = sorted({g.item for g in play.held_at(id)})
        if len(items) > play.hands and any(g.taker is not None for g in play.held_at(id)):
            where = f"node {id} ({play.nodes[id].action})" if id is not None else "at the end"
            hands = f"{play.hands} {'robot has a hand' if play.hands == 1 else 'robots have a hand each'}"
            return [f"{where}: {', '.join(items)} would be in hands at once, but {hands}: put something down before"]
    return []
