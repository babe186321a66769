"""Actions that only a robot knows: legal when it announces them, with the parameters that it announces, without effect."""

import json

import pytest

from hub import effects
from hub.ability import Ability
from hub.announced import parameter_fault
from hub.checks import faults
from hub.floor import FloorPlan
from hub.world import World
from tests.hub.scenes import ACTIONS, batch, flat, report, seen
from wire.messages.command import Result
from wire.messages.plan import Plan, PlanNode

SCHEMA = json.dumps(
    {
        "properties": {
            "target": {"$ref": "#/$defs/Target"},
            "height_m": {"type": "number"},
            "soft": {"type": "boolean"},
        },
        "required": ["target"],
    }
)
ABILITIES = {"dog-1": Ability(ACTIONS), "lift-1": Ability(("raise_desk",), parameters={"raise_desk": SCHEMA})}


def _world() -> World:
    world = World(flat(), seed=0)
    for k in range(10):
        world.observe(batch("cam-1", 0.1 * k, seen("Desk", 2.0, 2.0, 0.7), seq=k))
        world.delta(0.1 * k)
    world.report_robot(report("lift-1", 1.0, 1.0, 1.0))
    world.delta(1.0)
    return world


def _node(**fields: object) -> PlanNode:
    return PlanNode.model_validate({"id": "n1", "action": "raise_desk"} | fields)


def test_what_a_robot_announces_may_be_planned() -> None:
    world = _world()
    desk = world.snapshot(1.0).objects[0].id
    plans = [
        Plan(id="p", task="t", planner="toy", goals=(), nodes=(_node(object=desk, params=params),))
        for params in ({}, {"height_m": 1.1, "soft": True}, {"height_m": 1}, {"height_m": "high"})
    ]
    found = [faults(plan, world.snapshot(1.0), ABILITIES, FloorPlan(flat())) for plan in plans]
    assert found[:3] == [[], [], []]
    assert found[3] == ["node n1 (raise_desk): height_m must be a number, not 'high'"]
    alone = faults(plans[0], world.snapshot(1.0), {"dog-1": Ability(ACTIONS)}, FloorPlan(flat()))
    assert alone == ["node n1 (raise_desk): no robot can raise_desk"]


@pytest.mark.parametrize(
    ("fields", "fault"),
    [
        ({}, "object is missing; it takes object, height_m, soft"),
        ({"object": "desk-1", "room": "bath"}, "room is no parameter of it; it takes object, height_m, soft"),
        ({"object": "desk-1", "params": {"width_m": 1.0}}, "width_m is no parameter of it; it takes object"),
        ({"object": "desk-1", "params": {"height_m": True}}, "height_m must be a number, not True"),
        ({"object": "desk-1", "params": {"soft": 1}}, "soft must be a boolean, not 1"),
    ],
)
def test_parameters_are_those_of_the_announced_schema(fields: dict[str, object], fault: str) -> None:
    assert parameter_fault(_node(**fields), SCHEMA).startswith(fault)


@pytest.mark.parametrize("schema", ["", "[", "[" * 2000, "3", '{"properties": 3}', '{"required": 3}'])
def test_a_schema_that_is_none_is_said_so(schema: str) -> None:
    assert "no JSON schema" in parameter_fault(_node(), schema)


def test_a_schema_may_say_little_of_a_parameter() -> None:
    schema = '{"properties": {"target": 3, "height_m": 3, "mode": {"anyOf": [{"type": "string"}, {"type": "null"}]}}}'
    assert parameter_fault(_node(params={"height_m": 1.0, "mode": "soft"}), schema) == ""


@pytest.mark.parametrize(("status", "code"), [("done", "ok"), ("failed", "not_there"), ("failed", "closed")])
def test_an_unknown_action_changes_nothing_that_is_believed(status: str, code: str) -> None:
    world = _world()
    world.delta(2.0)
    before = world.snapshot(2.0)
    node = _node(object=before.objects[0].id)
    result = Result(goal_id="g", robot="lift-1", stamp_s=2.0, status=status, code=code)
    effects.apply(world, node, "lift-1", result, {})
    assert world.delta(2.0) is None
    assert world.snapshot(2.0) == before
