"""One thing from many looks."""

import random

from hypothesis import given, settings
from hypothesis import strategies as st

from hub.world import World
from tests.hub.scenes import batch, flat, report, seen, view
from wire.messages.observation import Absence


def _objects(world: World, now_s: float, type: str) -> list:
    world.delta(now_s)
    return [o for o in world.snapshot(now_s).objects if o.type == type]


@given(seed=st.integers(0, 10_000), sources=st.integers(1, 5))
@settings(max_examples=40, deadline=None)
def test_one_mug_seen_by_many_sources_is_one_mug(seed: int, sources: int) -> None:
    world, rng = World(flat()), random.Random(seed)
    for look in range(12):
        for k in range(sources):
            source = "dog-1" if k == 4 else f"cam-{k + 1}"
            sigma = 0.04 if k == 4 else 0.12
            x, y = 2.0 + rng.gauss(0.0, sigma), 2.0 + rng.gauss(0.0, sigma)
            world.observe(batch(source, 0.5 * look, seen("Mug", x, y, 0.9, f"{source}-{look // 5}", sigma)))
        world.delta(0.5 * look)
    mugs = _objects(world, 8.0, "Mug")
    assert len(mugs) == 1
    x, y, _ = mugs[0].position_enu_m
    assert abs(x - 2.0) < 0.25
    assert abs(y - 2.0) < 0.25
    assert len(mugs[0].seen_by) == sources


def test_two_mugs_in_one_picture_stay_two() -> None:
    world = World(flat())
    for look in range(6):
        world.observe(batch("cam-1", look, seen("Mug", 2.0, 2.0, 0.9, "a"), seen("Mug", 2.15, 2.0, 0.9, "b")))
        world.delta(look)
    assert len(_objects(world, 6.0, "Mug")) == 2


def test_a_robots_sight_dominates_a_camera() -> None:
    world = World(flat())
    for look in range(10):
        world.observe(batch("cam-1", look, seen("Mug", 2.3, 2.0, 0.9, sigma_m=0.2)))
        world.observe(batch("dog-1", look, seen("Mug", 2.0, 2.0, 0.9, sigma_m=0.03), view=view(0.5, 2.0)))
    (mug,) = _objects(world, 10.0, "Mug")
    assert abs(mug.position_enu_m[0] - 2.0) < 0.06
    assert mug.verified


def test_a_single_weak_look_is_not_told() -> None:
    world = World(flat())
    world.observe(batch("cam-1", 0.0, seen("Mug", 2.0, 2.0, 0.9, confidence=0.6)))
    assert _objects(world, 0.1, "Mug") == []


def test_confused_types_are_settled_by_votes() -> None:
    world = World(flat())
    for look in range(10):
        type = "Potato" if look in (0, 4) else "Apple"
        world.observe(batch("cam-1", look, seen(type, 2.0, 2.0, 0.9, f"t{look}")))
        world.delta(look)
    world.delta(10.0)
    objects = world.snapshot(10.0).objects
    assert [o.type for o in objects] == ["Apple"]


def test_gone_needs_more_than_one_look() -> None:
    world = World(flat())
    for look in range(8):
        world.observe(batch("cam-1", 0.5 * look, seen("Mug", 2.0, 2.0, 0.9)))
    gone = Absence(track="t1", type="Mug", position_enu_m=(2.0, 2.0, 0.9), confidence=0.9)
    left = []
    for look in range(12):
        stamp = 5.0 + 0.5 * look
        world.observe(batch("cam-1", stamp).model_copy(update={"gone": (gone,)}))
        left.append(len(_objects(world, stamp, "Mug")))
    assert left[:2] == [1, 1]
    assert left[-1] == 0


def test_an_unseen_mug_in_plain_view_of_a_robot_is_given_up_and_the_camera_loses_trust() -> None:
    world = World(flat())
    for look in range(20):
        world.observe(batch("cam-1", 0.5 * look, seen("Mug", 2.0, 2.0, 0.9)))
    before = world.trust.probability("cam-1")
    for look in range(24):
        world.observe(batch("dog-1", 20.0 + 0.5 * look, view=view(0.8, 2.0)))
        world.delta(20.0 + 0.5 * look)
    assert _objects(world, 35.0, "Mug") == []
    assert world.trust.probability("cam-1") < before


def test_a_robots_look_overrides_a_lying_camera_and_costs_it_nothing_to_see_the_mug_again() -> None:
    world = World(flat())
    for look in range(10):
        world.observe(batch("cam-1", look, seen("Television", 2.0, 2.0, 0.9, isToggled=0.05)))
    for look in range(3):
        world.observe(batch("dog-1", 10.0 + look, seen("Television", 2.0, 2.0, 0.9, isToggled=0.95), view=view(0.5, 2)))
        world.observe(batch("cam-1", 10.2 + look, seen("Television", 2.0, 2.0, 0.9, isToggled=0.05)))
    (tv,) = _objects(world, 13.0, "Television")
    assert tv.props["isToggled"].value is True
    assert tv.props["isToggled"].contradicted_by == ("cam-1",)


def test_a_camera_that_changes_its_mind_after_the_robots_look_is_heard() -> None:
    world = World(flat())
    for look in range(5):
        world.observe(batch("dog-1", look, seen("Television", 2.0, 2.0, 0.9, isToggled=0.95), view=view(0.5, 2)))
        world.observe(batch("cam-1", look + 0.2, seen("Television", 2.0, 2.0, 0.9, isToggled=0.9)))
    for look in range(60):
        world.observe(batch("cam-1", 6.0 + look, seen("Television", 2.0, 2.0, 0.9, isToggled=0.05)))
        world.delta(6.0 + look)
    (tv,) = _objects(world, 66.0, "Television")
    assert tv.props["isToggled"].value is False


def test_nothing_new_is_made_of_a_robots_body() -> None:
    world = World(flat())
    world.report_robot(report("dog-1", 2.0, 2.0, 0.0))
    for look in range(5):
        world.observe(batch("cam-1", look, seen("Box", 2.1, 2.0, 0.3)))
    assert _objects(world, 5.0, "Box") == []


def test_confidence_fades_with_age() -> None:
    world = World(flat())
    for look in range(6):
        world.observe(batch("dog-1", look, seen("Mug", 2.0, 2.0, 0.9), view=view(0.5, 2.0)))
    (fresh,) = _objects(world, 6.0, "Mug")
    (old,) = _objects(world, 3600.0, "Mug")
    assert old.confidence < 0.5 * fresh.confidence


def test_the_same_messages_give_the_same_world() -> None:
    def play() -> str:
        world, rng = World(flat()), random.Random(5)
        for look in range(30):
            looks = [seen("Mug", rng.uniform(0, 8), rng.uniform(0, 4), 0.9, f"t{i}") for i in range(20)]
            world.observe(batch(f"cam-{look % 3}", 0.5 * look, *looks))
            world.delta(0.5 * look)
            world.upkeep(0.5 * look)
        return world.snapshot(20.0).model_dump_json()

    assert play() == play()


def test_one_piece_of_furniture_taken_for_two_types_is_one() -> None:
    world = World(flat())
    for look in range(10):
        world.observe(batch("cam-1", look, seen("ArmChair", 2.0, 2.0, 0.44, "a", confidence=0.5)))
        world.observe(batch("dog-1", look + 0.1, seen("Sofa", 2.1, 2.0, 0.46, "s"), view=view(0.5, 2.0)))
        world.delta(look)
        world.upkeep(look)
    world.delta(11.0)
    assert [o.type for o in world.snapshot(11.0).objects] == ["Sofa"]


def test_what_one_robot_sees_another_that_overlooks_it_does_not_undo() -> None:
    world = World(flat())
    for look in range(12):
        world.observe(batch("dog-2", 0.5 * look, seen("Plate", 2.0, 2.0, 0.78), view=view(0.5, 2.0)))
    for look in range(60):
        world.observe(batch("dog-1", 20.0 + 0.5 * look, view=view(0.8, 2.0)))
        world.delta(20.0 + 0.5 * look)
    (plate,) = _objects(world, 51.0, "Plate")
    assert plate.confidence < 0.95


def test_standing_and_staring_is_one_opinion() -> None:
    world = World(flat())
    for look in range(60):
        world.observe(batch("dog-1", 0.5 * look, seen("ArmChair", 2.5, 2.0, 0.4, "a"), view=view(0.5, 2.0)))
    for k in range(5):
        for look in range(4):
            at = view(0.5 + 0.1 * k, 1.0 + 0.5 * k)
            world.observe(batch("dog-2", 30.0 + 2.0 * k + 0.5 * look, seen("Sofa", 2.5, 2.0, 0.4, f"s{k}"), view=at))
    world.delta(45.0)
    world.upkeep(45.0)
    (sofa,) = [o for o in world.snapshot(45.0).objects if o.type in ("Sofa", "ArmChair")]
    assert sofa.type == "Sofa"
    assert sofa.maybe == {"ArmChair": 0.17}


def test_a_thing_is_taken_for_what_a_plan_says_until_looks_say_otherwise() -> None:
    world = World(flat())
    for look in range(4):
        world.observe(batch("cam-1", 0.5 * look, seen("ArmChair", 2.5, 2.0, 0.4, "a")))
    world.delta(2.0)
    (chair,) = _objects(world, 2.0, "ArmChair")
    assert world.take_for({chair.id: "Sofa", "obj-none": "Sofa"}) == [
        f"the ArmChair {chair.id} is taken for the Sofa, which was found nowhere"
    ]
    assert world.take_for({chair.id: "Sofa"}) == []
    assert [o.id for o in _objects(world, 2.5, "Sofa")] == [chair.id]
    for k in range(9):
        for look in range(4):
            at = view(0.5, 0.5 + 0.4 * k)
            world.observe(batch("dog-1", 3.0 + 2.0 * k + 0.5 * look, seen("ArmChair", 2.5, 2.0, 0.4, "b"), view=at))
    world.delta(22.0)
    world.upkeep(22.0)
    assert [o.type for o in world.snapshot(22.0).objects] == ["ArmChair"]
