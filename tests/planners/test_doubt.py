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
    assert [(n.action, n.object) for n in plan.nodes] == ([("inspect", "lamp-2")] if looked_at else [])
    assert plan.complete != looked_at
