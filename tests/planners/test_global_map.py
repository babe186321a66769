"""One map of what robots from above and others have seen: which pairs are asked about, and what a plan is made on then."""

import json

from planners.hierarchical.global_map import doubtful_pairs, integrated
from planners.hierarchical.planner import Hierarchical
from planners.prompt import Names
from planners.writing.dialogue import Dialogue
from tests.planners.emulated_model import EmulatedModel
from tests.planners.scripted_model import WrittenModel
from tests.planners.test_tasks import furnished
from tests.planners.toy import ROOMS, site
from wire.messages.plan import PlanRequest
from wire.messages.world import ObjectState, RobotState, WorldState


def seen_twice(apart_m: float, **twin: object) -> WorldState:
    """A furnished house whose mug a drone has seen, too, as a thing of its own."""
    world = furnished(1, tuple(id for id, _, _ in ROOMS)).world()
    mug = next(obj for obj in world.objects if obj.id == "mug-1")
    x, y, z = mug.position_enu_m
    fields = {
        "id": "mug-9",
        "position_enu_m": (x + apart_m, y, z),
        "source": "drone-1",
        "seen_by": ("drone-1",),
        "confidence": 0.7,
    }
    drone = RobotState(
        id="drone-1", kind="drone", position_enu_m=(1.0, 1.0, 1.5), yaw_deg=0.0, status="idle",
        skills=("construct_map",), stamp_s=1.0, room="kitchen",
    )  # fmt: skip
    other: ObjectState = mug.model_copy(update=fields | twin)
    return world.model_copy(update={"objects": (*world.objects, other), "robots": (*world.robots, drone)})


def asked(world: WorldState) -> PlanRequest:
    return PlanRequest(task="t", epoch=1, instruction="put all the mugs in the sink", world=world, now_s=1.0)


def ids(world: WorldState) -> set[str]:
    return {obj.id for obj in world.objects if obj.type == "Mug"}


def test_only_what_may_be_one_thing_is_asked_about() -> None:
    assert [{a.id, b.id} for a, b in doubtful_pairs(seen_twice(0.3))] == [{"mug-1", "mug-9"}]
    assert doubtful_pairs(seen_twice(1.5)) == []
    assert doubtful_pairs(seen_twice(0.3, type="Vase")) == []
    assert len(doubtful_pairs(seen_twice(0.3, type="Vase", maybe={"Mug": 0.4}))) == 1
    assert doubtful_pairs(seen_twice(0.3, seen_by=("drone-1", "dog-1"))) == [], "fusion has joined them already"
    silent = WrittenModel(["!unreachable"])
    world = seen_twice(1.5)
    assert integrated(asked(world), Names(), Dialogue(silent)) is world
    assert silent.asked == []


def test_the_entry_that_fewer_have_confirmed_is_left_out() -> None:
    world, names = seen_twice(0.3), Names()
    names.learn(world)
    same = {"same": [{"names": [names.short("mug-9"), names.short("mug-1")], "why": "one mug"}]}
    assert ids(integrated(asked(world), names, Dialogue(WrittenModel([json.dumps(same)])))) == {"mug-1", "mug-2"} & ids(
        world
    )
    assert ids(integrated(asked(world), names, Dialogue(WrittenModel(['{"same": []}'])))) == ids(world)


def test_a_pair_that_nobody_asked_about_is_refused() -> None:
    world, names = seen_twice(0.3), Names()
    names.learn(world)
    model = WrittenModel(['{"same": [{"names": ["apple1", "mug1"]}]}', '{"same": []}'])
    dialogue = Dialogue(model)
    assert ids(integrated(asked(world), names, dialogue)) == ids(world)
    assert "none of the pairs that may be the same" in model.asked[1].user
    assert len(dialogue.judged) == 1


def test_a_plan_is_made_on_the_map_that_was_made_one() -> None:
    for apart_m, mugs in ((0.3, {"mug-1"}), (1.0, {"mug-1", "mug-9"})):
        model = EmulatedModel()
        world = seen_twice(apart_m)
        others = ids(world) - {"mug-1", "mug-9"}
        reply = Hierarchical(site(), model).make_plan(asked(world))
        assert model.purposes[0] == "global_map"
        assert reply.plan is not None
        assert {n.object for n in reply.plan.nodes if n.action == "pickup"} == mugs | others
