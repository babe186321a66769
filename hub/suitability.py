"""Is there a robot for every node of a plan? Skills, strength, parameters, one robot for what is tied, and a way there."""

from collections.abc import Mapping

from hub.ability import Ability, mass_kg
from hub.announced import own_parameter_fault, parameter_fault
from hub.floor import FloorPlan
from hub.graph import chains
from wire.messages.plan import KNOWN_ACTIONS, Plan, PlanNode
from wire.messages.world import ObjectState, WorldState


def able_robots(
    node: PlanNode, objects: Mapping[str, ObjectState], abilities: Mapping[str, Ability]
) -> tuple[list[str], list[str]]:
    """Those who can do a node, and, where nobody can or it wishes for one who cannot, the fault in a sentence."""
    if not abilities:
        return [], ["no robot is there"]
    where = f"node {node.id} ({node.action})"
    needed = {node.action, *node.req_skills}
    able = [robot for robot, has in abilities.items() if needed <= set(has.skills)]
    if not able:
        missing = sorted(needed - {skill for has in abilities.values() for skill in has.skills}) or sorted(needed)
        return [], [f"{where}: no robot can {', '.join(missing)}"]
    load = objects.get(node.object or "") if node.action == "pickup" else None
    if load is not None:
        able = [robot for robot in able if abilities[robot].lifts(load.type)]
        if not able:
            most_kg = max(has.payload_kg for has in abilities.values())
            weighs = f"a {load.type} weighs about {mass_kg(load.type):g} kg"
            return [], [f"{where}: {weighs}, and no robot lifts more than {most_kg:g} kg"]
    wrong = {robot: _parameters(node, abilities[robot]) for robot in able}
    able = [robot for robot in able if not wrong[robot]]
    if not able:
        return [], [f"{where}: {next(iter(wrong.values()))}"]
    preferred = node.preferred_robot
    if preferred is not None and preferred in abilities and preferred not in able:
        return able, [f"node {node.id} prefers {preferred}, which cannot {node.action}; {', '.join(sorted(able))} can"]
    return able, []


def _parameters(node: PlanNode, ability: Ability) -> str:
    schema = ability.parameters.get(node.action, "{}")
    if node.action not in KNOWN_ACTIONS:
        return parameter_fault(node, schema)
    return own_parameter_fault(node, schema) if node.params else ""


def one_robot_faults(plan: Plan, abilities: Mapping[str, Ability]) -> list[str]:
    """Nodes tied to each other by `same_robot_as` that no robot can do all of."""
    chain = chains(plan)
    tied: dict[str, list[PlanNode]] = {}
    for node in plan.nodes:
        tied.setdefault(chain[node.id], []).append(node)
    found = []
    for nodes in tied.values():
        needed = sorted({skill for node in nodes for skill in (node.action, *node.req_skills)})
        if len(nodes) > 1 and not any(set(needed) <= set(has.skills) for has in abilities.values()):
            ids = ", ".join(node.id for node in nodes)
            found.append(f"nodes {ids} are for one robot (same_robot_as), but no robot can {' and '.join(needed)}")
    return found


def reach_faults(plan: Plan, world: WorldState, able: Mapping[str, list[str]], floor: FloorPlan) -> list[str]:
    """Nodes in rooms to which no door leads from a robot that can do them. `able`: node -> who can."""
    objects = {o.id: o for o in world.objects}
    within = {r.id: floor.connected(r.room) for r in world.robots if r.room is not None and r.status != "lost"}
    if not within:
        return []
    anybody = set().union(*within.values())
    found = []
    for node in plan.nodes:
        room = node.room or (objects[node.object].room if node.object is not None else None)
        if room is None and node.point_m is not None:
            room = floor.room_at(*node.point_m)
        if room is None:
            continue
        where = f"node {node.id} ({node.action})"
        if room not in anybody:
            found.append(f"{where}: no door leads from any robot to {room}")
        elif not any(room in within.get(robot, anybody) for robot in able[node.id]):
            found.append(f"{where}: no door leads from {' or '.join(sorted(able[node.id]))}, who can do it, to {room}")
    return found
