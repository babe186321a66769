"""Carries out plans in the toy house, one ready node at a time, and asks for the next plan until the task ends."""

from collections.abc import Callable

from planners.planner import Planner
from tests.planners.toy import Dog, House
from wire.goals import holds
from wire.messages.goal import Goal
from wire.messages.plan import Plan, PlanNode, PlanReply, PlanRequest
from wire.messages.world import WorldState


def run(
    house: House,
    planner: Planner,
    instruction: str,
    most_plans: int = 40,
    check: Callable[[Plan, WorldState], None] = lambda plan, world: None,
) -> tuple[PlanReply, tuple[Goal, ...], list[PlanReply]]:
    """Plan and carry out until the goals hold as far as is believed, or the planner refuses."""
    goals: tuple[Goal, ...] | None = None
    failures: list[str] = []
    replies: list[PlanReply] = []
    for _ in range(most_plans):
        world = house.world()
        request = PlanRequest(
            task="t-1",
            epoch=1,
            instruction=instruction,
            goals=goals,
            world=world,
            failures=tuple(failures[-8:]),
            now_s=world.stamp_s,
        )
        reply = planner.make_plan(request)
        replies.append(reply)
        if reply.plan is None:
            return reply, goals or (), replies
        goals = reply.plan.goals
        check(reply.plan, world)
        if not reply.plan.nodes:
            assert reply.plan.complete
            assert all(holds(g, world) for g in goals)
            return reply, goals, replies
        failure = _carry_out(house, reply.plan.nodes)
        if failure is not None:
            failures.append(failure)
        elif reply.plan.complete and all(holds(g, house.world()) for g in goals):
            return reply, goals, replies
    raise AssertionError(f"no end after {most_plans} plans of {instruction!r}")


def _carry_out(house: House, nodes: tuple[PlanNode, ...]) -> str | None:
    """Ready nodes one at a time, in a random order that keeps the edges; until one fails or something is found."""
    done: set[str] = set()
    doers: dict[str, str] = {}
    while len(done) < len(nodes):
        ready = [n for n in nodes if n.id not in done and set(n.after) <= done]
        assert ready, "the nodes wait for each other"
        pairs = [(n, d) for n in ready for d in house.dogs if _may(n, d, doers)]
        assert pairs, f"nobody can do any of {ready}"
        own = [(n, d) for n, d in pairs if n.preferred_robot == d.id]
        node, dog = house.rng.choice(own or pairs)
        known = {t.id for t in house.things.values() if t.known}
        failure = house.do(node, dog)
        if failure is not None:
            return failure
        done.add(node.id)
        doers[node.id] = dog.id
        new = [t for t in house.things.values() if t.known and t.id not in known]
        if any(t.type in node.looking_for for t in new):
            return None
    return None


def _may(node: PlanNode, dog: Dog, doers: dict[str, str]) -> bool:
    if node.action == "put":
        return dog.hand == node.item
    if node.item is not None:
        return dog.hand == node.item
    if node.action == "pickup":
        return dog.hand is None
    return True
