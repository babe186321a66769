"""Precondition replay: the plan played through on a copy of W, hand by hand and door by door."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from hub.graph import ancestors, chains
from hub.kinds import BLADES
from wire.catalogue import PROP_FLAG, catalogue
from wire.messages.plan import Action, Plan, PlanNode
from wire.messages.world import ObjectState, WorldState

_SETS: dict[Action, tuple[str, bool]] = {
    "open": ("isOpen", True),
    "close": ("isOpen", False),
    "toggle_on": ("isToggled", True),
    "toggle_off": ("isToggled", False),
    "slice": ("isSliced", True),
}
_NEEDS: dict[tuple[Action, str], tuple[str, bool, str]] = {
    ("open", "Microwave"): ("isToggled", False, "runs: switch it off"),
    ("toggle_on", "Microwave"): ("isOpen", False, "is open: close it"),
    ("toggle_on", "Laptop"): ("isOpen", True, "is closed: open it"),
}
"""What must be so of a thing of this type before the action, and what to do when it is not."""


@dataclass
class _Imagined:
    objects: dict[str, ObjectState]
    parent: dict[str, str | None]
    values: dict[tuple[str, str], bool]
    """(Object, property) -> its value; False when nobody has spoken of it."""
    carried: dict[str, str]
    """Item -> the node that picked it up, or the robot that holds it now."""
    before: dict[str, set[str]]
    """Node -> every node that is surely done before it."""
    chain: dict[str, str]
    """Node -> its chain of nodes for one robot."""
    slicers: dict[str, list[str]]
    """Object -> the nodes that slice it."""
    set_by: dict[tuple[str, str], list[str]] = field(default_factory=dict)
    """(Object, property) -> the nodes that gave it the value that it has; none while it is as in W."""


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
    slicers: dict[str, list[str]] = {}
    for node in plan.nodes:
        if node.action == "slice" and node.object is not None:
            slicers.setdefault(node.object, []).append(node.id)
    return _Imagined(
        objects={o.id: o for o in world.objects},
        parent={o.id: o.receptacle for o in world.objects},
        values={(o.id, name): name in o.props and o.props[name].value for o in world.objects for name in PROP_FLAG},
        carried={r.inventory: r.id for r in world.robots if r.inventory is not None},
        before=ancestors(plan, order),
        chain=chains(plan),
        slicers=slicers,
    )


def _fault(node: PlanNode, nodes: dict[str, PlanNode], state: _Imagined) -> str | None:
    if node.action == "pickup":
        return _pickup_fault(node, state)
    if node.action == "put":
        return _put_fault(node, nodes, state)
    if node.object is None or node.action not in (*_SETS, "clean"):
        return None
    if node.action == "slice":
        fault = _slice_fault(node, nodes, state)
        if fault is not None:
            return fault
    name, wanted, otherwise = _NEEDS.get((node.action, state.objects[node.object].type), ("", False, ""))
    if name and not _surely(node.object, name, wanted, node, state):
        return f"{node.object} {otherwise} in a node that this one waits for"
    return _shut_in(node.object, node, state)


def _pickup_fault(node: PlanNode, state: _Imagined) -> str | None:
    item = node.object
    if item is None:
        return None
    if item in state.carried:
        return f"{item} is already in a hand ({state.carried[item]}): put it down first"
    sliced = state.objects[item].props.get("isSliced")
    if sliced is not None and sliced.value:
        return f"{item} has been sliced, and what is sliced cannot be carried: choose a whole one"
    early = [slicer for slicer in state.slicers.get(item, ()) if node.id not in state.before[slicer]]
    if early:
        return f"{item} may be sliced by {early[0]} before, and what is sliced cannot be carried: slice it afterwards"
    return _shut_in(item, node, state)


def _slice_fault(node: PlanNode, nodes: dict[str, PlanNode], state: _Imagined) -> str | None:
    """Whether the robot would have no blade in its hand, or the food be in one."""
    if node.object in state.carried:
        return f"{node.object} is in a hand ({state.carried[node.object]}): put it down first, it is cut where it lies"
    item = node.item
    if item is not None and state.objects[item].type not in BLADES:
        return f"{item} is a {state.objects[item].type}: slicing needs a {' or '.join(BLADES)} in the hand"
    blades = [id for id in state.carried if state.objects[id].type in BLADES] if item is None else [item]
    if not blades:
        return (
            f"slicing needs a {' or '.join(BLADES)} in the robot's hand: pick one up in a node that this one waits for, "
            "and name it as item"
        )
    faults = [_not_in_hand(blade, node, nodes, state) for blade in blades]
    return None if None in faults else faults[0]


def _not_in_hand(item: str, node: PlanNode, nodes: dict[str, PlanNode], state: _Imagined) -> str | None:
    """Why the robot of a node has not surely an item in its hand."""
    taker = state.carried.get(item)
    if taker is None:
        return f"nobody has {item} in hand: pick it up first and let this node wait for that"
    if taker not in nodes:
        return None
    if taker not in state.before[node.id]:
        return f"it must wait for {taker}, which picks {item} up"
    if node.same_robot_as is not None and state.chain[node.id] != state.chain[taker]:
        return f"same_robot_as must be {taker}, the node that picks {item} up"
    return None


def _put_fault(node: PlanNode, nodes: dict[str, PlanNode], state: _Imagined) -> str | None:
    item, holder = node.item, node.object
    if item is None or holder is None:
        return None
    if item == holder:
        return f"{item} cannot be put into itself"
    fault = _not_in_hand(item, node, nodes, state)
    if fault is not None:
        return fault
    if _needs_opening(holder, state) and not _surely(holder, "isOpen", True, node, state):
        return f"{holder} is closed: open it in a node that this one waits for"
    return _shut_in(holder, node, state)


def _shut_in(id: str, node: PlanNode, state: _Imagined) -> str | None:
    """Whether something closed is around an object."""
    seen = {id}
    holder = state.parent.get(id)
    while holder is not None and holder in state.objects and holder not in seen:
        if _needs_opening(holder, state) and not _surely(holder, "isOpen", True, node, state):
            return f"{id} is in {holder}, which is closed: open it in a node that this one waits for"
        seen.add(holder)
        holder = state.parent.get(holder)
    return None


def _needs_opening(id: str, state: _Imagined) -> bool:
    row = catalogue().get(state.objects[id].type)
    return row is not None and row.must_open


def _surely(id: str, name: str, wanted: bool, node: PlanNode, state: _Imagined) -> bool:
    """Whether a property has a value when a node begins, in whatever order the graph is carried out."""
    if state.values.get((id, name), False) != wanted:
        return False
    setters = state.set_by.get((id, name))
    return setters is None or any(setter in state.before[node.id] for setter in setters)


def _do(node: PlanNode, state: _Imagined) -> None:
    if node.object is None:
        return
    if node.action == "pickup":
        state.carried[node.object] = node.id
        state.parent[node.object] = None
    elif node.action == "put" and node.item is not None:
        state.carried.pop(node.item, None)
        state.parent[node.item] = node.object
    elif node.action in _SETS:
        name, value = _SETS[node.action]
        key = (node.object, name)
        if state.values.get(key, False) != value:
            state.values[key], state.set_by[key] = value, [node.id]
        elif key in state.set_by:
            state.set_by[key].append(node.id)
