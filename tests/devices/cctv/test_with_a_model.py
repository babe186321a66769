"""A fixed camera with a vision model: what it asks, what becomes of the answers, and that it waits for nothing."""

import json
import threading
from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
import pytest

from devices.cctv.core import CctvCore
from devices.vision.detector import Detector, EmbeddedDetector
from devices.vision.picture import decode_jpeg, encode_jpeg
from planners.asking import Answer, Model, Question
from planners.core import PlannerCore
from planners.looking import Looks
from sim.render import Camera, make_renderer
from tests.ollama_double.brains import looks
from tests.ollama_double.dials import Dials
from tests.ollama_double.in_process import InProcess
from tests.sim.small_home import make_small_home
from wire.bus import Event, Node
from wire.loopback import LoopbackMesh
from wire.messages.driver import CameraFrame
from wire.messages.plan import ModelCall
from wire.site import Perception, Site, parse_site

from .test_core import SITE, Listener, MarkerDetector

APPLE_AT = {"name": "Apple", "x": 0.0, "y": 0.0, "state": None}
TOWEL_AT = {"name": "Towel", "x": 3.0, "y": -2.0, "state": None}


def site(perception: Perception, every_s: float = 1.0) -> Site:
    camera = SITE["camera"][0] | {"perception": perception, "look_every_s": every_s}
    return parse_site(SITE | {"camera": [camera], "planner": {"vision": "qwen2.5vl:7b"}}, "test")


def says(*objects: object, events: Sequence[str] = (), texts: Sequence[str] = ()) -> InProcess:
    reply = json.dumps({"objects": objects, "events": list(events), "texts": list(texts)})
    return InProcess(lambda question: reply)


class Driver:
    """A camera whose pictures are red, with a bar that moves when `moving`."""

    def __init__(self, moving: bool = True, jpeg: bytes | None = None) -> None:
        self._moving, self._jpeg, self._seq = moving, jpeg, 0

    def start(self, node: Node) -> None:
        self._node = node

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self._seq += 1
        red = np.zeros((480, 640, 3), np.uint8)
        red[:, :, 0] = 200
        if self._moving:
            at = int(40 * now_s) % 600
            red[:, at : at + 30, 1] = 255
        frame = CameraFrame(
            camera="cam-1",
            seq=self._seq,
            stamp_s=now_s,
            width_px=640,
            height_px=480,
            focal_px=320.0,
            position_enu_m=(0.0, 0.0, 2.3),
            yaw_rad=0.0,
            tilt_down_rad=0.5236,
            jpeg=self._jpeg or encode_jpeg(red),
        )
        self._node.publish("frame", frame, "cam-1")

    def stop(self) -> None:
        """Holds nothing."""


def run(
    seconds: float,
    model: Model | None,
    perception: Perception = "both",
    driver: Driver | None = None,
    detector: Detector | None = None,
    every_s: float = 1.0,
    time_stands: bool = True,
) -> Listener:
    mesh, listener, where = LoopbackMesh(), Listener(), site(perception, every_s)
    eyes = None if perception == "vlm" else detector or MarkerDetector()
    mesh.add(driver or Driver(), "sim", "sim", owner=True)
    mesh.add(CctvCore(where, "cctv-1", where.camera[0], eyes, None), "cctv-1", "cctv")
    mesh.add(PlannerCore(_no_planner(), Looks(model, time_stands)), "planner", "planner")
    mesh.add(listener, "hub", "hub")
    mesh.run(seconds)
    mesh.close()
    return listener


def _no_planner():
    class NoPlanner:
        def make_plan(self, request):
            raise AssertionError("nobody asked for a plan")

    return NoPlanner()


def test_an_embedded_camera_asks_nobody() -> None:
    model = says(APPLE_AT)
    run(3.0, model, "embedded")
    assert model.questions == []


def test_the_model_is_shown_the_picture_with_its_grid_at_its_rate() -> None:
    model = says(APPLE_AT)
    run(6.0, model, every_s=2.0)
    assert len(model.questions) == 3
    question = model.questions[0]
    picture = decode_jpeg(question.pictures[0])
    assert picture.shape == (480, 640, 3)
    assert np.abs(picture[:, 320].astype(int) - (235, 40, 40)).mean() < 60, "the red axis is in the middle"
    assert "x from -8.00 to 8.00" in question.user
    assert question.schema is not None
    assert "Apple" in question.schema["properties"]["objects"]["items"]["properties"]["name"]["enum"]


def test_both_eyes_see_one_apple_and_are_surer_of_it() -> None:
    alone, both = run(6.0, None, "embedded"), run(6.0, says(APPLE_AT))
    assert {o.track for b in both.batches for o in b.objects} == {"t1"}
    assert both.batches[-1].objects[0].confidence > alone.batches[-1].objects[0].confidence + 0.02
    assert both.batches[-1].objects[0].position_enu_m == pytest.approx(alone.batches[-1].objects[0].position_enu_m)
    assert len(both.batches) == len(alone.batches)


def test_what_only_the_model_sees_comes_in_batches_without_a_view() -> None:
    listener = run(6.0, says(APPLE_AT, TOWEL_AT))
    own = [b for b in listener.batches if any(o.type == "Towel" for o in b.objects)]
    assert own
    assert all(b.view is None and [o.type for o in b.objects] == ["Towel"] for b in own)
    assert all(b.stamp_s == pytest.approx(round(b.stamp_s, 2)) for b in own), "the time of the picture"
    assert any(line.startswith("Towel appeared") for line in listener.lines)


def test_a_camera_with_the_model_alone() -> None:
    listener = run(6.0, says(APPLE_AT), "vlm")
    assert {o.type for b in listener.batches for o in b.objects} == {"Apple"}
    assert all(b.view is None for b in listener.batches)
    apple = listener.batches[-1].objects[0]
    assert apple.covariance_m2[0] > 0.05, "far along the ray: its height is not known"


def test_a_still_picture_is_asked_about_twice_and_then_seldom() -> None:
    model = says(APPLE_AT)
    listener = run(10.0, model, "vlm", Driver(moving=False))
    assert len(model.questions) == 2
    assert len(listener.batches) >= 8, "the last answer still holds, and is reported with the time of the new picture"
    assert len({b.stamp_s for b in listener.batches}) == len(listener.batches)


def test_what_the_model_says_is_a_quotation_in_the_log() -> None:
    listener = run(6.0, says(events=["A person lies\non the floor."], texts=["Exit"]))
    assert listener.lines.count('the stand-in for a vision model says "A person lies on the floor."') == 1
    assert listener.lines.count('the stand-in for a vision model reads "Exit" in the picture') == 1


def test_the_log_is_not_flooded() -> None:
    count = iter(range(10_000))
    chatty = InProcess(
        lambda question: json.dumps({"objects": [], "events": [f"It is {next(count)}." for _ in range(3)], "texts": []})
    )
    listener = run(60.0, chatty, "vlm")
    said = [line for line in listener.lines if "says" in line]
    assert len(said) == 6


def test_a_failing_model_is_told_of_once_asked_less_often_and_disturbs_nothing(
    caplog: pytest.LogCaptureFixture,
) -> None:
    model = says(APPLE_AT)
    model.fault = "no model server at 127.0.0.1:11434"
    listener = run(30.0, model)
    assert listener.lines.count("no answer from the vision model: no model server at 127.0.0.1:11434") == 1
    assert caplog.messages == ["cam-1: no answer from the vision model: no model server at 127.0.0.1:11434"]
    assert 3 <= len(model.questions) <= 5
    assert len(listener.batches) >= 55


def test_that_a_model_answers_is_in_the_process_log_once(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level("INFO", "camera"):
        run(5.0, says(APPLE_AT))
    told = [message for message in caplog.messages if message.endswith("answers")]
    assert len(told) == 1


def test_without_a_model_the_log_says_what_is_missing() -> None:
    assert any("[planner]" in line for line in run(5.0, None).lines)


def test_when_it_answers_again_that_is_told() -> None:
    model = says(APPLE_AT)
    model.fault = "busy"

    def mend(question: Question) -> None:
        if len(model.questions) == 2:
            model.fault = ""

    asks = model.ask

    def ask(question: Question) -> Answer:
        mend(question)
        return asks(question)

    model.ask = ask  # type: ignore[method-assign]
    assert "the vision model answers again" in run(20.0, model).lines


def test_a_model_that_hangs_holds_up_nobody() -> None:
    let_go = threading.Event()

    class Hanging:
        def ask(self, question: Question) -> Answer:
            let_go.wait(60.0)
            return Answer("", ModelCall(purpose="look", model="slow", outcome="ok"))

    try:
        listener = run(130.0, Hanging(), time_stands=False)
    finally:
        let_go.set()
    assert len(listener.batches) >= 250, "the detector reports at its own rate"
    assert any("no answer from look_at in 120 s" in line for line in listener.lines)


@pytest.mark.parametrize(
    "reply", ["", "no", '{"objects":[{"na', json.dumps({"objects": [{"name": "Dragon", "x": 0, "y": 0}]})]
)
def test_a_reply_that_cannot_be_used_changes_nothing(reply: str) -> None:
    listener = run(6.0, InProcess(lambda question: reply))
    assert {o.track for b in listener.batches for o in b.objects} == {"t1"}


def test_equal_runs_say_the_same() -> None:
    first, second = (run(5.0, says(APPLE_AT, TOWEL_AT, events=["Quiet."])) for _ in range(2))
    assert first.batches == second.batches
    assert first.lines == second.lines


@pytest.fixture(scope="module")
def room_jpeg() -> bytes:
    scene = make_small_home()
    renderer = make_renderer(scene)
    pose = replace(Camera.fixed(scene.cameras[0]), tilt_down_rad=0.5236)
    rgb = renderer.render(pose).rgb
    renderer.close()
    return encode_jpeg(rgb)


def test_a_brain_that_looks_at_the_pixels_and_the_detector_agree(room_jpeg: bytes) -> None:
    """The whole way with a real picture: grid, prompt, a brain that sees the picture only, reply, tracks."""
    model = InProcess(looks.make(Dials()))
    embedded = EmbeddedDetector()
    both = run(5.0, model, "both", Driver(jpeg=room_jpeg), embedded)
    alone = run(5.0, None, "embedded", Driver(jpeg=room_jpeg), embedded)
    assert len(model.questions) >= 2
    told = [sorted({(o.track, o.type) for b in r.batches for o in b.objects}) for r in (both, alone)]
    assert sorted(type for _, type in told[0]) == sorted(type for _, type in told[1]), "nothing is there twice"
    assert len(told[0]) >= 3
    sure = [{o.type: o.confidence for o in r.batches[-1].objects} for r in (both, alone)]
    assert sum(sure[0].get(type, 0.0) > c + 0.01 for type, c in sure[1].items()) >= 2


def test_the_brain_finds_things_by_pixels_alone(room_jpeg: bytes) -> None:
    """A black picture with the same prompt shows nothing, and a mirrored one shows things on the other side."""
    rgb = decode_jpeg(room_jpeg)
    model = InProcess(looks.make(Dials()))
    run(2.0, model, "vlm", Driver(jpeg=room_jpeg))
    question = model.questions[0]
    seen = json.loads(model.ask(question).text)["objects"]
    black = replace(question, pictures=(encode_jpeg(np.zeros_like(rgb)),))
    assert json.loads(model.ask(black).text)["objects"] == []
    mirrored = replace(question, pictures=(encode_jpeg(np.ascontiguousarray(cv2.flip(rgb, 1))),))
    fridge = [o["x"] for o in seen if o["name"] == "Fridge"]
    other = [o["x"] for o in json.loads(model.ask(mirrored).text)["objects"] if o["name"] == "Fridge"]
    assert fridge
    assert other
    assert fridge[0] == pytest.approx(-other[0], abs=0.4)
