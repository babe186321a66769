"""A hub and a planner that know nothing of drones give one its work, by what it announces."""

import pytest

from devices.drone.core import DroneCore
from devices.goals_journal import open_journal
from hub.coordinator import Coordinator
from hub.journal import Journal
from planners.core import build
from tests.devices.drone.flat import flat
from tests.devices.drone.scripted import ScriptedPilot
from tests.hub.scenes import seen
from tests.hub.toys import ToyCamera
from wire.loopback import LoopbackMesh
from wire.messages.operator import TaskQuery, TaskRequest, TaskState


def asked(instruction: str) -> tuple[TaskState, DroneCore]:
    site = flat()
    core = DroneCore(site, "drone-1", open_journal(), lambda row: ScriptedPilot())
    mesh = LoopbackMesh()
    mesh.add(Coordinator(site, "hub", Journal(None)), "hub", "hub")
    mesh.add(build(site, "planner"), "planner", "planner")
    mesh.add(ToyCamera("cam-1", lambda now_s: [seen("Fridge", 7.0, 2.0, 0.92, "fridge")]), "cctv-1", "cctv")
    mesh.add(core, "drone-1", "robot")
    mesh.run(3.0)
    mesh.call("task", TaskRequest(task="t-1", instruction=instruction))
    for _ in range(120):
        mesh.run(0.5)
        state = mesh.call("task_query", TaskQuery(task="t-1"))
        assert isinstance(state, TaskState)
        if state.status not in ("planning", "running"):
            return state, core
    raise AssertionError(f"{instruction}: still {state.status}: {state.log}")


@pytest.mark.parametrize(
    ("instruction", "room"),
    [
        ("do inspect_from_above in the kitchen", "east"),
        ("drone-1: do take_off height_m=1.2", "west"),
        ("do construct_map in the kitchen spacing_m=1.5", "east"),
        ("inspect the kitchen from above", "east"),
        ("inspect the fridge from above", "east"),
        ("do look_at on the fridge distance_m=1.1", "east"),
        ("drone-1: look at the living room from above height_m=1.6", "west"),
    ],
)
def test_it_is_given_what_it_can_do(instruction, room):
    state, core = asked(instruction)
    assert state.status == "done", (state.reason, state.refusal, state.log)
    assert core.craft.airborne
    assert (core.craft.position_m[0] > 4.0) == (room == "east")


def test_what_it_cannot_do_reaches_the_operator_in_words():
    state, _ = asked("do follow_path way_m=nonsense")
    assert state.status == "failed"
    assert "is not three numbers" in state.reason
