"""The shipped detector on homes that it has not seen: floors under what it must do, not the measurement itself."""

import numpy as np
import pytest

from devices.vision import layout
from devices.vision.detector import Detection, EmbeddedDetector, overlap
from devices.vision.lens import Lens
from wire.catalogue import modelled_types

LENS = Lens(640, 480, 320.0, (0.0, 0.0, 2.3), 0.0, 0.5)
MAST = Lens(320, 240, 160.0, (0.0, 0.0, 1.3), 0.0, 0.5)


@pytest.fixture(scope="module")
def detector() -> EmbeddedDetector:
    return EmbeddedDetector()


def test_classes_are_the_catalogues_types_and_the_robot() -> None:
    assert layout.detector_types() == (*modelled_types(), layout.ROBOT)
    small, large = layout.heads()
    assert sorted(small.types + large.types) == sorted(layout.detector_types())


@pytest.mark.parametrize("lens", [LENS, MAST])
def test_any_size_of_picture_is_read_the_same_way_twice(detector: EmbeddedDetector, lens: Lens) -> None:
    rgb = np.random.default_rng(3).integers(0, 255, (lens.height_px, lens.width_px, 3), dtype=np.uint8)
    one, two = detector.look(rgb, lens), detector.look(rgb, lens)
    assert one == two
    for found in one:
        left, top, right, bottom = found.box_px
        assert 0.0 <= left <= right <= lens.width_px
        assert 0.0 <= top <= bottom <= lens.height_px


def test_an_empty_room_shows_nothing_much(detector: EmbeddedDetector) -> None:
    assert len(detector.look(np.full((480, 640, 3), 128, np.uint8), LENS)) <= 2


def test_overlap_is_intersection_over_union() -> None:
    assert overlap((0, 0, 2, 2), (0, 0, 2, 2)) == 1.0
    assert overlap((0, 0, 2, 2), (1, 0, 3, 2)) == pytest.approx(1.0 / 3.0)
    assert overlap((0, 0, 1, 1), (2, 2, 3, 3)) == 0.0


def test_a_detection_names_its_type_in_its_votes(detector: EmbeddedDetector) -> None:
    rgb = np.random.default_rng(4).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    for found in EmbeddedDetector(min_confidence=0.05).look(rgb, LENS):
        assert isinstance(found, Detection)
        assert layout.detector_types()[int(found.log_probs.argmax())] == found.type
