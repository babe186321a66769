"""Looks from above in plain words: who gets the nodes, when the goals hold, and what is said where nobody flies."""

import pytest

from planners.planner import PLANNERS
from tests.planners.test_tasks import furnished
from tests.planners.toy import site
from wire.goals import holds
from wire.messages.plan import PlanReply, PlanRequest
from wire.messages.world import RobotState, RobotStatus, WorldState

FLYING = ("take_off", "land", "goto", "inspect_from_above", "construct_map")


def drone(status: RobotStatus = "idle", id: str = "drone-1") -> RobotState:
    return RobotState(
        id=id, kind="drone", position_enu_m=(4.0, 4.0, 0.0), yaw_deg=0.0, status=status, skills=FLYING,
        stamp_s=1.0, room="kitchen",
    )  # fmt: skip


def world(*more: RobotState) -> WorldState:
    house = furnished(1, ())
    for thing in house.things.values():
        if thing.type != "Bed":
            house.see(house.dogs[0], thing)
    state = house.world()
    return state.model_copy(update={"robots": (*state.robots, *more)})


def ask(instruction: str, state: WorldState, *failures: str) -> PlanReply:
    request = PlanRequest(
        task="t", epoch=1, instruction=instruction, world=state, failures=failures, now_s=state.stamp_s
    )
    return PLANNERS["scripted"](site()).make_plan(request)


@pytest.mark.parametrize(
    ("instruction", "action", "object", "room"),
    [
        ("inspect the kitchen from above", "inspect_from_above", None, "kitchen"),
        ("take a picture of the kitchen from above", "inspect_from_above", None, "kitchen"),
        ("fly over the living room", "inspect_from_above", None, "living-room"),
        ("look at the sofa from above with the drone", "inspect_from_above", "sofa-1", None),
        ("survey bedroom 1", "construct_map", None, "bedroom-1"),
    ],
)
def test_only_who_can_fly_is_given_it(instruction: str, action: str, object: str | None, room: str | None) -> None:
    plan = ask(instruction, world(drone())).plan
    assert plan is not None
    assert plan.complete
    (node,) = plan.nodes
    assert (node.action, node.object, node.room) == (action, object, room)
    assert (node.req_skills, node.preferred_robot) == ((action,), "drone-1")


def test_with_other_work_each_does_what_it_can() -> None:
    plan = ask("inspect the kitchen from above and open the fridge", world(drone())).plan
    assert plan is not None
    doers = {node.action: node.preferred_robot for node in plan.nodes}
    assert doers["inspect_from_above"] == "drone-1"
    assert doers["open"] != "drone-1"


def test_a_thing_that_is_not_known_is_looked_for_on_the_floor_first() -> None:
    plan = ask("look at the bed from above", world(drone())).plan
    assert plan is not None
    assert not plan.complete
    assert {node.action for node in plan.nodes} == {"explore"}
    assert all(node.preferred_robot != "drone-1" for node in plan.nodes)


@pytest.mark.parametrize(
    ("instruction", "robots", "why"),
    [
        ("inspect the kitchen from above", (), "no robot here can look from above: that takes a drone"),
        ("survey the kitchen", (), "announces construct_map"),
        ("look at the bed from above", (), "no robot here can look from above"),
        ("inspect the kitchen from above", (drone("lost"),), "only drone-1 can look from above, and is not there now"),
        (
            "survey the kitchen",
            (drone("lost"), drone("lost", "drone-2")),
            "only drone-1 and drone-2 can look from above, and are not there now",
        ),
    ],
)
def test_where_nobody_flies_it_is_refused_with_the_reason(instruction: str, robots, why: str) -> None:
    refusal = ask(instruction, world(*robots)).refusal
    assert refusal is not None
    assert why in refusal.reason


def test_what_fails_again_and_again_is_given_up_with_the_last_reason() -> None:
    sentence = "drone-1 could not inspect_from_above kitchen: there is nowhere to see it from at 2.1 m"
    assert ask("inspect the kitchen from above", world(drone()), sentence).plan is not None
    refusal = ask("inspect the kitchen from above", world(drone()), *(3 * [sentence])).refusal
    assert refusal is not None
    assert refusal.reason == sentence


def test_it_holds_once_the_world_says_so() -> None:
    state = world(drone())
    plan = ask("survey the kitchen and look at the sofa from above", state).plan
    assert plan is not None
    assert [holds(goal, state) for goal in plan.goals] == [False, False]
    seen = state.model_copy(
        update={
            "areas": tuple(a.model_copy(update={"surveyed": a.id == "kitchen"}) for a in state.areas),
            "objects": tuple(o.model_copy(update={"seen_from_above": o.type == "Sofa"}) for o in state.objects),
        }
    )
    assert [holds(goal, seen) for goal in plan.goals] == [True, True]
    done = ask("survey the kitchen and look at the sofa from above", seen).plan
    assert done is not None
    assert done.nodes == ()
