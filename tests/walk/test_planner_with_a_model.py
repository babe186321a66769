"""A planner's process with a model, over real sockets both ways: Zenoh to the hub's side, HTTP to the stand-in."""

import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.ollama_double.at_hand import Says
from tests.ollama_double.scenarios import Sequence
from tests.ollama_double.server import State, running
from tests.planners.test_tasks import furnished
from tests.planners.toy import site
from tests.walk.mesh import WalkMesh
from wire.link import link_for
from wire.messages.plan import PlanReply, PlanRequest
from wire.node import ZenohNode
from wire.site import load_site

pytestmark = pytest.mark.walk
TABLE = """
[[process]]
id = "planner"
role = "planner"
module = "tests.planners.visits"
[planner]
name = "visits"
host = "{host}"
timeout_s = {timeout_s}
"""


@pytest.fixture
def mesh(tmp_path: Path) -> Iterator[WalkMesh]:
    mesh = WalkMesh(tmp_path, mode="wall")
    with mesh:
        yield mesh


def house() -> str:
    """The rooms and doors of the toy house, for a site file."""
    rooms = [
        f'[[room]]\nid = "{r.id}"\nname = "{r.name}"\nkind = "{r.kind}"\npolygon_m = {[list(p) for p in r.polygon_m]}\n'
        for r in site().room
    ]
    doors = [
        f'[[door]]\nid = "{d.id}"\nrooms = {list(d.rooms)}\nstart_m = {list(d.start_m)}\nend_m = {list(d.end_m)}\n'
        for d in site().door
    ]
    return "".join(rooms + doors)


def start(mesh: WalkMesh, host: str, timeout_s: float = 20.0) -> ZenohNode:
    """The planner's process in the toy house, and a node on the hub's side of the mesh."""
    head, _, rest = mesh.site_file.read_text().partition("[[room]]")
    processes = rest[rest.index("[[process]]") :]
    mesh.site_file.write_text(head + house() + processes + TABLE.format(host=host, timeout_s=timeout_s))
    mesh.run("tests.planners.visits", "planner")
    mesh.wait(lambda: "planner is on the mesh" in mesh.log("planner"), 60.0)
    return ZenohNode(link_for(load_site(mesh.site_file), "hub"), "hub", "hub")


def ask(node: ZenohNode, task: str) -> PlanReply:
    world = furnished(1, ("kitchen",)).world()
    request = PlanRequest(task=task, epoch=1, instruction="turn off every TV", world=world, now_s=0.0)
    reply = node.call("make_plan", request, timeout_s=60.0)
    assert isinstance(reply, PlanReply)
    assert reply.plan is not None
    return reply


def test_the_model_is_loaded_while_the_process_comes_up_and_its_death_is_survived(mesh: WalkMesh) -> None:
    state = State(Says("kitchen"), Sequence("ok,hang_mid,ok"), cold_load_s=1.0)
    with running(state) as host, start(mesh, host, timeout_s=3.0) as node:
        mesh.wait(lambda: "(a stand-in without a model)" in mesh.log("planner"), 30.0)
        first = ask(node, "t-1")
        assert first.calls[0].stand_in
        assert first.plan is not None
        assert (first.plan.planner, first.note) == ("visits", "")
        hung = ask(node, "t-2")
        assert hung.plan is not None
        assert hung.plan.planner == "scripted"
        assert "no whole answer within 3 s" in hung.note
        assert state.loads == 1
        mesh.wait(lambda: mesh.log("planner").count("qwen3:8b is there after") == 2, 30.0)
    with ZenohNode(link_for(load_site(mesh.site_file), "hub"), "hub", "hub") as node:
        dead = ask(node, "t-3")
    assert dead.plan is not None
    assert dead.plan.planner == "scripted"
    assert "no model server answers" in dead.note
    assert mesh.end("planner") == 0
    assert "Traceback" not in mesh.log("planner")


def test_a_planner_that_is_killed_in_the_middle_of_a_call_is_missed_at_once(mesh: WalkMesh) -> None:
    state = State(Says("kitchen"), Sequence("hang"))
    with running(state) as host, start(mesh, host, timeout_s=50.0) as node:
        world = furnished(1, ("kitchen",)).world()
        request = PlanRequest(task="t", epoch=1, instruction="turn off every TV", world=world, now_s=0.0)
        number = node.ask("make_plan", request, timeout_s=300.0)
        mesh.wait(lambda: any(body["messages"] for body in state.chats), 30.0)
        mesh.processes["planner"].send_signal(signal.SIGKILL)
        began_s = time.monotonic()
        answers = []
        while not answers and time.monotonic() - began_s < 60.0:
            answers = [event for event in node.collect(0.2) if getattr(event, "ask", None) == number]
    assert answers, "long before the 300 s are over"
    assert "nobody answers" in answers[0].error
