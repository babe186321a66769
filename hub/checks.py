"""Can this plan be carried out in this world? Every fault is a sentence that a planner (or its model) can act on."""

from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

from hub.ability import Ability
from hub.floor import FloorPlan
from hub.grasps import grasp_faults
from hub.names import name_faults
from hub.replay import replay
from hub.suitability import able_robots, one_robot_faults, reach_faults
from wire.catalogue import PROP_FLAG, catalogue
from wire.messages.plan import Action, Plan, PlanNode
from wire.messages.world import ObjectState, WorldState

NEEDS_OBJECT: frozenset[Action] = frozenset(
    {"inspect", "pickup", "put", "open", "close", "toggle_on", "toggle_off", "slice", "clean"}
)
_FLAG: dict[Action, str] = {
    "pickup": "pickupable",
    "open": PROP_FLAG["isOpen"],
    "close": PROP_FLAG["isOpen"],
    "toggle_on": PROP_FLAG["isToggled"],
    "toggle_off": PROP_FLAG["isToggled"],
    "slice": PROP_FLAG["isSliced"],
    "clean": PROP_FLAG["isDirty"],
    "put": "receptacle",
}


def faults(plan: Plan, world: WorldState, abilities: Mapping[str, Ability], floor: FloorPlan) -> list[str]:
    """Why the plan cannot be carried out; empty when it can. `abilities`: of every robot that is there."""
    found = _graph(plan)
    if found:
        return found
    objects = {o.id: o for o in world.objects}
    robots = {r.id for r in world.robots} | set(abilities)
    able: dict[str, list[str]] = {}
    for node in plan.nodes:
        names = name_faults(plan, node, objects, robots, floor)
        found += names or _fields(node, objects)
        able[node.id], fault = able_robots(node, objects, abilities)
        found += fault
    found = found or one_robot_faults(plan, abilities)
    if found:
        return found
    order = list(TopologicalSorter({n.id: n.after for n in plan.nodes}).static_order())
    return (
        reach_faults(plan, world, able, floor)
        + replay(plan, order, world)
        + grasp_faults(plan, order, world, abilities)
    )


def _graph(plan: Plan) -> list[str]:
    ids = [node.id for node in plan.nodes]
    found = [
        f"node {id} appears {ids.count(id)} times: give every node its own id"
        for id in sorted(set(ids))
        if ids.count(id) > 1
    ]
    known = set(ids)
    for node in plan.nodes:
        found += [f"node {node.id} waits for {id}, which is not in the plan" for id in node.after if id not in known]
        if node.same_robot_as is not None and node.same_robot_as not in known:
            found.append(f"node {node.id} wants the robot of {node.same_robot_as}, which is not in the plan")
        if node.goal is not None and not 0 <= node.goal < len(plan.goals):
            found.append(f"node {node.id} serves goal {node.goal}, but there are {len(plan.goals)} goals")
    for index, goal in enumerate(plan.goals):
        missing = [other for other in goal.after if not 0 <= other < len(plan.goals)]
        found += [f"goal {index} comes after goal {other}, but there are {len(plan.goals)} goals" for other in missing]
    if found:
        return found
    try:
        TopologicalSorter({n.id: n.after for n in plan.nodes}).prepare()
    except CycleError as error:
        return [f"the nodes wait for each other in a circle: {' -> '.join(error.args[1])}"]
    return []


def _fields(node: PlanNode, objects: dict[str, ObjectState]) -> list[str]:
    where = f"node {node.id} ({node.action})"
    if node.action in NEEDS_OBJECT and node.object is None:
        return [f"{where} names no object"]
    if node.action == "put" and node.item is None:
        return [f"{where} does not say which item is put down"]
    if node.action == "explore" and node.room is None:
        return [f"{where} names no room"]
    if node.action == "goto" and node.object is None and node.room is None and node.point_m is None:
        return [f"{where} names no place"]
    flag = _FLAG.get(node.action)
    if flag is not None and node.object is not None:
        type = objects[node.object].type
        row = catalogue().get(type)
        if row is not None and not row.can(flag):
            return [f"{where}: {node.object} is a {type}, which is not {flag}"]
    return []
