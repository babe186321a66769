"""What the measurement of flight says to arguments that cannot work, and what it finds for one seed."""

from pathlib import Path

import cv2

from sim.flight.bench import hold_rms_m, straight, what_is_wrong
from sim.flight.plot import draw_steps


def test_arguments_that_cannot_work_are_told_in_a_sentence(tmp_path: Path) -> None:
    assert what_is_wrong(None, None) is None
    assert what_is_wrong(tmp_path / "steps.png", None) is None
    assert "there is no folder" in str(what_is_wrong(tmp_path / "none" / "steps.png", None))
    assert "must end in .png" in str(what_is_wrong(tmp_path / "steps", None))
    assert "not a checkout of gym-pybullet-drones" in str(what_is_wrong(None, tmp_path))


def test_one_seed_holds_its_place_and_flies_straight() -> None:
    assert hold_rms_m(11) < 0.05
    overshoot, error_m = straight(11)
    assert overshoot < 0.1
    assert error_m < 0.15


def test_step_responses_are_drawn(tmp_path: Path) -> None:
    path = tmp_path / "steps.png"
    draw_steps(path)
    picture = cv2.imread(str(path))
    assert picture is not None
    assert picture.std() > 5.0
