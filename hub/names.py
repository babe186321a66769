"""Does everything exist that a node of a plan names? Each fault says what is unknown and what is known instead."""

from collections.abc import Collection, Mapping
from difflib import get_close_matches

from hub.floor import FloorPlan, edge_distance_m
from wire.catalogue import catalogue
from wire.messages.plan import Plan, PlanNode
from wire.messages.world import ObjectState
from wire.model import Vec2
from wire.outline import inside

_IN_A_WALL_M = 0.3
_MOST_NAMED = 6


def name_faults(
    plan: Plan, node: PlanNode, objects: Mapping[str, ObjectState], robots: Collection[str], floor: FloorPlan
) -> list[str]:
    """Unknown objects, rooms, places, types and robots. `robots`: every one ever heard of."""
    where = f"node {node.id} ({node.action})"
    ids = {id: f"{id} ({thing.type})" for id, thing in objects.items()}
    found = [
        f"{where}: there is no object {id}; the world has {_instead(id, ids)}"
        for id in (node.object, node.item)
        if id is not None and id not in objects
    ]
    if node.room is not None and node.room not in floor.polygons:
        found.append(f"{where}: there is no room {node.room}; rooms are {', '.join(floor.polygons)}")
    if node.point_m is not None and not _indoors(node.point_m, floor):
        x, y = node.point_m
        found.append(f"{where}: the point ({x:g}, {y:g}) lies outside of every room; {_extent(floor)}")
    types = {name: name for name in catalogue()}
    found += [
        f"{where}: {type} is no type of object; types are named like {_instead(type, types)}"
        for type in node.looking_for
        if type not in types
    ]
    taken = plan.taken_for.get(node.object or "")
    if taken is not None and taken not in types:
        found.append(f"{where}: {node.object} is taken for a {taken}, which is no type; {_instead(taken, types)} are")
    if node.preferred_robot is not None and node.preferred_robot not in robots:
        known = ", ".join(sorted(robots)) or "none yet"
        found.append(f"{where} prefers {node.preferred_robot}, but there is no such robot; robots are {known}")
    return found


def _instead(name: str, known: Mapping[str, str]) -> str:
    """The known names most like a wrong one, in words; any when none is."""
    near = get_close_matches(name, known, _MOST_NAMED) or sorted(known)[:_MOST_NAMED]
    return ", ".join(known[other] for other in near) or "nothing yet"


def _indoors(point_m: Vec2, floor: FloorPlan) -> bool:
    rooms = floor.polygons.values()
    return not rooms or any(inside(point_m, r) or edge_distance_m(point_m, r) < _IN_A_WALL_M for r in rooms)


def _extent(floor: FloorPlan) -> str:
    corners = [corner for polygon in floor.polygons.values() for corner in polygon]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    return f"the rooms lie within x {min(xs):g} to {max(xs):g} m and y {min(ys):g} to {max(ys):g} m"
