"""The planner as a process: asked over the mesh, answering for the task and epoch it was asked about."""

import time

import pytest

from planners.core import build
from planners.planner import PLANNERS
from tests.planners.test_tasks import furnished, hub_agrees
from tests.planners.toy import site
from wire.loopback import LoopbackMesh
from wire.messages.goal import Goal, Selector
from wire.messages.plan import PlanReply, PlanRequest
from wire.site import SiteError


@pytest.mark.parametrize("name", PLANNERS)
def test_every_planner_answers_over_the_mesh(name: str, model_server: str) -> None:
    reply = check_row(name)
    assert reply.note == "", "nobody else had to plan in its stead"
    assert all(call.outcome == "ok" and call.stand_in for call in reply.calls)


def check_row(name: str) -> PlanReply:
    """What every row of the table must do: plan under its name what the hub agrees to, or refuse with a reason."""
    mesh = LoopbackMesh()
    mesh.add(build(site(), "planner", name), "planner", "planner")
    world = furnished(1, ("kitchen",)).world()
    request = PlanRequest(task="t-9", epoch=4, instruction="turn off every TV", world=world, now_s=0.0)
    reply = mesh.call("make_plan", request, role="hub")
    assert isinstance(reply, PlanReply)
    assert (reply.task, reply.epoch) == ("t-9", 4)
    assert (reply.plan is None) != (reply.refusal is None)
    if reply.plan is not None:
        assert reply.plan.planner == name or reply.note.startswith(f"scripted instead of {name}: ")
        hub_agrees(reply.plan, world)
    else:
        assert reply.refusal.reason
    return reply


def test_the_scripted_planner_plans_it() -> None:
    assert check_row("scripted").plan is not None


def test_an_unknown_planner_is_named() -> None:
    with pytest.raises(SiteError, match="there is no planner 'oracle'"):
        build(site(), "planner", "oracle")


def test_settled_goals_are_not_read_again() -> None:
    world = furnished(1, ("kitchen",)).world()
    goals = (Goal(predicate="visited", subject=Selector(room="kitchen")),)
    request = PlanRequest(task="t", epoch=1, instruction="gibberish", goals=goals, world=world, now_s=0.0)
    reply = PLANNERS["scripted"](site()).make_plan(request)
    assert reply.plan is not None
    assert [node.room for node in reply.plan.nodes] == ["kitchen"]


def test_a_large_world_is_planned_in_time() -> None:
    planner = PLANNERS["scripted"](site())
    took = []
    for seed in range(12):
        house = furnished(seed, ())
        for index in range(60 - len(house.things)):
            house.add("Book", "bedroom-1", "bed-1") if index % 2 else house.add("Mug", "kitchen", "countertop-1")
        for thing in house.things.values():
            house.see(house.dogs[0], thing)
        words = "put all the books on the shelf, all mugs in the sink and turn off every lamp and TV"
        request = PlanRequest(task=f"t-{seed}", epoch=1, instruction=words, world=house.world(), now_s=0.0)
        began = time.process_time()
        reply = planner.make_plan(request)
        took.append(time.process_time() - began)
        assert reply.plan is not None
        assert len(reply.plan.nodes) > 40
    assert sorted(took)[-2] < 0.8


def test_a_refusal_of_endless_words_is_still_a_message() -> None:
    world = furnished(1, ("kitchen",)).world()
    request = PlanRequest(task="t", epoch=1, instruction="xyzzy" * 399, world=world, now_s=0.0)
    reply = PLANNERS["scripted"](site()).make_plan(request)
    assert reply.refusal is not None
    assert reply.refusal.reason.startswith("I do not understand")


@pytest.mark.parametrize("words", ["turn off every TV", "put the apple in the fridge", "find the screwdriver"])
def test_a_thing_that_the_catalogue_does_not_know_stops_nobody(words: str) -> None:
    """A detector of one's own may know more types than the catalogue."""
    world = furnished(1, ("kitchen",)).world()
    fridge = next(obj for obj in world.objects if obj.type == "Fridge")
    strange = (
        fridge.model_copy(update={"id": "obj-t", "type": "Trampoline"}),
        fridge.model_copy(update={"id": "obj-u", "type": "Bell", "receptacle": "obj-t"}),
        fridge.model_copy(update={"id": "obj-v", "type": "Apple", "receptacle": "obj-t"}),
    )
    world = world.model_copy(update={"objects": (*world.objects, *strange)})
    request = PlanRequest(task="t", epoch=0, instruction=words, world=world, now_s=0.0)
    reply = PLANNERS["scripted"](site()).make_plan(request)
    assert (reply.plan is None) != (reply.refusal is None)
