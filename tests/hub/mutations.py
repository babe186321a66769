"""One fault put into a plan that can be carried out, and the words that a true objection to it must have."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from random import Random

from hub.ability import Ability
from hub.floor import FloorPlan
from hub.graph import ancestors
from wire.catalogue import catalogue
from wire.messages.goal import Goal, Selector
from wire.messages.plan import Plan, PlanNode
from wire.messages.world import ObjectState, WorldState
from wire.site import Site

FLAGS = {
    "pickup": "pickupable", "open": "openable", "close": "openable", "toggle_on": "toggleable",
    "toggle_off": "toggleable", "slice": "sliceable", "clean": "dirtyable", "put": "receptacle",
}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """A plan and all that it is checked against. `culprits`: words that stand together in one objection."""

    plan: Plan
    world: WorldState
    abilities: Mapping[str, Ability]
    site: Site
    culprits: tuple[str, ...] = ()

    @property
    def floor(self) -> FloorPlan:
        return FloorPlan(self.site)

    @property
    def objects(self) -> dict[str, ObjectState]:
        return {o.id: o for o in self.world.objects}

    def nodes(self, *actions: str) -> list[PlanNode]:
        return [n for n in self.plan.nodes if not actions or n.action in actions]

    def with_nodes(self, nodes: list[PlanNode], *culprits: str) -> "Case":
        return replace(self, plan=self.plan.model_copy(update={"nodes": tuple(nodes)}), culprits=culprits)

    def changed(self, node: PlanNode, *culprits: str, **fields: object) -> "Case":
        """The same plan with one node's fields changed."""
        new = node.model_copy(update=fields)
        return self.with_nodes([new if n is node else n for n in self.plan.nodes], *culprits)

    def without(self, node: PlanNode, *culprits: str) -> "Case":
        """Whoever waited for the node waits for what it waited for."""
        nodes = []
        for other in self.plan.nodes:
            if other is node:
                continue
            after = [a for a in other.after if a != node.id] + (list(node.after) if node.id in other.after else [])
            same = None if other.same_robot_as == node.id else other.same_robot_as
            nodes.append(other.model_copy(update={"after": tuple(dict.fromkeys(after)), "same_robot_as": same}))
        return self.with_nodes(nodes, *culprits)

    def before(self) -> dict[str, set[str]]:
        left, order = list(self.plan.nodes), []
        while left:
            ready = next(n for n in left if set(n.after) <= set(order))
            left.remove(ready)
            order.append(ready.id)
        return ancestors(self.plan, order)


Mutation = Callable[[Random, Case], Case | None]
MUTATIONS: dict[str, Mutation] = {}


def mutation(make: Mutation) -> Mutation:
    MUTATIONS[make.__name__] = make
    return make


def _one(rng: Random, nodes: list[PlanNode]) -> PlanNode | None:
    return rng.choice(nodes) if nodes else None


def _free(case: Case, flag: str, but: bool = False) -> Iterator[ObjectState]:
    """Objects that no node names, lie openly and have (or have not) a flag."""
    named = {id for n in case.plan.nodes for id in (n.object, n.item)}
    for obj in case.world.objects:
        holder = case.objects.get(obj.receptacle or "")
        if obj.id not in named and catalogue()[obj.type].can(flag) != but and (holder is None or _lies_openly(holder)):
            yield obj


def _lies_openly(holder: ObjectState) -> bool:
    return not catalogue()[holder.type].must_open


@mutation
def unknown_object(rng: Random, case: Case) -> Case | None:
    node = _one(rng, [n for n in case.nodes() if n.object])
    return node and case.changed(node, f"node {node.id} ", "there is no object obj-9999", object="obj-9999")


@mutation
def object_of_a_wrong_spelling(rng: Random, case: Case) -> Case | None:
    node = _one(rng, [n for n in case.nodes() if n.object])
    if node is None:
        return None
    return case.changed(
        node, f"node {node.id} ", f"no object {node.object}x", f"{node.object} (", object=f"{node.object}x"
    )


@mutation
def room_for_an_object(rng: Random, case: Case) -> Case | None:
    node, room = _one(rng, [n for n in case.nodes() if n.object]), case.site.room[0].id
    return node and case.changed(node, f"node {node.id} ", f"there is no object {room}", object=room)


@mutation
def unknown_item(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes("put"))
    return node and case.changed(node, f"node {node.id} ", "there is no object ghost-1", item="ghost-1")


@mutation
def unknown_room(rng: Random, case: Case) -> Case | None:
    node = _one(rng, [n for n in case.nodes() if n.room])
    return node and case.changed(node, f"node {node.id} ", "there is no room attic", room="attic")


@mutation
def unknown_robot(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    return node and case.changed(node, f"node {node.id} ", "dog-77", "no such robot", preferred_robot="dog-77")


@mutation
def unknown_type(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes("explore"))
    return node and case.changed(node, f"node {node.id} ", "Unicorn is no type", looking_for=("Unicorn",))


@mutation
def point_outside(rng: Random, case: Case) -> Case | None:
    far = PlanNode(id="far", action="goto", point_m=(77.5, -3.0))
    return case.with_nodes([*case.nodes(), far], "node far ", "(77.5, -3) lies outside")


@mutation
def cycle(rng: Random, case: Case) -> Case | None:
    before = case.before()
    pairs = [(n, id) for n in case.nodes() for id in sorted(i for i, b in before.items() if n.id in b)]
    if not pairs:
        return None
    first, last = rng.choice(pairs)
    return case.changed(first, "in a circle", first.id, last, after=(*first.after, last))


@mutation
def waits_for_itself(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    return node and case.changed(node, "in a circle", node.id, after=(*node.after, node.id))


@mutation
def waits_for_nothing_there(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    return node and case.changed(node, f"node {node.id} waits for n-404", after=(*node.after, "n-404"))


@mutation
def robot_of_nothing_there(rng: Random, case: Case) -> Case | None:
    node = _one(rng, case.nodes())
    return node and case.changed(node, f"node {node.id} wants the robot of n-404", same_robot_as="n-404")


@mutation
def duplicated_node_id(rng: Random, case: Case) -> Case | None:
    if len(case.plan.nodes) < 2:
        return None
    one, other = rng.sample(list(case.plan.nodes), 2)
    return case.changed(one, f"node {other.id} appears 2 times", id=other.id)


@mutation
def goal_index_out_of_range(rng: Random, case: Case) -> Case | None:
    node, index = _one(rng, case.nodes()), rng.choice((len(case.plan.goals), 99, -1))
    return node and case.changed(node, f"node {node.id} serves goal {index}", goal=index)


@mutation
def goal_after_no_goal(rng: Random, case: Case) -> Case | None:
    late = Goal(predicate="visited", subject=Selector(room=case.site.room[0].id), after=(40,))
    goals = (*case.plan.goals, late)
    plan = case.plan.model_copy(update={"goals": goals})
    return replace(case, plan=plan, culprits=(f"goal {len(goals) - 1} ", "goal 40"))


@mutation
def missing_dependency_on_pickup(rng: Random, case: Case) -> Case | None:
    node = _one(rng, [n for n in case.nodes("put") if n.item])
    return node and case.changed(node, f"node {node.id} (put)", node.item or "", after=())


@mutation
def item_not_in_hand(rng: Random, case: Case) -> Case | None:
    puts = {n.item: n for n in case.nodes("put")}
    take = _one(rng, [n for n in case.nodes("pickup") if n.object in puts])
    if take is None:
        return None
    return case.without(take, f"node {puts[take.object].id} (put)", f"nobody has {take.object} in hand")


@mutation
def another_item_than_was_taken(rng: Random, case: Case) -> Case | None:
    put, other = _one(rng, case.nodes("put")), next(_free(case, "pickupable"), None)
    if put is None or other is None:
        return None
    return case.changed(put, f"node {put.id} (put)", f"nobody has {other.id} in hand", item=other.id)


@mutation
def put_by_another_robot(rng: Random, case: Case) -> Case | None:
    put = _one(rng, [n for n in case.nodes("put") if n.same_robot_as])
    other = next((n for n in case.nodes("pickup") if put is not None and n.id != put.same_robot_as), None)
    if put is None or other is None:
        return None
    return case.changed(
        put, f"node {put.id} (put)", f"same_robot_as must be {put.same_robot_as}", same_robot_as=other.id
    )


@mutation
def closed_container(rng: Random, case: Case) -> Case | None:
    """The node that opens it is left out."""
    shut = [
        n
        for n in case.nodes("open")
        if sum(o.object == n.object for o in case.nodes("open")) == 1
        and (prop := case.objects[n.object or ""].props.get("isOpen")) is not None
        and not prop.value
        and any(_needs_open(case, o, n.object or "") for o in case.nodes("put", "pickup"))
    ]
    node = _one(rng, shut)
    return node and case.without(node, f"{node.object}", "is closed")


def _needs_open(case: Case, node: PlanNode, holder: str) -> bool:
    return node.object == holder or case.objects[node.object or ""].receptacle == holder


@mutation
def opened_too_late(rng: Random, case: Case) -> Case | None:
    """Nobody waits for the opening."""
    mutated = closed_container(rng, case)
    if mutated is None:
        return None
    ids = {n.id for n in mutated.plan.nodes}
    opening = next(n for n in case.plan.nodes if n.id not in ids)
    return mutated.with_nodes([*mutated.nodes(), opening.model_copy(update={"after": ()})], *mutated.culprits)


@mutation
def wrong_skill(rng: Random, case: Case) -> Case | None:
    """An action that the thing does not afford."""
    pairs = [
        (node, action)
        for node in case.nodes("pickup", "open", "toggle_on", "toggle_off", "clean")
        for action, flag in FLAGS.items()
        if action != "put" and not catalogue()[case.objects[node.object or ""].type].can(flag)
    ]
    if not pairs:
        return None
    node, action = rng.choice(pairs)
    mutated = case.changed(node, f"node {node.id} ({action})", f"which is not {FLAGS[action]}", action=action)
    return replace(mutated, culprits=(*mutated.culprits, node.object or ""))


@mutation
def put_onto_what_holds_nothing(rng: Random, case: Case) -> Case | None:
    put = _one(rng, case.nodes("put"))
    holder = next((o for o in _free(case, "receptacle", but=True)), None)
    if put is None or holder is None:
        return None
    return case.changed(
        put, f"node {put.id} (put)", f"{holder.id} is a {holder.type}", "not receptacle", object=holder.id
    )


@mutation
def put_into_itself(rng: Random, case: Case) -> Case | None:
    put = _one(rng, [n for n in case.nodes("put") if catalogue()[case.objects[n.item or ""].type].can("receptacle")])
    return put and case.changed(put, f"node {put.id} (put)", f"{put.item} cannot be put into itself", object=put.item)
