"""Plans of models for dogs and a drone with the skills and cards that they really announce."""

import json

import pytest

from devices.drone.skills import SKILLS as DRONE
from devices.quadruped.skills import SKILLS as QUADRUPED
from hub.ability import Ability
from hub.checks import faults
from hub.floor import FloorPlan
from planners.single_shot import SingleShot
from tests.planners.emulated_model import EmulatedModel
from tests.planners.scripted_model import WrittenModel
from tests.planners.test_tasks import furnished
from tests.planners.test_written_plans import EVERYWHERE, WRITERS
from tests.planners.toy import site
from wire.messages.plan import Plan, PlanRequest
from wire.messages.world import RobotState, WorldState

CARDS = {"quadruped": [s.card() for s in QUADRUPED.values()], "drone": [s.card() for s in DRONE.values()]}
ABILITIES = {
    kind: Ability(tuple(c.name for c in cards), parameters={c.name: c.parameters for c in cards})
    for kind, cards in CARDS.items()
}


def fleet(seed: int) -> PlanRequest:
    """A furnished house with its dogs and a drone."""
    world = furnished(seed, EVERYWHERE).world()
    drone = RobotState(
        id="drone-1", kind="drone", position_enu_m=(3.0, 3.0, 0.0), yaw_deg=0.0, status="idle", skills=tuple(DRONE),
        stamp_s=1.0, room="kitchen",
    )  # fmt: skip
    cards = tuple(dict.fromkeys(card for own in CARDS.values() for card in own))
    return PlanRequest(
        task="t",
        epoch=1,
        instruction="put the apple in the fridge and turn off every TV",
        world=world.model_copy(update={"robots": (*world.robots, drone)}),
        skills=cards,
        now_s=1.0,
    )


def objections(plan: Plan | None, world: WorldState) -> list[str]:
    assert plan is not None
    return faults(plan, world, {robot.id: ABILITIES[robot.kind] for robot in world.robots}, FloorPlan(site()))


@pytest.mark.parametrize("name", WRITERS)
def test_dogs_do_what_takes_hands_and_the_hub_agrees(name: str) -> None:
    for seed in range(4):
        request = fleet(seed)
        plan = WRITERS[name](site(), EmulatedModel()).make_plan(request).plan
        assert objections(plan, request.world) == []
        assert plan is not None
        assert all(node.preferred_robot != "drone-1" for node in plan.nodes)


def test_a_skill_of_the_drones_own_is_planned_with_its_parameters() -> None:
    steps = [
        {"id": "s1", "do": "take_off", "robot": "drone-1", "params": {"height_m": 1.4}},
        {"id": "s2", "do": "construct_map", "room": "kitchen", "robot": "drone-1", "after": ["s1"]},
        {"id": "s3", "do": "inspect_from_above", "object": "fridge1", "after": "s2"},
    ]
    request = fleet(1)
    plan = SingleShot(site(), WrittenModel([json.dumps({"steps": steps})])).make_plan(request).plan
    assert objections(plan, request.world) == []
    assert plan is not None
    assert [(n.action, n.object or n.room, n.params) for n in plan.nodes] == [
        ("take_off", None, {"height_m": 1.4}),
        ("construct_map", "kitchen", {}),
        ("inspect_from_above", "fridge-1", {}),
    ]
