"""A picture as arrays: what a CameraFrame holds, decoded."""

from dataclasses import dataclass

import cv2
import numpy as np

from devices.vision.lens import Depth, Image, Lens
from wire.messages.driver import CameraFrame


class PictureError(ValueError):
    """The bytes of a frame are not a picture of the size it states."""


@dataclass(frozen=True)
class Picture:
    """Colour as (height, width, 3) RGB; depth in metres along the optical axis, 0 where nothing was measured."""

    rgb: Image
    depth_m: Depth | None
    lens: Lens
    stamp_s: float


def decode_frame(frame: CameraFrame) -> Picture:
    """The frame's JPEG and depth as arrays. Raises PictureError when they do not fit the stated size."""
    rgb = decode_jpeg(frame.jpeg)
    if rgb.shape[:2] != (frame.height_px, frame.width_px):
        raise PictureError(f"{frame.camera}: picture {frame.seq} is not a {frame.width_px}x{frame.height_px} JPEG")
    return Picture(rgb, _depth(frame), Lens.of_frame(frame), frame.stamp_s)


def decode_jpeg(data: bytes) -> Image:
    """RGB, (height, width, 3); empty when the bytes are no picture."""
    bgr = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), cv2.IMREAD_COLOR) if data else None
    if bgr is None:
        return np.zeros((0, 0, 3), dtype=np.uint8)
    return np.ascontiguousarray(bgr[:, :, ::-1], dtype=np.uint8)


def _depth(frame: CameraFrame) -> Depth | None:
    if frame.depth_mm is None:
        return None
    if len(frame.depth_mm) != 2 * frame.width_px * frame.height_px:
        raise PictureError(f"{frame.camera}: depth of picture {frame.seq} has {len(frame.depth_mm)} bytes")
    values = np.frombuffer(frame.depth_mm, dtype="<u2").reshape(frame.height_px, frame.width_px)
    return values.astype(np.float32) / np.float32(1000.0)


def encode_jpeg(rgb: Image, quality: int = 85) -> bytes:
    """An RGB array as the JPEG bytes that a frame carries."""
    _, data = cv2.imencode(".jpg", np.ascontiguousarray(rgb[:, :, ::-1]), [cv2.IMWRITE_JPEG_QUALITY, quality])
    return bytes(data)
