"""The page docs/real-cameras.md: its site file is one, and every source on it is what the page says it is."""

import tomllib
from math import degrees, radians, tan
from pathlib import Path

import pytest

from devices.cctv.build import build
from devices.cctv.core import CctvCore
from devices.cctv.sources import CaptureSource, PictureFiles, SourceLost, open_source
from devices.vision.lens import Lens
from tests.devices.cctv.test_core import MarkerDetector
from tests.devices.cctv.test_sources import write_pictures, write_video
from tests.pages import blocks
from wire.clock import owner_of
from wire.site import Camera, Site, parse_site

PAGE = "real-cameras.md"
WHOLE, *SNIPPETS = blocks(PAGE, "toml")
SOURCES = [tomllib.loads(text)["source"] for text in SNIPPETS]


def office(**changes: object) -> Site:
    data = tomllib.loads(WHOLE)
    data["camera"][0] |= changes
    return parse_site(data, PAGE)


def test_the_file_of_the_page_is_a_real_building() -> None:
    site = office()
    assert site.sim is None
    assert owner_of(site) == ""
    assert isinstance(build(site, "cctv-1", detector=MarkerDetector()), CctvCore)


@pytest.fixture
def recordings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The files that the page names, at 4:3 as its calibration."""
    folder = tmp_path / "recordings" / "monday"
    folder.mkdir(parents=True)
    write_pictures(folder)
    write_video(tmp_path / "recordings" / "monday.mp4")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("source", [s for s in SOURCES if s.startswith("recordings")])
def test_recordings_are_read_at_the_calibrated_size(source: str, recordings: Path) -> None:
    camera = office(source=source).camera[0]
    opened = open_source(camera)
    assert isinstance(opened, CaptureSource if source.endswith(".mp4") else PictureFiles)
    assert opened.read().shape == (480, 640, 3)
    opened.close()


def test_every_kind_of_source_is_on_the_page() -> None:
    assert [s.split("://")[0] for s in SOURCES if "recordings" not in s] == ["0", "rtsp", "http"]
    assert len(SOURCES) == 6


def test_yaw_focal_length_and_tilt_are_what_the_page_says() -> None:
    camera = office(yaw_deg=90.0, tilt_down_deg=0.0, focal_px=640 / (2 * tan(radians(60.0) / 2))).camera[0]
    lens = Lens.of_camera(camera)
    (north, edge) = lens.rays([320.0, 640.0], [240.0, 240.0])
    assert north == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)
    assert degrees(edge[0]) == pytest.approx(degrees(tan(radians(30.0))))
    assert Lens.of_camera(office(tilt_down_deg=30.0).camera[0]).rays(320.0, 240.0)[0][2] == pytest.approx(-0.5)


def test_fields_of_the_calibration_are_all_explained() -> None:
    table = next(
        text for text in Path(__file__).parents[3].joinpath("docs", PAGE).read_text().split("## ") if "| field" in text
    )
    told = {
        name for line in table.splitlines() if line.startswith("| `") for name in line.split("|")[1].split("`")[1::2]
    }
    assert told == set(Camera.model_fields) - {"id", "room", "source"}


@pytest.mark.parametrize("number", ["63", "4096"])
def test_a_webcam_that_is_not_there_is_tried_again(number: str) -> None:
    with pytest.raises(
        SourceLost, match=rf"camera cam-1: {number} does not answer; check .* that nobody else holds it"
    ):
        open_source(office(source=number).camera[0])
