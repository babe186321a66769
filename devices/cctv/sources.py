"""Where a fixed camera's pictures come from when they are not on the mesh: one interface over OpenCV.

`source` in the site file is a webcam's number (`0`), a stream (`rtsp://...`, `http://...`), a video file, a folder of
pictures, or a pattern of picture files (`shots/*.png`).
"""

import glob
import re
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np

from devices.vision.lens import Image
from wire.site import Camera

PICTURE_SUFFIXES = (".jpg", ".jpeg", ".png", ".bmp", ".webp")
OPEN_TIMEOUT_MS, READ_TIMEOUT_MS = 5000, 5000
MAX_ASPECT_ERROR = 0.02
_LOGIN = re.compile(r"(?<=://).*@")
_SECRET = re.compile(r"((?:pass|pwd|token|key|auth)[a-z]*=)[^&_/]*", re.IGNORECASE)
"""Some cameras take the password in the path or the query: `user=admin_password=secret_channel=1`."""


class SourceLost(Exception):
    """No pictures at the moment; trying again may help."""


class SourceWrong(Exception):
    """Trying again cannot help; the text is one sentence with the remedy."""


class SourceEnded(Exception):
    """A recording is over."""


class FrameSource(Protocol):
    """Gives one RGB picture after the other."""

    interval_s: float
    """Time between pictures of a recording; 0 for live sources, which wait by themselves."""

    def read(self) -> Image:
        """The next picture. Raises SourceLost, SourceWrong or SourceEnded."""

    def close(self) -> None:
        """Let the camera or file go."""


def shown(source: str) -> str:
    """A source as it may be logged: an address without its name and password."""
    if "://" not in source:
        return source
    return _SECRET.sub(r"\1***", _LOGIN.sub("***@", source))


def open_source(camera: Camera) -> FrameSource:
    """The source that the site file names. Raises SourceLost or SourceWrong."""
    text = camera.source
    if text.isdecimal() or "://" in text:
        return CaptureSource(camera, int(text) if text.isdecimal() else text)
    if any(c in text for c in "*?[") or Path(text).is_dir():
        return PictureFiles(camera, picture_paths(camera))
    if not Path(text).exists():
        raise SourceWrong(
            f"camera {camera.id}: there is no {text}; `source` is mesh, a webcam's number, a URL, a video or a folder"
        )
    return CaptureSource(camera, text)


def picture_paths(camera: Camera) -> list[Path]:
    """Picture files of a folder or pattern, by name."""
    folder = Path(camera.source)
    found = folder.iterdir() if folder.is_dir() else map(Path, glob.glob(camera.source))
    paths = sorted(p for p in found if p.suffix.lower() in PICTURE_SUFFIXES)
    if not paths:
        raise SourceWrong(
            f"camera {camera.id}: no pictures in {camera.source}; put {', '.join(PICTURE_SUFFIXES)} there"
        )
    return paths


class PictureFiles:
    """Pictures of a folder, once, at the camera's rate."""

    def __init__(self, camera: Camera, paths: list[Path]) -> None:
        self.interval_s = 1.0 / camera.picture_hz
        self._camera, self._paths = camera, iter(paths)

    def read(self) -> Image:
        path = next(self._paths, None)
        if path is None:
            raise SourceEnded(f"camera {self._camera.id}: the last picture of {shown(self._camera.source)} was shown")
        bgr = cv2.imread(str(path), cv2.IMREAD_COLOR)
        if bgr is None:
            raise SourceWrong(f"camera {self._camera.id}: {path} is not a picture; remove it from the folder")
        return fit(self._camera, np.asarray(bgr, dtype=np.uint8))

    def close(self) -> None:
        """Nothing is held."""


class CaptureSource:
    """A webcam, a stream or a video file through OpenCV."""

    def __init__(self, camera: Camera, address: int | str) -> None:
        self._camera = camera
        self._live = isinstance(address, int) or "://" in address
        if isinstance(address, int):
            self._capture = cv2.VideoCapture(address)
        else:
            timeouts = [
                cv2.CAP_PROP_OPEN_TIMEOUT_MSEC,
                OPEN_TIMEOUT_MS,
                cv2.CAP_PROP_READ_TIMEOUT_MSEC,
                READ_TIMEOUT_MS,
            ]
            self._capture = cv2.VideoCapture(address, cv2.CAP_FFMPEG, timeouts)
        if not self._capture.isOpened():
            raise self._unopened()
        rate_hz = self._capture.get(cv2.CAP_PROP_FPS)
        self.interval_s = 0.0 if self._live else 1.0 / (rate_hz if 0.1 <= rate_hz <= 240.0 else camera.picture_hz)

    def _unopened(self) -> Exception:
        where = f"camera {self._camera.id}: {shown(self._camera.source)}"
        if not self._live:
            return SourceWrong(f"{where} is not a video that OpenCV reads; convert it, for example to H.264 in MP4")
        return SourceLost(f"{where} does not answer; check its address, its power, and that nobody else holds it")

    def read(self) -> Image:
        good, bgr = self._capture.read()
        if good:
            return fit(self._camera, np.asarray(bgr, dtype=np.uint8))
        if self._live:
            raise SourceLost(f"camera {self._camera.id}: {shown(self._camera.source)} stopped sending pictures")
        raise SourceEnded(f"camera {self._camera.id}: the video {shown(self._camera.source)} is over")

    def close(self) -> None:
        self._capture.release()


def fit(camera: Camera, bgr: Image) -> Image:
    """RGB at the calibrated size. Raises SourceWrong when the shape differs, as the calibration would not hold."""
    height, width = bgr.shape[:2]
    if abs(width / height * camera.height_px / camera.width_px - 1.0) > MAX_ASPECT_ERROR:
        raise SourceWrong(
            f"camera {camera.id}: pictures are {width}x{height}, its calibration in the site file is for "
            f"{camera.width_px}x{camera.height_px}; calibrate it at the size it sends"
        )
    if (width, height) != (camera.width_px, camera.height_px):
        size = (camera.width_px, camera.height_px)
        bgr = np.asarray(cv2.resize(bgr, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    return np.ascontiguousarray(bgr[:, :, ::-1])
