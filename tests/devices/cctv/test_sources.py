"""Sources of pictures: real files, a real video, and what is said when there is none."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from devices.cctv.reader import SourceReader
from devices.cctv.sources import SourceEnded, SourceLost, SourceWrong, open_source, shown
from wire.site import Camera


def camera(source: str | Path, **changes) -> Camera:
    fields = {
        "id": "cam-1",
        "position_enu_m": (0.0, 0.0, 2.3),
        "yaw_deg": 0.0,
        "tilt_down_deg": 30.0,
        "width_px": 64,
        "height_px": 48,
        "focal_px": 32.0,
        "source": str(source),
        "picture_hz": 20.0,
    }
    return Camera(**{**fields, **changes})


def picture(number: int, size: tuple[int, int] = (48, 64)) -> np.ndarray:
    bgr = np.zeros((*size, 3), np.uint8)
    bgr[:, :, 2] = 40 * number
    return bgr


def write_pictures(folder: Path, count: int = 3, size: tuple[int, int] = (48, 64)) -> Path:
    for i in range(count):
        cv2.imwrite(str(folder / f"{i}.png"), picture(i + 1, size))
    return folder


def write_video(path: Path, count: int = 5) -> Path:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), 10.0, (64, 48))
    for i in range(count):
        writer.write(picture(i + 1))
    writer.release()
    return path


@pytest.mark.parametrize("pattern", [False, True])
def test_a_folder_shows_its_pictures_in_order_as_rgb(tmp_path: Path, pattern: bool) -> None:
    folder = write_pictures(tmp_path)
    source = open_source(camera(folder / "*.png" if pattern else folder))
    reds = [int(source.read()[0, 0, 0]) for _ in range(3)]
    assert reds == [40, 80, 120]
    with pytest.raises(SourceEnded, match="last picture"):
        source.read()


def test_a_video_is_read_to_its_end(tmp_path: Path) -> None:
    source = open_source(camera(write_video(tmp_path / "clip.mp4")))
    assert source.interval_s == pytest.approx(0.1)
    shown = [source.read() for _ in range(5)]
    with pytest.raises(SourceEnded, match="is over"):
        source.read()
    source.close()
    assert shown[0].shape == (48, 64, 3)
    assert shown[4][:, :, 0].mean() > shown[0][:, :, 0].mean() + 60


def test_pictures_are_brought_to_the_calibrated_size(tmp_path: Path) -> None:
    source = open_source(camera(write_pictures(tmp_path, size=(96, 128))))
    assert source.read().shape == (48, 64, 3)


def test_another_shape_than_calibrated_is_refused(tmp_path: Path) -> None:
    source = open_source(camera(write_pictures(tmp_path, size=(48, 100))))
    with pytest.raises(SourceWrong, match=r"100x48.*64x48"):
        source.read()


def test_a_missing_file_is_named_with_the_remedy(tmp_path: Path) -> None:
    with pytest.raises(SourceWrong, match=r"cam-1: there is no .*nothing\.mp4; `source` is mesh"):
        open_source(camera(tmp_path / "nothing.mp4"))


def test_an_empty_folder_is_named_with_the_remedy(tmp_path: Path) -> None:
    with pytest.raises(SourceWrong, match="no pictures in"):
        open_source(camera(tmp_path))


def test_a_file_that_is_no_video_is_refused(tmp_path: Path) -> None:
    (tmp_path / "notes.mp4").write_text("these are words")
    with pytest.raises(SourceWrong, match="not a video"):
        open_source(camera(tmp_path / "notes.mp4"))


def test_a_silent_stream_may_come_back() -> None:
    with pytest.raises(SourceLost, match="does not answer"):
        open_source(camera("rtsp://127.0.0.1:9/none"))


def test_the_reader_hands_over_pictures_and_tells_of_faults(tmp_path: Path) -> None:
    reader = SourceReader(camera(write_pictures(tmp_path), picture_hz=50.0))
    reader.start()
    reader._thread.join(timeout=5.0)
    shown = reader.take()
    assert shown is not None
    assert shown[0, 0, 0] == 120
    assert reader.take() is None
    reader.stop()
    wrong = SourceReader(camera(tmp_path / "absent"))
    wrong.start()
    wrong._thread.join(timeout=5.0)
    assert "there is no" in wrong.fault
    wrong.stop()


@pytest.mark.parametrize(
    ("source", "told"),
    [
        ("rtsp://admin:p@ss/w0rd@10.0.0.2:554/stream1", "rtsp://***@10.0.0.2:554/stream1"),
        (
            "http://10.0.0.2/video?user=admin&password=secret&size=1",
            "http://10.0.0.2/video?user=admin&password=***&size=1",
        ),
        ("rtsp://10.0.0.2/user=admin_password=secret_channel=1", "rtsp://10.0.0.2/user=admin_password=***_channel=1"),
        ("rtsp://10.0.0.2:554/stream1", "rtsp://10.0.0.2:554/stream1"),
        ("recordings/monday@home.mp4", "recordings/monday@home.mp4"),
    ],
)
def test_an_address_is_told_without_its_password(source: str, told: str) -> None:
    assert shown(source) == told


def test_a_stream_that_does_not_answer_is_named_without_its_password() -> None:
    with pytest.raises(SourceLost) as lost:
        open_source(camera("rtsp://admin:secret@127.0.0.1:9/live"))
    assert "127.0.0.1:9/live does not answer" in str(lost.value)
    assert "secret" not in str(lost.value)


def test_a_reader_that_was_never_started_can_be_stopped(tmp_path: Path) -> None:
    SourceReader(camera(write_pictures(tmp_path))).stop()
