"""More faults for plans: of robots, their skills and hands, and of what things are like. See `mutations`."""

from dataclasses import replace
from random import Random

from hub.ability import Ability, mass_kg
from tests.hub.mutations import Case, _free, _one, mutation
from wire.messages.plan import PlanNode
from wire.messages.world import PropertyState


@mutation
def skill_of_nobody(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    return node and case.changed(
        node, f"node {node.id} (teleport)", "no robot can teleport", action="teleport", req_skills=()
    )


@mutation
def required_skill_of_nobody(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    return node and case.changed(node, f"node {node.id} ", "no robot can swim", req_skills=("swim",))


@mutation
def no_robot_left_that_can(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    if node is None:
        return None
    able = {
        id: replace(has, skills=tuple(s for s in has.skills if s != node.action)) for id, has in case.abilities.items()
    }
    return replace(case, abilities=able, culprits=(f"node {node.id} ", f"no robot can {node.action}"))


@mutation
def robot_that_lacks_the_skill(rng: Random, case: Case) -> Case | None:
    node = _one(rng, [n for n in case.nodes() if n.action not in case.abilities["drone-1"].skills])
    if node is None:
        return None
    words = (f"node {node.id} ", f"prefers drone-1, which cannot {node.action}")
    return case.changed(node, *words, preferred_robot="drone-1")


@mutation
def one_robot_for_what_no_robot_can_alone(rng: Random, case: Case) -> Case | None:
    """A drone's deed and a dog's, tied to one robot."""
    node = _one(rng, [n for n in case.nodes() if n.action not in case.abilities["drone-1"].skills])
    if node is None:
        return None
    up = PlanNode(id="up", action="take_off", same_robot_as=node.id)
    return case.with_nodes([*case.nodes(), up], "up", node.id, "take_off", node.action, "no robot can")


@mutation
def unknown_parameter(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    return node and case.changed(node, f"node {node.id} ({node.action})", "force is no parameter", params={"force": 3})


@mutation
def unknown_parameter_of_a_drone(rng: Random, case: Case) -> Case | None:
    up = PlanNode(id="up", action="take_off", params={"altitude": 1.5})
    return case.with_nodes([*case.nodes(), up], "node up (take_off)", "altitude is no parameter", "height_m")


@mutation
def parameter_of_a_wrong_kind(rng: Random, case: Case) -> Case | None:
    wait = PlanNode(id="wait", action="hold", params={"seconds": "long"})
    return case.with_nodes([*case.nodes(), wait], "node wait (hold)", "seconds must be a number", "'long'")


@mutation
def payload_too_heavy(rng: Random, case: Case) -> Case | None:
    node = _one(rng, [n for n in case.nodes("pickup") if mass_kg(case.objects[n.object or ""].type) > 0.0])
    if node is None:
        return None
    weak = {id: replace(has, payload_kg=1e-4) for id, has in case.abilities.items()}
    type = case.objects[node.object or ""].type
    return replace(
        case, abilities=weak, culprits=(f"node {node.id} (pickup)", f"a {type} weighs about", "no robot lifts")
    )


@mutation
def unreachable_room(rng: Random, case: Case) -> Case | None:
    """The room of a node has no door any more, and nobody is in it."""
    taken = {robot.room for robot in case.world.robots}
    rooms = [(n, n.room or case.objects[n.object or ""].room) for n in case.nodes() if n.room or n.object]
    away = [(node, room) for node, room in rooms if room not in taken]
    if not away:
        return None
    node, room = rng.choice(away)
    doors = tuple(door for door in case.site.door if room not in door.rooms)
    culprits = (f"node {node.id} ({node.action})", f"no door leads from any robot to {room}")
    return replace(case, site=case.site.model_copy(update={"door": doors}), culprits=culprits)


@mutation
def only_who_cannot_do_it_can_get_there(rng: Random, case: Case) -> Case | None:
    """The room has no door, and only the drone is in it."""
    mutated = unreachable_room(rng, case)
    if mutated is None:
        return None
    room = mutated.culprits[1].split()[-1]
    node = next(n for n in case.plan.nodes if mutated.culprits[0].startswith(f"node {n.id} "))
    if node.action in case.abilities["drone-1"].skills:
        return None
    robots = tuple(r.model_copy(update={"room": room}) if r.id == "drone-1" else r for r in case.world.robots)
    world = case.world.model_copy(update={"robots": robots})
    return replace(mutated, world=world, culprits=(mutated.culprits[0], f"to {room}", "no door leads"))


@mutation
def double_grasp(rng: Random, case: Case) -> Case | None:
    """One robot takes another thing before it puts the first down."""
    puts = {n.same_robot_as: n for n in case.nodes("put") if n.same_robot_as}
    take = _one(rng, [n for n in case.nodes("pickup") if n.id in puts])
    other = next(_free(case, "pickupable"), None)
    if take is None or other is None:
        return None
    second = PlanNode(id="second", action="pickup", object=other.id, same_robot_as=take.id, after=(take.id,))
    put = puts[take.id]
    waits = put.model_copy(update={"after": (*put.after, "second")})
    nodes = [waits if n is put else n for n in case.plan.nodes]
    return case.with_nodes([*nodes, second], "node second (pickup)", "double grasp", f"still has {take.object}")


@mutation
def more_things_than_hands(rng: Random, case: Case) -> Case | None:
    things = list(_free(case, "pickupable"))
    hands = sum("pickup" in has.skills for has in case.abilities.values())
    if len(things) <= hands:
        return None
    chosen = things[: hands + 1]
    nodes = [PlanNode(id=f"take-{i}", action="pickup", object=o.id) for i, o in enumerate(chosen)]
    return case.with_nodes([*case.nodes(), *nodes], "in hands at once", *(o.id for o in chosen))


@mutation
def taken_twice(rng: Random, case: Case) -> Case | None:
    take = _one(rng, case.nodes("pickup"))
    if take is None:
        return None
    again = PlanNode(id="again", action="pickup", object=take.object, after=(take.id,))
    nodes = [n for n in case.nodes() if n.item != take.object]
    kept = {n.id for n in nodes}
    nodes = [n.model_copy(update={"after": tuple(a for a in n.after if a in kept)}) for n in nodes]
    return case.with_nodes([*nodes, again], "node again (pickup)", f"{take.object} is already in a hand")


@mutation
def sliced_without_a_blade(rng: Random, case: Case) -> Case | None:
    food = next(_free(case, "sliceable"), None)
    if (
        food is None
        or case.nodes("slice")
        or any(case.objects[n.object or ""].type == "Knife" for n in case.nodes("pickup"))
    ):
        return None
    cut = PlanNode(id="cut", action="slice", object=food.id)
    return case.with_nodes([*case.nodes(), cut], "node cut (slice)", "slicing needs a", "Knife")


@mutation
def cleaned_with_a_full_hand(rng: Random, case: Case) -> Case | None:
    take, dirty = _one(rng, case.nodes("pickup")), next(_free(case, "dirtyable"), None)
    puts = {n.same_robot_as: n for n in case.nodes("put")}
    if take is None or dirty is None or take.id not in puts:
        return None
    wash = PlanNode(id="wash", action="clean", object=dirty.id, same_robot_as=take.id, after=(take.id,))
    put = puts[take.id]
    nodes = [n.model_copy(update={"after": (*n.after, "wash")}) if n is put else n for n in case.plan.nodes]
    return case.with_nodes([*nodes, wash], "node wash (clean)", "needs an empty hand", take.object or "")


@mutation
def what_is_sliced_is_carried(rng: Random, case: Case) -> Case | None:
    take = _one(rng, [n for n in case.nodes("pickup") if "Tomato" in case.objects[n.object or ""].type])
    if take is None:
        return None
    sliced = PropertyState(value=True, confidence=0.9, source="cam-1", stamp_s=0.0)
    objects = tuple(
        o.model_copy(update={"props": {**o.props, "isSliced": sliced}}) if o.id == take.object else o
        for o in case.world.objects
    )
    world = case.world.model_copy(update={"objects": objects})
    return replace(case, world=world, culprits=(f"node {take.id} (pickup)", f"{take.object} has been sliced"))


@mutation
def nobody_there(rng: Random, case: Case) -> Case | None:
    empty: dict[str, Ability] = {}
    return replace(case, abilities=empty, culprits=("no robot is there",))


@mutation
def field_left_out(rng: Random, case: Case) -> Case | None:
    node = _one(rng, [n for n in case.nodes() if n.object])
    return node and case.changed(node, f"node {node.id} ({node.action})", "names no object", object=None)


@mutation
def item_left_out(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes("put"))
    return node and case.changed(node, f"node {node.id} (put)", "which item", item=None)


@mutation
def search_nowhere(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes("explore"))
    return node and case.changed(node, f"node {node.id} (explore)", "names no room", room=None)
