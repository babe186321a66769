"""What is left alone because a goal is believed to hold already, and what is looked at first."""

import pytest

from planners.scripted.planner import ScriptedPlanner
from tests.planners.toy import House, site
from wire.messages.plan import PlanRequest
from wire.messages.world import ObjectState, PropertyState


def lamp(id: str, on: bool, source: str, confidence: float, verified: bool) -> ObjectState:
    return ObjectState(
        id=id,
        type="FloorLamp",
        position_enu_m=(1.0, 1.0, 0.9),
        covariance_m2=(0.01, 0.0, 0.01, 0.01),
        room="living-room",
        source=source,
        stamp_s=0.0,
        confidence=confidence,
        verified=verified,
        props={"isToggled": PropertyState(value=on, confidence=0.97, source=source, stamp_s=0.0)},
    )


@pytest.mark.parametrize(
    ("already_off", "looked_at"),
    [
        (lamp("lamp-2", False, "dog-1", 0.6, verified=False), True),  # a phantom of one look
        (lamp("lamp-2", False, "cam-1", 0.99, verified=False), True),  # nobody but a camera says so
        (lamp("lamp-2", False, "dog-1", 0.99, verified=False), False),
        (lamp("lamp-2", False, "dog-1", 0.6, verified=True), False),
    ],
)
def test_a_lamp_that_may_not_be_there_or_not_be_off_is_looked_at(already_off: ObjectState, looked_at: bool) -> None:
    house = House(1, dogs=1)
    world = house.world()
    objects = (*world.objects, already_off, lamp("lamp-1", True, "cam-1", 0.99, verified=False))
    request = PlanRequest(
        task="t-1",
        epoch=0,
        instruction="turn off the floor lamp",
        world=world.model_copy(update={"objects": objects}),
        now_s=1.0,
    )
    plan = ScriptedPlanner(site()).make_plan(request).plan
    assert plan is not None
    look = {("inspect", "lamp-2")} if looked_at else set()
    assert {(n.action, n.object) for n in plan.nodes} == look | {("toggle_off", "lamp-1")}, (
        "the one that is on is meant"
    )
    assert plan.complete != looked_at


def test_when_the_only_known_lamp_is_off_another_is_looked_for() -> None:
    off = lamp("lamp-2", False, "dog-1", 0.99, verified=True)
    world = House(1, dogs=1).world()
    request = PlanRequest(
        task="t-1",
        epoch=0,
        instruction="turn off the floor lamp",
        world=world.model_copy(update={"objects": (*world.objects, off)}),
        now_s=1.0,
    )
    plan = ScriptedPlanner(site()).make_plan(request).plan
    assert plan is not None
    assert {n.action for n in plan.nodes} == {"explore"}
    assert {n.room for n in plan.nodes} == {area.id for area in world.areas}
    searched = tuple(area.model_copy(update={"searched": True}) for area in world.areas)
    again = request.model_copy(update={"world": request.world.model_copy(update={"areas": searched})})
    plan = ScriptedPlanner(site()).make_plan(again).plan
    assert plan is not None
    assert plan.nodes == ()
    assert plan.complete
