"""F of equation 5 for what robots do: Pickup and Put re-parent, doors and switches change, a vain look denies."""

from collections.abc import Mapping

from hub.facts import handle
from hub.records import Thing
from hub.world import World
from wire.messages.command import Result
from wire.messages.plan import FROM_ABOVE, KNOWN_ACTIONS, Action, PlanNode

CHANGES: dict[Action, tuple[str, bool]] = {
    "open": ("isOpen", True),
    "close": ("isOpen", False),
    "toggle_on": ("isToggled", True),
    "toggle_off": ("isToggled", False),
    "slice": ("isSliced", True),
    "clean": ("isDirty", False),
}
"""The property of equation 4 that an action makes true or false."""
_SURE_M2 = 0.05**2
_SURE_BELIEF = 3.5


def apply(world: World, node: PlanNode, robot: str, result: Result, types: Mapping[str, str]) -> None:
    """Take the end of a goal into W. `types`: of the things in the plan, in case W has lost one meanwhile."""
    if node.action in FROM_ABOVE and result.status == "done":
        _looked_down(world, node, robot, result)
    if node.action not in KNOWN_ACTIONS:
        return  # what it changed, observations will say
    if result.status == "done" or result.code == "already":
        _succeeded(world, node, robot, result, types)
    elif result.status == "failed":
        _failed(world, node, robot, result)


def _looked_down(world: World, node: PlanNode, robot: str, result: Result) -> None:
    """A room or a thing has been flown over, says who has flown: what was seen there, observations say."""
    thing = world.things.get(world.things.standing_for(node.object)) if node.object is not None else None
    if thing is not None and FROM_ABOVE[node.action] == "seen_from_above":
        thing.from_above = True
        thing.version += 1
        world.things.touch(thing)
    if node.room is not None and node.object is None:
        world.areas.flown_over(node.room, FROM_ABOVE[node.action], robot, result.stamp_s)


def _succeeded(world: World, node: PlanNode, robot: str, result: Result, types: Mapping[str, str]) -> None:
    if node.action == "explore":
        if node.room is not None and result.point_enu_m is None:
            # A search that found something ended there, with the rest of the room unseen.
            world.areas.search_done(node.room, robot, result.stamp_s)
        return
    if node.action == "goto":
        return
    if node.action == "put":
        put(world, _handled(world, node.item, robot, result, types), world.things.get(node.object), robot, result)
        return
    thing = _handled(world, node.object, robot, result, types)
    if node.action == "pickup":
        world.fleet.robot(robot).holding = True
    if thing is None:
        return
    if node.action == "pickup":
        take(world, thing, robot, result.stamp_s)
    elif node.action in CHANGES:
        name, value = CHANGES[node.action]
        handle(world.property_of(thing, name), robot, value, result.stamp_s)
    elif node.action == "inspect" and "isOpen" in thing.facts and thing.facts["isOpen"].value:
        thing.looked_into = True
    touched(thing, robot, result.stamp_s)


def _handled(world: World, id: str | None, robot: str, result: Result, types: Mapping[str, str]) -> Thing | None:
    """What a hand has just been on. It is there, even when W had given it up or taken it for another."""
    if id is None:
        return None
    known_as = world.things.standing_for(id)
    thing = world.things.get(known_as)
    if thing is None and id in types:
        place = result.point_enu_m or world.fleet.robot(robot).position_m
        thing = Thing(known_as, types[id], place, result.stamp_s)
        thing.xx = thing.yy = thing.zz = _SURE_M2
        world.things.bring_back(thing)
    return thing


def take(world: World, thing: Thing, robot: str, stamp_s: float) -> None:
    """Pickup: inv_i <- id_j and rec_j <- id_i."""
    carrier = world.fleet.robot(robot)
    carrier.inventory, carrier.holding = thing.id, True
    world.things.move(thing, (carrier.position_m[0], carrier.position_m[1], 0.6))
    thing.handled_s, thing.locked = stamp_s, True
    world.place(thing, robot)


def put(world: World, item: Thing | None, holder: Thing | None, robot: str, result: Result) -> None:
    """Put: the payload is cleared and rec_j <- id_k. Without a known item only the hand is."""
    carrier = world.fleet.robot(robot)
    carrier.inventory, carrier.holding = None, False
    if holder is not None:
        touched(holder, robot, result.stamp_s)
    if item is None:
        return
    beside = (holder.x, holder.y, holder.z) if holder is not None else carrier.position_m
    world.things.move(item, result.point_enu_m or beside)
    item.xx = item.yy = item.zz = _SURE_M2
    item.xy = 0.0
    item.handled_s, item.locked = result.stamp_s, False
    touched(item, robot, result.stamp_s)
    world.place(item, holder.id if holder is not None else None)


def touched(thing: Thing, robot: str, stamp_s: float) -> None:
    """A hand was on it: it is there."""
    thing.belief = max(thing.belief, _SURE_BELIEF)
    thing.stamp_s, thing.last_source = max(thing.stamp_s, stamp_s), robot
    thing.first_hand_s = stamp_s
    thing.verified = True
    thing.version += 1


def _failed(world: World, node: PlanNode, robot: str, result: Result) -> None:
    """What a failure teaches: the thing is not there, or the door is shut."""
    thing = world.things.get(node.object)
    if thing is None:
        return
    if result.code == "not_there":
        for sight in thing.sights.values():
            thing.belief -= max(sight.support, 0.0)
            sight.support = min(sight.support, 0.0)
        thing.belief = min(thing.belief, -1.0) - 1.5
        thing.version += 1
        world.things.touch(thing)
        if thing.receptacle not in world.fleet.robots:
            world.denials.add(thing, result.stamp_s)
            world.things.remove(thing)
    elif result.code == "closed":
        shut = _around(world, thing)
        if shut is not None:
            handle(world.property_of(shut, "isOpen"), robot, False, result.stamp_s)


def _around(world: World, thing: Thing) -> Thing | None:
    """The closable thing that a 'closed' failure is about: the target itself or its receptacle."""
    if "isOpen" in thing.facts:
        return thing
    return world.things.get(thing.receptacle)


def finished_anyway(node: PlanNode, result: Result) -> Result:
    """A hand that had closed or opened before a cancellation came: the thing is done."""
    if result.status != "cancelled" or result.point_enu_m is None:
        return result
    if (node.action == "pickup" and result.holding) or (node.action == "put" and not result.holding):
        return result.model_copy(update={"status": "done", "code": "ok"})
    return result
