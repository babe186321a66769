"""A camera's and a planner's process with a vision model, over real sockets: pictures over Zenoh, questions over HTTP."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from devices.vision.picture import encode_jpeg
from sim.render import Camera, make_renderer
from tests.ollama_double.at_hand import Says
from tests.ollama_double.brains import looks
from tests.ollama_double.dials import Dials
from tests.ollama_double.scenarios import Sequence
from tests.ollama_double.server import State, running
from tests.sim.small_home import FRIDGE, make_small_home
from tests.walk.mesh import WalkMesh
from wire.bus import Received
from wire.link import link_for
from wire.messages.observation import EventLog, ObservationBatch
from wire.node import ZenohNode
from wire.site import load_site

pytestmark = pytest.mark.walk
REST = """
[planner]
vision = "qwen2.5vl:7b"
host = "{host}"
timeout_s = 60.0
[[camera]]
id = "cam-1"
position_enu_m = [0.2, 0.2, 2.3]
yaw_deg = 45.0
tilt_down_deg = 28.6
width_px = 640
height_px = 480
focal_px = 320.0
source = "{folder}"
picture_hz = 2.0
perception = "both"
look_every_s = 1.0
[[process]]
id = "planner"
role = "planner"
module = "planners"
[[process]]
id = "cctv-1"
role = "cctv"
module = "devices.cctv"
"""


@pytest.fixture
def mesh(tmp_path: Path) -> Iterator[WalkMesh]:
    with WalkMesh(tmp_path, mode="wall") as mesh:
        yield mesh


def pictures(folder: Path, count: int) -> Path:
    """One room, again and again, as a recorded camera would give it."""
    scene = make_small_home()
    scene.bodies[FRIDGE].props["isOpen"] = True
    renderer = make_renderer(scene)
    jpeg = encode_jpeg(renderer.render(Camera.fixed(scene.cameras[0])).rgb)
    renderer.close()
    folder.mkdir()
    for number in range(count):
        (folder / f"{number:04d}.jpg").write_bytes(jpeg)
    return folder


class Ear:
    """What the camera says, on the hub's side."""

    def __init__(self, mesh: WalkMesh) -> None:
        self.node = ZenohNode(link_for(load_site(mesh.site_file), "hub"), "hub", "hub")
        self.lines: list[str] = []
        self.batches: list[ObservationBatch] = []

    def __enter__(self) -> "Ear":
        self.node.__enter__()
        self.node.subscribe("event")
        self.node.subscribe("observation")
        return self

    def __exit__(self, *error: object) -> None:
        self.node.__exit__(*error)  # type: ignore[arg-type]

    def listen(self) -> None:
        for event in self.node.collect(0.2):
            match event:
                case Received(message=EventLog() as line):
                    self.lines.append(line.text)
                case Received(message=ObservationBatch() as batch):
                    self.batches.append(batch)

    def heard(self, words: str) -> bool:
        self.listen()
        return any(words in line for line in self.lines)


def start(mesh: WalkMesh, host: str, folder: Path) -> None:
    mesh.site_file.write_text(mesh.site_file.read_text() + REST.format(host=host, folder=folder))
    mesh.run("planners", "planner")
    mesh.wait(lambda: "planner is on the mesh" in mesh.log("planner"), 60.0)


def test_a_camera_looks_through_a_model_that_sees_the_pixels(mesh: WalkMesh, tmp_path: Path) -> None:
    state = State(looks.make(Dials()))
    with running(state) as host:
        start(mesh, host, pictures(tmp_path / "shots", 400))
        with Ear(mesh) as ear:
            mesh.run("devices.cctv", "cctv-1")
            mesh.wait(lambda: ear.heard('the stand-in for a vision model says "The Fridge is open."'), 90.0)
            mesh.wait(lambda: ear.listen() or len(ear.batches) >= 6, 60.0)
    types = {o.type for b in ear.batches for o in b.objects}
    assert "Fridge" in types
    asked = [body for body in state.chats if body["messages"]]
    assert asked[0]["model"] == "qwen2.5vl:7b"
    assert asked[0]["format"]["properties"]["objects"]
    assert asked[0]["messages"][-1]["images"]
    assert mesh.end("cctv-1") == 0
    assert mesh.end("planner") == 0
    assert "Traceback" not in mesh.log("cctv-1") + mesh.log("planner")


def test_a_model_that_never_answers_leaves_the_camera_its_detector(mesh: WalkMesh, tmp_path: Path) -> None:
    with running(State(Says(""), Sequence("hang"))) as host:
        start(mesh, host, pictures(tmp_path / "shots", 400))
        with Ear(mesh) as ear:
            mesh.run("devices.cctv", "cctv-1")
            mesh.wait(lambda: ear.listen() or len(ear.batches) >= 10, 90.0)
        assert {o.type for b in ear.batches for o in b.objects} >= {"Fridge"}
        assert mesh.end("planner") == 0, "a question under way does not keep the process"
    assert mesh.end("cctv-1") == 0
