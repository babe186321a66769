"""W and F: places, parents, rooms, doors that hide, and deltas."""

import random

from hypothesis import given, settings
from hypothesis import strategies as st

from hub import effects
from hub.memory import read_world, write_world
from hub.world import World
from tests.hub.scenes import batch, card, flat, report, seen, view
from wire.messages.command import Result
from wire.messages.plan import PlanNode
from wire.messages.world import ObjectState


def _kitchen() -> World:
    world = World(flat())
    world.fleet.take_card(card("dog-1"))
    world.report_robot(report("dog-1", 0.5, 0.5, 0.0))
    for look in range(6):
        world.observe(
            batch(
                "cam-1",
                0.5 * look,
                seen("DiningTable", 2.0, 2.0, 0.38, "table"),
                seen("Apple", 2.1, 2.2, 0.83, "apple"),
                seen("Fridge", 3.4, 3.4, 0.92, "fridge", isOpen=0.05),
            )
        )
        world.delta(0.5 * look)
    return world


def _one(world: World, type: str, now_s: float = 3.0) -> ObjectState:
    (found,) = [o for o in world.snapshot(now_s).objects if o.type == type]
    return found


def _act(world: World, action: str, target: str, item: str | None = None, now_s: float = 4.0, **result: object) -> None:
    node = PlanNode(id="n-1", action=action, object=_one(world, target).id, item=_one(world, item).id if item else None)
    outcome = {"goal_id": "g-1", "robot": "dog-1", "stamp_s": now_s, "status": "done", "code": "ok", **result}
    effects.apply(world, node, "dog-1", Result.model_validate(outcome), {})
    world.delta(now_s)


def test_an_apple_on_a_table_is_in_the_kitchen_on_the_table() -> None:
    world = _kitchen()
    apple = _one(world, "Apple")
    assert apple.receptacle == _one(world, "DiningTable").id
    assert apple.room == "kitchen"


def test_pickup_and_put_reparent_as_equation_5_says() -> None:
    world = _kitchen()
    _act(world, "open", "Fridge")
    assert _one(world, "Fridge").props["isOpen"].value is True
    _act(world, "pickup", "Apple", now_s=5.0)
    apple = _one(world, "Apple")
    assert apple.receptacle == "dog-1"
    assert world.fleet.robots["dog-1"].inventory == apple.id
    world.report_robot(report("dog-1", 3.0, 3.0, 6.0, holding=True, status="executing"))
    world.delta(6.0)
    assert _one(world, "Apple").position_enu_m[:2] == (3.0, 3.0)
    _act(world, "put", "Fridge", item="Apple", now_s=7.0, point_enu_m=(3.4, 3.4, 1.0))
    assert _one(world, "Apple").receptacle == _one(world, "Fridge").id
    assert world.fleet.robots["dog-1"].inventory is None


def test_what_is_shut_in_is_neither_denied_nor_moved_by_sights() -> None:
    world = _kitchen()
    _act(world, "open", "Fridge")
    _act(world, "pickup", "Apple", now_s=5.0)
    _act(world, "put", "Fridge", item="Apple", now_s=7.0, point_enu_m=(3.4, 3.4, 1.0))
    _act(world, "close", "Fridge", now_s=8.0)
    apple = _one(world, "Apple")
    for look in range(40):
        world.observe(batch("dog-1", 10.0 + 0.5 * look, view=view(2.5, 3.4)))
        world.delta(10.0 + 0.5 * look)
    after = _one(world, "Apple", 30.0)
    assert after.position_enu_m == apple.position_enu_m
    assert after.confidence >= apple.confidence - 0.01


def test_a_carried_apple_seen_by_a_camera_is_still_that_apple() -> None:
    world = _kitchen()
    _act(world, "pickup", "Apple", now_s=5.0)
    for step in range(20):
        x = 1.0 + 0.3 * step
        world.report_robot(report("dog-1", x, 1.0, 6.0 + step, holding=True, status="executing"))
        world.observe(batch("cam-1", 6.0 + step, seen("Apple", x + 0.2, 1.0, 0.6, f"m{step}")))
        world.delta(6.0 + step)
    assert _one(world, "Apple").receptacle == "dog-1"


def test_a_robot_that_lost_what_it_held_no_longer_has_it() -> None:
    world = _kitchen()
    _act(world, "pickup", "Apple", now_s=5.0)
    world.report_robot(report("dog-1", 1.0, 1.0, 6.0, holding=False))
    world.delta(6.0)
    assert _one(world, "Apple").receptacle is None
    assert world.fleet.robots["dog-1"].inventory is None


def test_not_there_removes_it() -> None:
    world = _kitchen()
    _act(world, "pickup", "Apple", now_s=5.0, status="failed", code="not_there")
    assert [o.type for o in world.snapshot(6.0).objects if o.type == "Apple"] == []


def test_deltas_carry_only_changes_and_add_up_to_the_snapshot() -> None:
    world, rng = World(flat()), random.Random(1)
    told: dict[str, ObjectState] = {}
    last = 0
    for look in range(60):
        looks = [seen("Mug", 0.5 + i, 1.0, 0.9, f"t{i}", confidence=rng.uniform(0.4, 1.0)) for i in range(6)]
        world.observe(batch("cam-1", 0.1 * look, *looks))
        delta = world.delta(0.1 * look)
        if delta is None:
            continue
        assert delta.seq == last + 1
        last = delta.seq
        told |= {o.id: o for o in delta.objects}
        for id in delta.removed:
            told.pop(id)
    assert world.delta(6.0) is None
    assert set(told) == {o.id for o in world.snapshot(6.0).objects}


@given(seed=st.integers(0, 1000))
@settings(max_examples=25, deadline=None)
def test_parents_form_a_forest(seed: int) -> None:
    world, rng = World(flat()), random.Random(seed)
    types = ("Box", "Bowl", "Plate", "Mug", "DiningTable", "Apple", "Fridge", "Shelf", "SideTable", "CounterTop")
    places = [
        (rng.choice(types), rng.uniform(0.2, 3.8), rng.uniform(0.2, 3.8), rng.uniform(0.0, 1.2)) for _ in range(25)
    ]
    for look in range(5):
        world.observe(batch("dog-1", look, *(seen(*p, f"t{i}") for i, p in enumerate(places)), view=view(0.5, 2)))
        world.delta(look)
    parents = {o.id: o.receptacle for o in world.snapshot(5.0).objects}
    for id in parents:
        walked: set[str] = set()
        while id is not None:
            assert id not in walked
            walked.add(id)
            id = parents.get(id)


def test_a_camera_that_insists_on_what_a_hand_did_not_find_is_not_believed() -> None:
    world = _kitchen()
    _act(world, "pickup", "Apple", now_s=5.0, status="failed", code="not_there")
    for look in range(20):
        world.observe(batch("cam-1", 6.0 + look, seen("Apple", 2.1, 2.2, 0.83, "again")))
        world.delta(6.0 + look)
    assert [o for o in world.snapshot(26.0).objects if o.type == "Apple"] == []


def test_what_was_denied_takes_the_other_name_that_was_heard() -> None:
    world = _kitchen()
    _act(world, "pickup", "Apple", now_s=5.0, status="failed", code="not_there")
    for look in range(8):
        type = "Tomato" if look in (2, 4, 6) else "Apple"
        world.observe(batch("cam-1", 6.0 + look, seen(type, 2.1, 2.2, 0.83, f"t{look}")))
        world.delta(6.0 + look)
    assert [o.type for o in world.snapshot(15.0).objects if o.type in ("Apple", "Tomato")] == ["Tomato"]


def test_what_is_seen_at_a_closed_fridge_is_not_in_it() -> None:
    world = _kitchen()

    def look(stamp_s: float, is_open: float) -> None:
        for k in range(6):
            tomato = seen("Tomato", 3.3, 3.3, 0.9, "tomato")
            fridge = seen("Fridge", 3.4, 3.4, 0.92, "fridge", isOpen=is_open)
            world.observe(batch("cam-1", stamp_s + k, tomato, fridge))
            world.delta(stamp_s + k)

    look(4.0, 0.05)
    assert _one(world, "Tomato", 10.0).receptacle is None
    look(12.0, 0.95)
    assert _one(world, "Tomato", 20.0).receptacle == _one(world, "Fridge", 20.0).id


def test_who_looks_into_something_open_has_looked_into_it_until_the_task_ends() -> None:
    world = _kitchen()
    _act(world, "inspect", "Fridge")
    assert not _one(world, "Fridge").looked_into, "it is closed"
    _act(world, "open", "Fridge", now_s=5.0)
    _act(world, "inspect", "Fridge", now_s=6.0, status="cancelled", code="cancelled")
    assert not _one(world, "Fridge").looked_into
    _act(world, "inspect", "Fridge", now_s=7.0)
    assert _one(world, "Fridge").looked_into
    restarted = World(flat())
    read_world(restarted, write_world(world))
    assert _one(restarted, "Fridge").looked_into
    world.begin_task()
    assert not _one(world, "Fridge").looked_into


def test_a_hand_holds_what_it_took_whatever_is_believed() -> None:
    world = _kitchen()
    apple = _one(world, "Apple")
    thing = world.things.get(apple.id)
    assert thing is not None
    world.things.remove(thing)
    took = PlanNode(id="n-1", action="pickup", object=apple.id)
    result = Result(goal_id="g-1", robot="dog-1", stamp_s=5.0, status="done", code="ok", holding=True)
    effects.apply(world, took, "dog-1", result, {apple.id: "Apple"})
    delta = world.delta(5.0)
    assert delta is not None
    assert apple.id not in delta.removed
    assert (_one(world, "Apple").id, _one(world, "Apple").receptacle) == (apple.id, "dog-1")
    assert world.fleet.robots["dog-1"].inventory == apple.id
    world.things.remove(world.things.by_id[apple.id])
    put = PlanNode(id="n-2", action="put", object=_one(world, "Fridge").id, item=apple.id)
    effects.apply(world, put, "dog-1", result.model_copy(update={"holding": False}), {apple.id: "Apple"})
    assert world.fleet.robots["dog-1"].inventory is None
    assert world.things.by_id[apple.id].receptacle == _one(world, "Fridge").id
