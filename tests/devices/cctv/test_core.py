"""A fixed camera's process on the in-memory mesh: frames in, observations, absences and a text log out."""

from collections.abc import Sequence

import numpy as np
import pytest

from devices.cctv.core import CctvCore, camera_of
from devices.vision import layout
from devices.vision.detector import Detection
from devices.vision.lens import Image, Lens
from devices.vision.picture import encode_jpeg
from wire.bus import CannotRun, Event, Node, Received
from wire.loopback import LoopbackMesh
from wire.messages.command import CardRequest, DeviceCard
from wire.messages.driver import CameraFrame
from wire.messages.observation import EventLog, ObservationBatch
from wire.site import Site, SiteError, parse_site

SITE = {
    "name": "test",
    "room": [{"id": "r", "name": "room", "kind": "Kitchen", "polygon_m": [[-1.0, -3.0], [5.0, -3.0], [5.0, 3.0]]}],
    "wall": [{"start_m": [5.0, -3.0], "end_m": [5.0, 3.0]}],
    "camera": [
        {
            "id": "cam-1",
            "position_enu_m": [0.0, 0.0, 2.3],
            "yaw_deg": 0.0,
            "tilt_down_deg": 30.0,
            "width_px": 640,
            "height_px": 480,
            "focal_px": 320.0,
        }
    ],
    "process": [{"id": "cctv-1", "role": "cctv", "module": "devices.cctv"}],
}


def site() -> Site:
    return parse_site(SITE, "test")


class MarkerDetector:
    """Sees an apple wherever the picture is red: a detector for pictures made of one colour."""

    def look(self, rgb: Image, lens: Lens) -> list[Detection]:
        if rgb[:, :, 0].mean() < 100.0:
            return []
        log_probs = np.full(len(layout.detector_types()), -9.0)
        log_probs[layout.detector_types().index("Apple")] = -0.05
        props = {"isSliced": 0.05}
        return [Detection("Apple", 0.9, 320.0, 240.0, (310.0, 230.0, 330.0, 250.0), 0.8, 0.05, 0.05, props, log_probs)]


class Driver:
    """A camera driver on the mesh: red pictures until `gone_s`, black ones from then on."""

    def __init__(self, gone_s: float = 1e9, damaged: bool = False) -> None:
        self._gone_s, self._damaged, self._seq = gone_s, damaged, 0

    def start(self, node: Node) -> None:
        self._node = node

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self._seq += 1
        red = np.zeros((480, 640, 3), np.uint8)
        red[:, :, 0] = 200 if now_s < self._gone_s else 0
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
            jpeg=b"\xff\xd8 no picture" if self._damaged else encode_jpeg(red),
        )
        self._node.publish("frame", frame, "cam-1")

    def stop(self) -> None:
        """Holds nothing."""


class Listener:
    """The hub's ears."""

    def __init__(self) -> None:
        self.batches: list[ObservationBatch] = []
        self.lines: list[str] = []

    def start(self, node: Node) -> None:
        node.subscribe("observation")
        node.subscribe("event")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            match event:
                case Received(message=ObservationBatch() as batch):
                    self.batches.append(batch)
                case Received(message=EventLog() as line):
                    self.lines.append(line.text)

    def stop(self) -> None:
        """Holds nothing."""


class OwnPictures:
    """A camera of its own that always has a red picture, or a fault."""

    def __init__(self, fault: str = "") -> None:
        self.fault, self.running = fault, False

    def start(self) -> None:
        self.running = True

    def stop(self) -> None:
        self.running = False

    def take(self) -> Image | None:
        return np.dstack([np.full((480, 640), 200, np.uint8), np.zeros((480, 640, 2), np.uint8)])


def core(pictures: OwnPictures | None = None) -> CctvCore:
    return CctvCore(site(), "cctv-1", site().camera[0], MarkerDetector(), pictures)


def run(seconds: float, driver: Driver) -> Listener:
    mesh, listener = LoopbackMesh(), Listener()
    mesh.add(driver, "sim", "sim", owner=True)
    mesh.add(core(), "cctv-1", "cctv")
    mesh.add(listener, "hub", "hub")
    mesh.run(seconds)
    mesh.close()
    return listener


def test_pictures_become_observations_at_the_cameras_rate() -> None:
    listener = run(3.0, Driver())
    assert 5 <= len(listener.batches) <= 7
    apple = listener.batches[-1].objects[0]
    assert (listener.batches[-1].source, listener.batches[-1].kind) == ("cam-1", "cctv")
    assert apple.type == "Apple"
    assert apple.position_enu_m == pytest.approx((2.6, 0.0, 0.8), abs=0.05)
    assert apple.props["isSliced"] < 0.2
    assert len({o.track for b in listener.batches for o in b.objects}) == 1


def test_the_view_is_the_floor_before_the_camera() -> None:
    view = run(1.0, Driver()).batches[0].view
    assert view is not None
    assert len(view.polygon_m) >= 4
    assert all(0.0 < x <= 5.0 for x, _ in view.polygon_m)


def test_what_vanishes_is_said_to_be_gone_and_logged() -> None:
    listener = run(8.0, Driver(gone_s=3.0))
    gone = [absence for batch in listener.batches for absence in batch.gone]
    assert [(a.type, a.track) for a in gone] == [("Apple", "t1")]
    assert listener.lines == ["Apple appeared at 2.6, 0.0", "Apple at 2.6, 0.0 is no longer there"]


def test_a_damaged_picture_is_left_out() -> None:
    assert run(1.0, Driver(damaged=True)).batches == []


def test_a_camera_of_its_own_is_looked_at_and_shown() -> None:
    mesh, listener, pictures = LoopbackMesh(), Listener(), OwnPictures()
    mesh.add(core(pictures), "cctv-1", "cctv")
    mesh.add(listener, "hub", "hub")
    mesh.run(2.0)
    assert pictures.running
    assert 3 <= len(listener.batches) <= 5
    mesh.close()
    assert not pictures.running


def test_a_source_that_can_never_work_ends_the_process_with_its_sentence() -> None:
    mesh = LoopbackMesh()
    mesh.add(core(OwnPictures("camera cam-1: there is no film.mp4")), "cctv-1", "cctv")
    with pytest.raises(CannotRun, match=r"no film\.mp4"):
        mesh.run(0.5)


@pytest.mark.parametrize("id", ["cam-1", "cctv-1"])
def test_the_card_names_the_camera(id: str) -> None:
    mesh = LoopbackMesh()
    mesh.add(core(), "cctv-1", "cctv")
    card = mesh.call("card", CardRequest(), id, role="hub")
    assert isinstance(card, DeviceCard)
    assert (card.id, card.kind) == ("cam-1", "camera")


def test_a_process_without_a_camera_is_refused_with_the_known_ones() -> None:
    assert camera_of(site(), "cctv-1").id == "cam-1"
    assert camera_of(site(), "anything", "cam-1").id == "cam-1"
    with pytest.raises(SiteError, match="no camera 'cam-7' for process cctv-7; its cameras are cam-1"):
        camera_of(site(), "cctv-7")
