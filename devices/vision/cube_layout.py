"""Inputs and outputs of the two networks that see cubes from above: shared by their users and their trainer."""

import cv2
import numpy as np
from numpy.typing import NDArray

from devices.vision.lens import Image, Lens
from devices.vision.prompt import COLOUR_CUBES, CUBE_EDGE_M, PARTS

LETTERED = "lettered"
KINDS = (LETTERED, *COLOUR_CUBES, *PARTS)
"""What the finder tells apart, in the order of its heat channels; two channels follow, see `OFFSET_SCALE_PX`."""
STRIDE_PX = 8
OFFSET_SCALE_PX = 8.0
PX_PER_M = 100.0
"""The finder sees every picture at this scale, so that cubes have one size, whatever the camera and its height."""
MULTIPLE_PX = 32

CROP_PX = 48
"""Side of the reader's picture."""
CROP_EDGES = 1.6
"""Edges of a cube that the reader's picture is wide."""
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
"""The reader's first outputs; then the cosine and sine of how far the letter is turned."""


def finder_scale(lens: Lens) -> float:
    """From the camera's pixels to the finder's."""
    return PX_PER_M / (lens.focal_px / max(0.5, lens.position_enu_m[2] - CUBE_EDGE_M))


def finder_picture(rgb: Image, lens: Lens) -> Image:
    """The picture at the finder's scale, without what pads it."""
    scale = finder_scale(lens)
    size = (max(1, round(rgb.shape[1] * scale)), max(1, round(rgb.shape[0] * scale)))
    way = cv2.INTER_AREA if scale < 1.0 else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(rgb, size, interpolation=way), dtype=np.uint8)


def padded(picture: Image) -> Image:
    """Black on the right and below, up to the next multiple."""
    height, width = picture.shape[:2]
    below, right = -height % MULTIPLE_PX, -width % MULTIPLE_PX
    return np.asarray(cv2.copyMakeBorder(picture, 0, below, 0, right, cv2.BORDER_CONSTANT), dtype=np.uint8)


def planes(pictures: NDArray[np.uint8]) -> NDArray[np.float32]:
    """(N, H, W, 3) bytes to (N, 3, H, W) from 0 to 1."""
    return np.ascontiguousarray(pictures.transpose(0, 3, 1, 2), dtype=np.float32) / np.float32(255.0)


def crop(rgb: Image, lens: Lens, u_px: float, v_px: float, side_px: int = CROP_PX, turn_deg: float = 0.0) -> Image:
    """What is around a cube's top, at one size for all; turned counter-clockwise about its middle when asked to."""
    edge_px = lens.focal_px * CUBE_EDGE_M / max(0.3, lens.position_enu_m[2] - CUBE_EDGE_M)
    scale = CROP_PX / (CROP_EDGES * edge_px)
    move = cv2.getRotationMatrix2D((u_px, v_px), turn_deg, scale)
    move[:, 2] += np.array([side_px / 2.0 - u_px, side_px / 2.0 - v_px])
    return np.asarray(cv2.warpAffine(rgb, move, (side_px, side_px), flags=cv2.INTER_LINEAR), dtype=np.uint8)
