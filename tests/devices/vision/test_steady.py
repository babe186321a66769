"""When a picture is looked at again, and when what was found in the last one still holds."""

from dataclasses import replace

import numpy as np
import pytest

from devices.vision.detector import Detection
from devices.vision.lens import Image, Lens
from devices.vision.steady import MOST_REPEATS, SteadyDetector

LENS = Lens(320, 240, 160.0, (0.0, 0.0, 2.3), 0.0, 0.5)


class Counting:
    """Finds one apple, ever surer."""

    def __init__(self) -> None:
        self.looks = 0

    def look(self, rgb: Image, lens: Lens) -> list[Detection]:
        self.looks += 1
        return [Detection("Apple", self.looks / 100.0, 1.0, 1.0, (0.0, 0.0, 2.0, 2.0), 0.8, 0.1, 0.0)]


@pytest.fixture
def room() -> Image:
    return np.random.default_rng(1).integers(40, 200, (240, 320, 3), dtype=np.uint8)


def noisy(picture: Image, seed: int, levels: float = 5.0) -> Image:
    noise = np.random.default_rng(seed).normal(0.0, levels, picture.shape)
    return np.clip(picture + noise, 0, 255).astype(np.uint8)


def test_sensor_noise_is_no_change(room: Image) -> None:
    counting = Counting()
    steady = SteadyDetector(counting)
    found = [steady.look(noisy(room, seed), LENS) for seed in range(MOST_REPEATS)]
    assert counting.looks == 1
    assert all(f == found[0] for f in found)


def test_a_small_thing_that_comes_is_looked_at(room: Image) -> None:
    counting = Counting()
    steady = SteadyDetector(counting)
    steady.look(noisy(room, 0), LENS)
    room[100:104, 150:154] = (250, 20, 20)
    steady.look(noisy(room, 1), LENS)
    assert counting.looks == 2


def test_a_slow_change_is_noticed_in_the_end(room: Image) -> None:
    counting = Counting()
    steady = SteadyDetector(counting)
    for level in range(MOST_REPEATS):
        steady.look(np.clip(room + float(level), 0, 255).astype(np.uint8), LENS)
    assert counting.looks > 1


def test_another_pose_or_another_size_is_another_picture(room: Image) -> None:
    counting = Counting()
    steady = SteadyDetector(counting)
    steady.look(room, LENS)
    steady.look(room, replace(LENS, yaw_rad=0.01))
    steady.look(room[:120], replace(LENS, yaw_rad=0.01, height_px=120))
    assert counting.looks == 3


def test_it_looks_anyway_after_a_while(room: Image) -> None:
    counting = Counting()
    steady = SteadyDetector(counting)
    for _ in range(MOST_REPEATS + 1):
        steady.look(room, LENS)
    assert counting.looks == 1
    steady.look(room, LENS)
    assert counting.looks == 2
