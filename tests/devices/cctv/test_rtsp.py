"""A real RTSP stream through the reader: pictures come, the stream breaks, the reader comes back."""

import time

import pytest

from devices.cctv.reader import SourceReader
from wire.site import Camera

from .rtsp_camera import FFMPEG, RtspCamera

pytestmark = [pytest.mark.walk, pytest.mark.skipif(FFMPEG is None, reason="ffmpeg is not installed")]


def camera(url: str) -> Camera:
    return Camera(
        id="cam-1",
        position_enu_m=(0.0, 0.0, 2.3),
        yaw_deg=0.0,
        tilt_down_deg=30.0,
        width_px=640,
        height_px=480,
        focal_px=320.0,
        source=url,
    )


def pictures(reader: SourceReader, count: int, timeout_s: float = 20.0) -> list:
    """So many new pictures, or as many as came in time."""
    found, until_s = [], time.monotonic() + timeout_s
    while len(found) < count and time.monotonic() < until_s:
        picture = reader.take()
        if picture is None:
            time.sleep(0.02)
        else:
            found.append(picture)
    return found


def test_pictures_come_over_rtsp(tmp_path) -> None:
    streaming = RtspCamera(tmp_path)
    reader = SourceReader(camera(streaming.url))
    reader.start()
    try:
        found = pictures(reader, 3)
        assert len(found) == 3
        assert found[0].shape == (480, 640, 3)
        assert found[0].std() > 40.0
        assert reader.fault == ""
    finally:
        streaming.close()
        reader.stop()


def test_a_camera_that_starts_late_is_waited_for(caplog) -> None:
    reader = SourceReader(camera("rtsp://127.0.0.1:9/live"))
    reader.start()
    until_s = time.monotonic() + 10.0
    while "trying again in" not in caplog.text and time.monotonic() < until_s:
        time.sleep(0.05)
    reader.stop()
    assert "does not answer; check its address" in caplog.text
    assert reader.fault == ""
