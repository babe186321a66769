"""Precondition replay: the plan played through on a copy of W, hand by hand and door by door."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from wire.catalogue import catalogue
from wire.messages.plan import Plan, PlanNode
from wire.messages.world import ObjectState, WorldState


@dataclass
class _Imagined:
    objects: dict[str, ObjectState]
    parent: dict[str, str | None]
    open: dict[str, bool]
    carried: dict[str, str]
    """Item -> the node that picked it up, or the robot that holds it now."""
    before: dict[str, set[str]]
    """Node -> every node that is surely done before it."""
    opened_by: dict[str, list[str]] = field(default_factory=dict)
    robots: frozenset[str] = frozenset()


def replay(plan: Plan, order: Sequence[str], world: WorldState) -> list[str]:
    """Play the nodes in an order that respects the graph; the preconditions that would fail."""
    nodes = {node.id: node for node in plan.nodes}
    state = _imagine(world, plan, order)
    found = []
    for id in order:
        node = nodes[id]
        fault = _fault(node, nodes, state)
        if fault is not None:
            found.append(f"node {node.id} ({node.action}): {fault}")
        _do(node, state)
    return found


def _imagine(world: WorldState, plan: Plan, order: Sequence[str]) -> _Imagined:
    after = {node.id: node.after for node in plan.nodes}
    before: dict[str, set[str]] = {}
    for id in order:
        before[id] = set(after[id]).union(*(before[a] for a in after[id]))
    return _Imagined(
        objects={o.id: o for o in world.objects},
        parent={o.id: o.receptacle for o in world.objects},
        open={o.id: "isOpen" in o.props and o.props["isOpen"].value for o in world.objects},
        carried={r.inventory: r.id for r in world.robots if r.inventory is not None},
        before=before,
        robots=frozenset(r.id for r in world.robots),
    )


def _fault(node: PlanNode, nodes: dict[str, PlanNode], state: _Imagined) -> str | None:
    if node.action == "pickup":
        return _pickup_fault(node, state)
    if node.action == "put":
        return _put_fault(node, nodes, state)
    if node.action in ("open", "close", "toggle_on", "toggle_off", "slice", "clean") and node.object is not None:
        return _shut_in(node.object, node, state)
    return None


def _pickup_fault(node: PlanNode, state: _Imagined) -> str | None:
    item = node.object
    if item is None:
        return None
    if item in state.carried:
        return f"{item} is already in a hand ({state.carried[item]}): put it down first"
    return _shut_in(item, node, state)


def _put_fault(node: PlanNode, nodes: dict[str, PlanNode], state: _Imagined) -> str | None:
    item, holder = node.item, node.object
    if item is None or holder is None:
        return None
    if item == holder:
        return f"{item} cannot be put into itself"
    taker = state.carried.get(item)
    if taker is None:
        return f"nobody has {item} in hand: pick it up first and let this node wait for that"
    if taker in nodes and taker not in state.before[node.id]:
        return f"it must wait for {taker}, which picks {item} up"
    if taker in nodes and node.same_robot_as is not None and node.same_robot_as != taker:
        pair = nodes[node.same_robot_as]
        if pair.same_robot_as != taker and nodes[taker].same_robot_as != pair.id:
            return f"same_robot_as must be {taker}, the node that picks {item} up"
    if _needs_opening(holder, state) and not _open_for(holder, node, state):
        return f"{holder} is closed: open it in a node that this one waits for"
    return _shut_in(holder, node, state)


def _shut_in(id: str, node: PlanNode, state: _Imagined) -> str | None:
    """Whether something closed is around an object."""
    seen = {id}
    holder = state.parent.get(id)
    while holder is not None and holder in state.objects and holder not in seen:
        if _needs_opening(holder, state) and not _open_for(holder, node, state):
            return f"{id} is in {holder}, which is closed: open it in a node that this one waits for"
        seen.add(holder)
        holder = state.parent.get(holder)
    return None


def _needs_opening(id: str, state: _Imagined) -> bool:
    row = catalogue().get(state.objects[id].type)
    return row is not None and row.must_open


def _open_for(holder: str, node: PlanNode, state: _Imagined) -> bool:
    if not state.open.get(holder, False):
        return False
    openers = state.opened_by.get(holder)
    return openers is None or any(opener in state.before[node.id] for opener in openers)


def _do(node: PlanNode, state: _Imagined) -> None:
    if node.object is None:
        return
    if node.action == "pickup":
        state.carried[node.object] = node.id
        state.parent[node.object] = None
    elif node.action == "put" and node.item is not None:
        state.carried.pop(node.item, None)
        state.parent[node.item] = node.object
    elif node.action == "open":
        if not state.open.get(node.object, False):
            state.opened_by.setdefault(node.object, []).append(node.id)
        state.open[node.object] = True
    elif node.action == "close":
        state.open[node.object] = False
