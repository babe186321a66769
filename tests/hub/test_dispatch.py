"""Who does what: the cheapest matching as a whole."""

import random
from itertools import permutations

from hypothesis import given, settings
from hypothesis import strategies as st

from hub.assignment import FORBIDDEN, assign
from hub.dispatch import Dispatch
from hub.distance import Distances
from hub.floor import FloorPlan
from hub.plan import PlanRun
from hub.world import World
from tests.hub.scenes import batch, card, flat, report, seen
from wire.messages.plan import Plan, PlanNode

WEIGHT = "the-weight"
TAKE = PlanNode(id="a", action="pickup", object="obj-3")


def _least(costs: list[list[float]]) -> tuple[int, float]:
    """(fewest unmatched, least cost) by trying everything."""
    rows, columns = len(costs), len(costs[0])
    best = (rows + 1, 0.0)
    for order in permutations([*range(columns), *([None] * rows)], rows):
        if any(c is not None and costs[r][c] >= FORBIDDEN for r, c in enumerate(order)):
            continue
        chosen = [costs[r][c] for r, c in enumerate(order) if c is not None]
        best = min(best, (rows - len(chosen), sum(chosen)))
    return best


@given(seed=st.integers(0, 10_000), rows=st.integers(1, 3), columns=st.integers(1, 4))
@settings(max_examples=60, deadline=None)
def test_the_matching_is_as_good_as_the_best(seed: int, rows: int, columns: int) -> None:
    rng = random.Random(seed)
    costs = [[rng.choice([FORBIDDEN, rng.uniform(0, 20)]) for _ in range(columns)] for _ in range(rows)]
    matched = assign(costs)
    taken = [c for c in matched if c is not None]
    assert len(set(taken)) == len(taken)
    chosen = [costs[r][c] for r, c in enumerate(matched) if c is not None]
    unmatched, cost = _least(costs)
    assert rows - len(chosen) == unmatched
    assert abs(sum(chosen) - cost) < 1e-6


def test_distances_go_through_doors() -> None:
    distances = Distances(FloorPlan(flat()))
    assert abs(distances.walk_m((1.0, 2.0), (11.0, 2.0)) - 10.0) < 1e-6
    assert distances.walk_m((3.9, 0.2), (4.1, 0.2)) > 3.0


def _match(nodes: tuple[PlanNode, ...], busy: frozenset[str] = frozenset(), now_s: float = 0.0, **inventory: str):
    world = World(flat())
    for look in range(4):
        world.observe(batch("cam-1", 0.5 * look, seen("Dumbbell", 2.0, 2.0, 0.1)))
    for id, x, payload_kg in (("dog-1", 1.0, 2.0), ("dog-2", 6.0, 8.0)):
        world.report_robot(report(id, x, 1.0, 0.0))
        world.fleet.take_card(card(id).model_copy(update={"payload_kg": payload_kg}))
        world.fleet.robot(id).inventory = inventory.get(id.replace("-", "_"))
    (weight,) = world.things
    nodes = tuple(n.model_copy(update={"object": weight.id}) if n.object == WEIGHT else n for n in nodes)
    run = PlanRun(Plan(id="p-1", task="t-1", planner="toy", goals=(), nodes=nodes), {})
    run.ready(0.0)
    dispatch = Dispatch(world.floor, world.things)
    robots = list(world.fleet.robots.values())
    return {s.node.id: r.id for s, r in dispatch.match(run, run.ready(0.0), robots, busy, now_s)}


def test_each_robot_takes_what_is_near_as_a_whole() -> None:
    near, far = PlanNode(id="a", action="explore", room="kitchen"), PlanNode(id="b", action="explore", room="bath")
    assert _match((far, near)) == {"a": "dog-1", "b": "dog-2"}


def test_a_wish_is_kept_for_a_while() -> None:
    node = PlanNode(id="a", action="explore", room="kitchen", preferred_robot="dog-1")
    assert _match((node,), busy=frozenset({"dog-1"})) == {}
    assert _match((node,), busy=frozenset({"dog-1"}), now_s=30.0) == {"a": "dog-2"}


def test_only_who_holds_it_puts_it() -> None:
    put = PlanNode(id="a", action="put", object="obj-2", item="obj-1")
    assert _match((put,), dog_2="obj-1") == {"a": "dog-2"}
    assert _match((put,)) == {}


def test_full_hands_take_nothing() -> None:
    assert _match((TAKE,), dog_1="obj-1", dog_2="obj-2") == {}


def test_what_is_heavy_goes_to_who_can_lift_it() -> None:
    assert _match((PlanNode(id="a", action="pickup", object=WEIGHT),)) == {"a": "dog-2"}


def test_who_holds_something_unknown_takes_nothing_more() -> None:
    world = World(flat())
    world.report_robot(report("dog-1", 1.0, 1.0, 0.0, holding=True))
    world.fleet.take_card(card("dog-1"))
    run = PlanRun(Plan(id="p-1", task="t-1", planner="toy", goals=(), nodes=(TAKE,)), {})
    dispatch = Dispatch(world.floor, world.things)
    assert dispatch.match(run, run.ready(0.0), world.fleet.here(), frozenset(), 0.0) == []


def test_who_has_the_knife_slices() -> None:
    world = World(flat())
    for id, x, type in (("dog-1", 1.0, "Mug"), ("dog-2", 6.0, "Knife")):
        world.report_robot(report(id, x, 1.0, 0.0, holding=True))
        world.fleet.take_card(card(id))
        world.fleet.robot(id).inventory = world.things.new(type, (x, 1.0, 0.6), 0.0).id
    cut = PlanNode(id="a", action="slice", object="obj-3")
    run = PlanRun(Plan(id="p-1", task="t-1", planner="toy", goals=(), nodes=(cut,)), {})
    dispatch = Dispatch(world.floor, world.things)
    matched = dispatch.match(run, run.ready(0.0), world.fleet.here(), frozenset(), 0.0)
    assert [robot.id for _, robot in matched] == ["dog-2"]
