"""Puts a camera's process together: its row of the site file, the shipped detector, its source of pictures."""

from devices.cctv.core import MESH, CctvCore, camera_of
from devices.cctv.reader import SourceReader
from devices.vision.detector import Detector, EmbeddedDetector
from wire.site import Site


def build(
    site: Site,
    process: str,
    camera: str | None = None,
    detector: Detector | None = None,
) -> CctvCore:
    """Runs in one process may share one detector, which keeps nothing."""
    row = camera_of(site, process, camera)
    pictures = None if row.source == MESH else SourceReader(row)
    eyes = None if row.perception == "vlm" else detector or EmbeddedDetector()
    return CctvCore(site, process, row, eyes, pictures)
