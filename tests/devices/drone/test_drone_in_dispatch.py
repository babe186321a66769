"""A hub and a planner that know nothing of drones give one its work, by what it announces."""

from dataclasses import replace
from math import dist

import pytest

from devices.drone.core import DroneCore
from devices.goals_journal import open_journal
from hub.coordinator import Coordinator
from hub.journal import Journal
from planners.core import build
from tests.devices.drone.flat import flat
from tests.devices.drone.scripted import STANDING, ScriptedPilot
from tests.hub.scenes import seen
from tests.hub.toys import ToyCamera, ToyRobot
from wire.loopback import LoopbackMesh
from wire.messages.operator import TaskQuery, TaskRequest, TaskState
from wire.messages.world import SnapshotRequest, WorldState


def asked(instruction: str) -> tuple[TaskState, DroneCore]:
    state, core, _ = asked_on_mesh(instruction)
    return state, core


def asked_on_mesh(instruction: str, battery: float = 0.9) -> tuple[TaskState, DroneCore, LoopbackMesh]:
    site, pilot = flat(), ScriptedPilot()
    pilot.says = replace(pilot.says, battery=battery)
    core = DroneCore(site, "drone-1", open_journal(), lambda row: pilot)
    mesh = LoopbackMesh()
    mesh.add(Coordinator(site, "hub", Journal(None)), "hub", "hub")
    mesh.add(build(site, "planner"), "planner", "planner")
    mesh.add(ToyCamera("cam-1", lambda now_s: [seen("Fridge", 7.0, 2.0, 0.92, "fridge")]), "cctv-1", "cctv")
    mesh.add(core, "drone-1", "robot")
    mesh.run(3.0)
    mesh.call("task", TaskRequest(task="t-1", instruction=instruction))
    for _ in range(400):
        mesh.run(0.5)
        state = mesh.call("task_query", TaskQuery(task="t-1"))
        assert isinstance(state, TaskState)
        if state.status not in ("planning", "running"):
            return state, core, mesh
    raise AssertionError(f"{instruction}: still {state.status}: {state.log}")


@pytest.mark.parametrize(
    ("instruction", "room"),
    [
        ("do inspect_from_above in the kitchen", "east"),
        ("drone-1: do take_off height_m=1.2", "west"),
        ("do construct_map in the kitchen spacing_m=1.5", "east"),
        ("inspect the kitchen from above", "east"),
        ("inspect the fridge from above", "east"),
        ("look at the fridge from above with the drone", "east"),
        ("take a picture of the kitchen from above", "east"),
        ("survey the kitchen", "east"),
        ("fly over the kitchen, then the living room", "west"),
        ("do look_at on the fridge distance_m=1.1", "east"),
        ("drone-1: look at the living room from above height_m=1.6", "west"),
    ],
)
def test_it_is_given_what_it_can_do(instruction, room):
    state, core = asked(instruction)
    assert state.status == "done", (state.reason, state.refusal, state.log)
    assert core.craft.airborne
    assert (core.craft.position_m[0] > 4.0) == (room == "east")


@pytest.mark.parametrize(
    ("instruction", "fact"), [("inspect the kitchen from above", "seen_from_above"), ("survey the kitchen", "surveyed")]
)
def test_that_a_room_was_flown_over_is_a_fact_of_the_world(instruction, fact):
    state, _, mesh = asked_on_mesh(instruction)
    assert [goal.holds for goal in state.goals] == [True]
    world = mesh.call("snapshot", SnapshotRequest())
    assert isinstance(world, WorldState)
    assert {area.id for area in world.areas if getattr(area, fact)} == {"east"}
    (drone,) = world.robots
    assert (drone.airborne, drone.battery) == (True, 0.9)


def test_a_battery_that_does_not_do_for_the_way_back_is_named():
    state, core, _ = asked_on_mesh("inspect the kitchen from above", battery=0.22)
    assert state.status == "failed"
    assert "drone-1 could not inspect_from_above east: the battery of drone-1 is at 22%" in state.reason
    assert not core.craft.airborne


def test_without_a_drone_it_is_refused_with_the_reason():
    mesh = LoopbackMesh()
    mesh.add(Coordinator(flat(), "hub", Journal(None)), "hub", "hub")
    mesh.add(build(flat(), "planner"), "planner", "planner")
    mesh.add(ToyRobot(flat(), "dog-1", (1.0, 1.0)), "dog-1", "robot")
    mesh.run(3.0)
    mesh.call("task", TaskRequest(task="t-1", instruction="inspect the kitchen from above"))
    mesh.run(10.0)
    state = mesh.call("task_query", TaskQuery(task="t-1"))
    assert isinstance(state, TaskState)
    assert state.status == "refused"
    assert "no robot here can look from above: that takes a drone" in state.reason


def two_drones() -> tuple[LoopbackMesh, list[DroneCore]]:
    site = flat()
    twin = site.robot[0].model_copy(update={"id": "drone-2", "start_m": (3.0, 3.0)})
    process = site.process[1].model_copy(update={"id": "drone-2"})
    site = site.model_copy(update={"robot": (*site.robot, twin), "process": (*site.process, process)})
    mesh = LoopbackMesh()
    mesh.add(Coordinator(site, "hub", Journal(None)), "hub", "hub")
    mesh.add(build(site, "planner"), "planner", "planner")
    cores = []
    for row, at_m in zip(site.robot, ((1.0, 1.0, 0.0), (3.0, 3.0, 0.0)), strict=True):
        pilot = ScriptedPilot()
        pilot.says = replace(STANDING, position_enu_m=at_m)
        cores.append(DroneCore(site, row.id, open_journal(), lambda row, pilot=pilot: pilot))
        mesh.add(cores[-1], row.id, "robot")
    return mesh, cores


def test_two_drones_in_two_rooms_keep_clear_of_each_other():
    mesh, (first, second) = two_drones()
    mesh.run(3.0)
    words = "inspect the kitchen from above and survey the living room and survey the kitchen"
    mesh.call("task", TaskRequest(task="t-1", instruction=words))
    beside_m, flown = 9.0, set()
    for _ in range(4000):
        mesh.run(0.1)
        a, b = first.craft.position_m, second.craft.position_m
        flown |= {core.craft.id for core in (first, second) if core.craft.airborne}
        if abs(a[2] - b[2]) < 0.3:
            beside_m = min(beside_m, dist(a[:2], b[:2]))
        state = mesh.call("task_query", TaskQuery(task="t-1"))
        assert isinstance(state, TaskState)
        if state.status not in ("planning", "running"):
            break
    assert state.status == "done", (state.reason, state.log)
    assert flown == {"drone-1", "drone-2"}
    assert beside_m > 0.6
    assert {first.craft.level_m, second.craft.level_m} == {1.5, 2.1}


def test_what_it_cannot_do_reaches_the_operator_in_words():
    state, _ = asked("do follow_path way_m=nonsense")
    assert state.status == "failed"
    assert "is not three numbers" in state.reason
