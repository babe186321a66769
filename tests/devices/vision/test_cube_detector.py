"""The shipped detector of cubes on pictures that were rendered for the test, from above and from other cameras."""

from dataclasses import replace

import numpy as np
import pytest

from devices.vision.cube_detector import CubeDetector
from devices.vision.gridmask import draw, grid_for
from devices.vision.lens import Lens
from sim.training.cubes.dataset import Example, examples
from sim.training.cubes.score import Tally

Pictures = list[tuple[Example, np.ndarray]]


@pytest.fixture(scope="module")
def pictures() -> Pictures:
    return list(examples(10, seed=7009, twins=1.0, splits=("test",)))


@pytest.fixture(scope="module")
def detector() -> CubeDetector:
    return CubeDetector()


@pytest.mark.parametrize("gridded", [True, False], ids=["grid", "plain"])
def test_what_is_there_is_found(pictures: Pictures, detector: CubeDetector, gridded: bool) -> None:
    tally = Tally()
    for example, rgb in pictures:
        if example.gridded == gridded:
            tally.add(example, detector.report(rgb, example.lens))
    figures = tally.summary()
    assert (figures["recall"] or 0.0) > 0.8, figures
    assert (figures["deviation_cells_median"] or 9.0) < 0.15, figures
    assert (figures["invented_per_picture"] or 0.0) < 1.0, figures


def test_a_camera_of_another_size_sees_the_same(pictures: Pictures, detector: CubeDetector) -> None:
    """A picture of 1280x960, drawn from the one of 640x480: places in cells of its own grid lead to the same points."""
    example, rgb = next((e, p) for e, p in pictures if not e.gridded)
    large = np.repeat(np.repeat(rgb, 2, axis=0), 2, axis=1)
    lens = replace(example.lens, width_px=1280, height_px=960, focal_px=2.0 * example.lens.focal_px)
    names = [sorted(e.name for e in detector.report(p, b).entries) for p, b in ((rgb, example.lens), (large, lens))]
    assert names[0] == names[1]


def test_an_empty_floor_is_empty(detector: CubeDetector) -> None:
    lens = Lens(640, 480, 468.0, (0.0, 0.0, 2.3), 0.0, np.pi / 2.0)
    floor = np.full((480, 640, 3), 140, np.uint8)
    assert detector.report(floor, lens).entries == ()
    assert len(detector.report(draw(floor, grid_for(lens)), lens).entries) <= 1


def test_no_robot_has_two_heads(pictures: Pictures, detector: CubeDetector) -> None:
    for example, rgb in pictures:
        parts = [e.part for e in detector.report(rgb, example.lens).entries if e.part is not None]
        assert len(parts) == len(set(parts))
