"""The shipped detector on held-out homes: floors, so that worse weights are not shipped by mistake."""

import pytest

from devices.vision.detector import EmbeddedDetector
from sim.training.frames import shoot_home, shoot_tidy
from sim.training.measure import measure
from sim.training.report import BEGIN, END, table, write_report

LEAST = {
    "home": {"precision": 0.75, "recall": 0.70},
    "cctv": {"precision": 0.80, "recall": 0.60},
    "mast": {"precision": 0.75, "recall": 0.55},
}


@pytest.fixture(scope="module")
def figures():
    disorder = (s for n in (9006, 9007) for s in shoot_home(n, cctv=8, mast=12))
    shots = [*disorder, *(s for n in (9008, 9009) for s in shoot_tidy(n))]
    return measure(shots, EmbeddedDetector())


@pytest.mark.parametrize("camera", sorted(LEAST))
def test_the_shipped_detector_finds_most_things(figures, camera: str) -> None:
    for name, least in LEAST[camera].items():
        assert figures[camera][name] >= least, (camera, name)


def test_positions_are_good_enough_to_send_a_robot(figures) -> None:
    assert figures["cctv"]["position_error_m"]["median"] < 0.25
    assert figures["mast"]["position_error_m"]["median"] < 0.12


def test_the_report_replaces_only_its_table(figures, tmp_path) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"before\n{BEGIN}\nold\n{END}\nafter\n")
    write_report(page, figures)
    text = page.read_text()
    assert text.startswith("before\n")
    assert text.endswith("after\n")
    assert table(figures) in text
    assert "old" not in text
