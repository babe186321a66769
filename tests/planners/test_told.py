"""A skill that is asked for by its name: one that only its robot knows."""

import json
import re

import pytest

from planners.planner import PLANNERS
from tests.planners.test_tasks import furnished
from tests.planners.toy import site
from wire.messages.plan import PlanReply, PlanRequest, SkillCard

RAISE = SkillCard(
    name="raise_desk",
    doc="Raise a desk.",
    parameters=json.dumps({"properties": {"target": {}, "height_m": {"type": "number"}}, "required": ["target"]}),
)
GOTO = SkillCard(name="goto", doc="Be somewhere.", parameters=json.dumps({"properties": {"room": {}, "height_m": {}}}))
MOP = SkillCard(name="mop", doc="Mop a room.", parameters=json.dumps({"properties": {"room": {}}}))


def ask(instruction: str, *failures: str) -> PlanReply:
    house = furnished(1, ())
    for thing in house.things.values():
        house.see(house.dogs[0], thing)
    request = PlanRequest(
        task="t",
        epoch=1,
        instruction=instruction,
        world=house.world(),
        skills=(RAISE, MOP, GOTO),
        failures=failures,
        now_s=0.0,
    )
    return PLANNERS["scripted"](site()).make_plan(request)


@pytest.mark.parametrize(
    ("instruction", "objects", "room", "params", "robot"),
    [
        ("do raise_desk on desk-1", ("desk-1",), None, {}, None),
        ("do raise_desk on the desk in bedroom-1 height_m=1.1", ("desk-1",), None, {"height_m": 1.1}, None),
        ("Do raise_desk on all desks height_m=1", ("desk-1", "desk-2"), None, {"height_m": 1}, None),
        ("dog-1: do mop in the kitchen", (None,), "kitchen", {}, "dog-1"),
        ("dog-1: do goto in the kitchen height_m=1.2", (None,), "kitchen", {"height_m": 1.2}, "dog-1"),
        ("do mop mode=wet", (None,), None, {"mode": "wet"}, None),
    ],
)
def test_a_named_skill_is_a_plan(instruction, objects, room, params, robot) -> None:
    plan = ask(instruction).plan
    assert plan is not None
    assert tuple(node.object for node in plan.nodes) == objects
    for node in plan.nodes:
        assert (node.room, node.params, node.preferred_robot) == (room, params, robot)
        assert node.action in ("raise_desk", "mop", "goto")


@pytest.mark.parametrize(
    ("instruction", "why"),
    [
        ("do raise_roof on desk-1", "no robot here announces the skill raise_roof; .* goto, mop, raise_desk"),
        ("do raise_desk on the desk", "which one is 'the desk'"),
        ("do raise_desk on the laptop", "nothing is known yet of 'the laptop'"),
        ("do raise_desk on the moon", "I do not understand"),
        ("fly-1: do mop", "there is no robot fly-1; the robots are dog-1"),
    ],
)
def test_what_cannot_be_done_is_refused_in_a_sentence(instruction: str, why: str) -> None:
    refusal = ask(instruction).refusal
    assert refusal is not None
    assert re.search(why, refusal.reason), refusal.reason


def test_a_skill_that_fails_again_and_again_is_given_up() -> None:
    sentence = "lift-1 could not raise_desk desk-1: the motor is stuck"
    assert ask("do raise_desk on desk-1", sentence, sentence).plan is not None
    refusal = ask("do raise_desk on desk-1", *(3 * [sentence])).refusal
    assert refusal is not None
    assert refusal.reason == sentence


def test_a_restraint_is_no_skill() -> None:
    plan = ask("do not open the fridge, go to the kitchen").plan
    assert plan is not None
    assert plan.goals[0].forbidden
