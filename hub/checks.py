"""Can this plan be carried out in this world? Every fault is a sentence that a planner (or its model) can act on."""

from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

from hub.ability import Ability, mass_kg
from hub.announced import parameter_fault
from hub.floor import FloorPlan
from hub.grasps import grasp_faults
from hub.names import name_faults
from hub.replay import replay
from wire.catalogue import PROP_FLAG, catalogue
from wire.messages.plan import KNOWN_ACTIONS, Action, Plan, PlanNode
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
    for node in plan.nodes:
        names = name_faults(plan, node, objects, robots, floor)
        found += names or _fields(node, objects)
        found += _hands(node, objects, abilities)
    if found:
        return found
    order = list(TopologicalSorter({n.id: n.after for n in plan.nodes}).static_order())
    return (
        _reach(plan, world, objects, floor) + replay(plan, order, world) + grasp_faults(plan, order, world, abilities)
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


def _hands(node: PlanNode, objects: dict[str, ObjectState], abilities: Mapping[str, Ability]) -> list[str]:
    if not abilities:
        return ["no robot is there"]
    needed = {node.action, *node.req_skills}
    able = [robot for robot, has in abilities.items() if needed <= set(has.skills)]
    if not able:
        missing = sorted(needed - {skill for has in abilities.values() for skill in has.skills}) or sorted(needed)
        return [f"node {node.id} ({node.action}): no robot can {', '.join(missing)}"]
    load = objects.get(node.object or "") if node.action == "pickup" else None
    if load is not None:
        able = [robot for robot in able if abilities[robot].lifts(load.type)]
        if not able:
            most_kg = max(has.payload_kg for has in abilities.values())
            weighs = f"a {load.type} weighs about {mass_kg(load.type):g} kg"
            return [f"node {node.id} (pickup): {weighs}, and no robot lifts more than {most_kg:g} kg"]
    if node.action not in KNOWN_ACTIONS:
        wrong = {robot: parameter_fault(node, abilities[robot].parameters.get(node.action, "{}")) for robot in able}
        able = [robot for robot in able if not wrong[robot]]
        if not able:
            return [f"node {node.id} ({node.action}): {next(iter(wrong.values()))}"]
    preferred = node.preferred_robot
    if preferred is not None and preferred in abilities and preferred not in able:
        return [f"node {node.id} prefers {preferred}, which cannot {node.action}; {', '.join(sorted(able))} can"]
    return []


def _reach(plan: Plan, world: WorldState, objects: dict[str, ObjectState], floor: FloorPlan) -> list[str]:
    rooms: set[str] = set()
    for robot in world.robots:
        if robot.room is not None and robot.status != "lost":
            rooms |= floor.connected(robot.room)
    if not rooms:
        return []
    found = []
    for node in plan.nodes:
        room = node.room or (objects[node.object].room if node.object is not None else None)
        if room is None and node.point_m is not None:
            room = floor.room_at(*node.point_m)
        if room is not None and room not in rooms:
            found.append(f"node {node.id} ({node.action}): no door leads from any robot to {room}")
    return found
