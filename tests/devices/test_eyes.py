"""The robot's own perception, with a detector that is told what to say."""

from math import pi

import numpy as np
import pytest

from devices.quadruped.eyes import PictureEyes, surface_points
from devices.vision.detector import Detection
from devices.vision.layout import detector_types
from devices.vision.lens import Image, Lens
from devices.vision.picture import encode_jpeg
from tests.devices.driver import two_rooms
from wire.messages.driver import CameraFrame

SIZE = (240, 320)


class Said:
    """Sees one apple in the middle of every picture."""

    def look(self, rgb: Image, lens: Lens) -> list[Detection]:
        assert rgb.shape == (*SIZE, 3)
        box = (156.0, 116.0, 164.0, 124.0)
        votes = np.array([0.0 if type == "Apple" else -9.0 for type in detector_types()])
        return [Detection("Apple", 0.9, 160.0, 120.0, box, 0.8, 0.1, 0.0, log_probs=votes)]


def frame(depth_m: float, jpeg: bytes | None = None, tilt_down_rad: float = 0.4) -> CameraFrame:
    depth = np.full(SIZE, round(depth_m * 1000.0), "<u2").tobytes()
    picture = encode_jpeg(np.zeros((*SIZE, 3), np.uint8))
    return CameraFrame(
        camera="dog-1",
        seq=1,
        stamp_s=1.0,
        width_px=320,
        height_px=240,
        focal_px=160.0,
        position_enu_m=(1.2, 1.0, 1.3),
        yaw_rad=0.0,
        tilt_down_rad=tilt_down_rad,
        jpeg=picture if jpeg is None else jpeg,
        depth_mm=depth,
    )


@pytest.fixture
def eyes() -> PictureEyes:
    return PictureEyes(two_rooms(), "dog-1", Said())


def test_names_what_it_sees_and_where(eyes: PictureEyes) -> None:
    seen = eyes.look(frame(1.5), carrying=False, boot_id="boot-1")
    assert seen is not None
    look, batch = seen
    assert [thing.type for thing in look.things] == ["Apple"]
    x, y, z = look.things[0].position_enu_m
    assert x == pytest.approx(1.2 + 1.5 * np.cos(0.4), abs=0.05)
    assert y == pytest.approx(1.0, abs=0.05)
    assert z == pytest.approx(1.3 - 1.5 * np.sin(0.4), abs=0.05)
    assert look.nearest("Apple", (x, y, z), 0.1) is not None
    assert look.nearest("Mug", (x, y, z), 0.1) is None
    assert (batch.source, batch.kind, batch.boot_id) == ("dog-1", "robot", "boot-1")
    assert batch.view is not None


def test_the_load_is_not_reported(eyes: PictureEyes) -> None:
    in_hand = frame(0.64, tilt_down_rad=1.05)
    with_load = eyes.look(in_hand, carrying=True, boot_id="boot-1")
    assert with_load is not None
    assert not with_load[0].things
    without = eyes.look(in_hand, carrying=False, boot_id="boot-1")
    assert without is not None
    assert without[0].things
    beyond = eyes.look(frame(2.0), carrying=True, boot_id="boot-1")
    assert beyond is not None
    assert beyond[0].things


def test_what_is_no_picture_is_skipped(eyes: PictureEyes) -> None:
    assert eyes.look(frame(1.0, jpeg=b"no picture"), carrying=False, boot_id="boot-1") is None


def test_surfaces_lie_where_the_depth_says() -> None:
    lens = Lens(320, 240, 160.0, (0.0, 0.0, 1.3), pi / 2.0, 0.0)
    depth = np.full(SIZE, 2.0, np.float32)
    depth[:, :160] = 0.0
    points = surface_points(lens, depth)
    assert len(points) == 30 * 20
    assert np.allclose(points[:, 1], 2.0, atol=1e-4)
    assert (points[:, 0] > 0.0).all()
