"""The page docs/vision-models.md: its site file is one, and the camera in it has both eyes."""

import tomllib

from devices.cctv.build import build
from devices.cctv.core import CctvCore
from tests.devices.cctv.test_core import MarkerDetector
from tests.pages import blocks
from wire.site import parse_site

(SNIPPET,) = blocks("vision-models.md", "toml")
OFFICE, *_ = blocks("real-cameras.md", "toml")


def test_the_tables_of_the_page_fit_into_the_office() -> None:
    changes = tomllib.loads(SNIPPET)
    site = parse_site(tomllib.loads(OFFICE) | changes, "vision-models.md")
    assert (site.camera[0].perception, site.planner.vision) == ("both", "qwen2.5vl:7b")
    core = build(site, "cctv-1", detector=MarkerDetector())
    assert isinstance(core, CctvCore)
    core.stop()
