"""Drones among robots on the floor: who holds up whom, who is sent, and what a body in the air hides."""

import pytest

from hub import effects
from hub.assignment import FORBIDDEN
from hub.directions import Directions
from hub.dispatch import Dispatch
from hub.memory import read_world, write_world
from hub.plan import PlanRun
from hub.world import World
from tests.hub.scenes import batch, card, flat, report, seen
from wire.messages.command import Result, RobotReport, TrafficOrder
from wire.messages.plan import Plan, PlanNode, SkillCard
from wire.model import Vec2, Vec3

FLYING = ("take_off", "land", "goto", "inspect_from_above")


def flying(id: str, at: Vec3, *path: Vec3, airborne: bool = True, battery: float | None = 0.9) -> RobotReport:
    return RobotReport(
        robot=id, seq=1, stamp_s=1.0, position_enu_m=at, yaw_rad=0.0, status="idle", airborne=airborne,
        battery=battery, path_m=tuple(p[:2] for p in path), path_heights_m=tuple(p[2] for p in path),
    )  # fmt: skip


def walking(id: str, at: Vec2, *path: Vec2) -> RobotReport:
    return report(id, *at, 0.0).model_copy(update={"path_m": path, "stamp_s": 1.0})


def fleet(*reports: RobotReport) -> World:
    world = World(flat())
    for told in reports:
        world.report_robot(told)
        skills = tuple(SkillCard(name=name, doc="", parameters="{}") for name in FLYING)
        own = card(told.robot)
        is_drone = told.robot.startswith("drone")
        world.fleet.take_card(own.model_copy(update={"kind": "drone", "skills": skills}) if is_drone else own)
    return world


def orders(*reports: RobotReport) -> dict[str, TrafficOrder]:
    world = fleet(*reports)
    return {o.robot: o for o in Directions(flat(), world.floor, world.things).orders(world.fleet.here(), 1.0)}


def test_in_the_air_a_drone_neither_holds_up_nor_makes_way() -> None:
    told = orders(walking("dog-1", (0.8, 2.0), (3.3, 2.0), (6.0, 2.0)), flying("drone-1", (2.0, 2.0, 1.5)))
    assert told["dog-1"].go
    assert told["dog-1"].others_m == ()
    assert (told["drone-1"].go, told["drone-1"].step_aside_m) == (True, None)
    through = orders(
        walking("dog-1", (3.2, 2.0), (6.0, 2.0)), flying("drone-1", (4.4, 2.0, 1.6), (3.0, 2.0, 1.6), (2.0, 2.0, 1.5))
    )
    assert through["dog-1"].go
    assert through["drone-1"].go


@pytest.mark.parametrize("airborne", [False, True])
def test_on_the_floor_and_low_over_it_a_drone_is_in_the_way(airborne: bool) -> None:
    height_m = 0.6 if airborne else 0.0
    told = orders(
        walking("dog-1", (1.1, 2.0), (3.3, 2.0), (6.0, 2.0)), flying("drone-1", (2.0, 2.0, height_m), airborne=airborne)
    )
    assert not told["dog-1"].go
    assert told["dog-1"].others_m == ((2.0, 2.0),)


def test_who_takes_off_or_lands_is_not_told_to_make_way() -> None:
    dog = walking("dog-1", (1.1, 2.0), (3.3, 2.0), (6.0, 2.0))
    idle = orders(dog, flying("drone-1", (2.0, 2.0, 0.6)))
    assert idle["drone-1"].step_aside_m is not None
    rising = orders(dog, flying("drone-1", (2.0, 2.0, 0.2)).model_copy(update={"goal_id": "g-1"}))
    assert (rising["drone-1"].go, rising["drone-1"].step_aside_m) == (True, None)
    assert not rising["dog-1"].go


def test_a_fleet_without_drones_is_told_nothing_of_the_air() -> None:
    told = orders(walking("dog-1", (1.0, 2.0), (3.0, 2.0)), walking("dog-2", (6.0, 2.0)))
    for order in told.values():
        assert not {"height_m", "column_taken", "land_at_m"} & set(order.model_dump())
    state = fleet(walking("dog-1", (1.0, 2.0))).snapshot(1.0)
    assert not {"battery", "airborne"} & set(state.robots[0].model_dump())
    assert not {"surveyed", "seen_from_above"} & set(state.areas[0].model_dump())


def test_height_and_battery_reach_the_world_state() -> None:
    (robot,) = fleet(flying("drone-1", (2.0, 2.0, 1.5), battery=0.61)).snapshot(1.0).robots
    assert (robot.airborne, robot.battery, robot.position_enu_m[2]) == (True, 0.61, 1.5)


def test_under_a_drone_the_floor_can_be_seen() -> None:
    world = fleet(flying("drone-1", (2.0, 2.0, 1.5)), walking("dog-1", (6.0, 2.0)))
    assert not world.fleet.near((2.0, 2.0, 0.1))
    assert world.fleet.near((2.1, 2.0, 1.4))
    assert world.fleet.near((6.0, 2.1, 0.3))
    assert not world.fleet.near((6.0, 2.1, 1.5))


def cost(world: World, robot: str, node: PlanNode) -> tuple[float, str]:
    run = PlanRun(Plan(id="p", task="t", planner="x", goals=(), nodes=(node,)), {})
    dispatch, step = Dispatch(world.floor, world.things), run.steps[node.id]
    doer = world.fleet.robot(robot)
    return dispatch._cost(run, step, doer, frozenset({robot}), frozenset(), 1.0), dispatch.short_of_power(step, doer)


def test_a_drone_is_sent_as_far_as_its_battery_brings_it_back() -> None:
    node = PlanNode(id="n1", action="inspect_from_above", room="bath")
    near = PlanNode(id="n1", action="inspect_from_above", room="kitchen")
    low = fleet(flying("drone-1", (2.0, 2.0, 0.0), airborne=False, battery=0.29))
    assert cost(low, "drone-1", near)[0] < FORBIDDEN
    price, why = cost(low, "drone-1", node)
    assert price == FORBIDDEN
    assert why == "the battery of drone-1 is at 29%; 33% is needed for the way there and back"
    assert cost(low, "drone-1", PlanNode(id="n1", action="land"))[0] < FORBIDDEN
    silent = fleet(flying("drone-1", (2.0, 2.0, 0.0), airborne=False, battery=None))
    assert cost(silent, "drone-1", node)[0] < FORBIDDEN


@pytest.mark.parametrize(("endurance_s", "goes"), [(240.0, False), (480.0, False), (1200.0, True), (None, False)])
def test_what_a_drone_knows_of_its_endurance_goes_before_the_guess(endurance_s: float | None, goes: bool) -> None:
    node = PlanNode(id="n1", action="inspect_from_above", room="bath")
    said = flying("drone-1", (2.0, 2.0, 0.0), airborne=False, battery=0.29)
    price, why = cost(fleet(said.model_copy(update={"endurance_s": endurance_s})), "drone-1", node)
    assert (price < FORBIDDEN) is goes
    assert bool(why) is not goes


def test_what_needs_hands_is_never_given_to_a_drone() -> None:
    world = fleet(flying("drone-1", (2.0, 2.0, 1.5)))
    assert cost(world, "drone-1", PlanNode(id="n1", action="open", object="fridge-1"))[0] == FORBIDDEN


def test_looks_from_above_are_rather_for_who_flies() -> None:
    world = fleet(flying("drone-1", (6.0, 2.0, 1.5)), walking("dog-1", (2.0, 2.0)))
    pole = card("dog-1")
    look = SkillCard(name="inspect_from_above", doc="", parameters="{}")
    world.fleet.take_card(pole.model_copy(update={"skills": (*pole.skills, look)}))
    node = PlanNode(id="n1", action="inspect_from_above", room="kitchen")
    assert cost(world, "drone-1", node)[0] < cost(world, "dog-1", node)[0]


def test_what_was_flown_over_outlives_a_hub_and_not_a_task() -> None:
    world = fleet(flying("drone-1", (2.0, 2.0, 1.5)))
    for look in range(4):
        world.observe(batch("cam-1", 0.5 * look, seen("Sofa", 2.0, 3.0, 0.4)))
        world.delta(0.5 * look)
    (sofa,) = world.things
    result = Result(goal_id="g-1", robot="drone-1", stamp_s=2.0, status="done", code="ok")
    for node in (
        PlanNode(id="n1", action="inspect_from_above", object=sofa.id),
        PlanNode(id="n2", action="construct_map", room="bath"),
    ):
        effects.apply(world, node, "drone-1", result, {})
    again = World(flat())
    read_world(again, write_world(world))
    for believed in (world, again):
        believed.delta(2.0)
        state = believed.snapshot(2.0)
        assert [o.seen_from_above for o in state.objects] == [True]
        assert [a.id for a in state.areas if a.surveyed] == ["bath"]
        believed.begin_task()
        state = believed.snapshot(2.0)
        assert not any(o.seen_from_above for o in state.objects)
        assert not any(a.surveyed for a in state.areas)
