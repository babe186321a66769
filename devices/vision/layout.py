"""The detector network's inputs and outputs: channel numbers and scales shared by its users and its trainer."""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from devices.vision.lens import Image, Lens
from wire.catalogue import catalogue, modelled_types

ROBOT = "Robot"
"""Seen, so that it is known to hide things; never published as an object."""

IMPOSSIBLE = -12.0
"""Log-probability of a type that somebody cannot tell or does not know."""

MULTIPLE_PX = 32
"""Pictures are padded to a multiple of this."""

# Channels of a head, before its class logits.
HEAT, CENTRE, SIZE, HEIGHT, HEIGHT_SPREAD, BEHIND, PROPS = 0, slice(1, 3), slice(3, 5), 5, 6, 7, slice(8, 12)
CLASSES = 12

CENTRE_SCALE_PX = 16.0
"""The projected centre of the object is given relative to its cell, in this unit."""
SIZE_SCALE_PX = 32.0
"""Width and height of the visible box are exp(output) of this unit."""


@dataclass(frozen=True)
class Head:
    """One output map: its stride and the types it tells apart."""

    name: str
    stride_px: int
    types: tuple[str, ...]

    @property
    def channels(self) -> int:
        return CLASSES + len(self.types)


@lru_cache(maxsize=1)
def detector_types() -> tuple[str, ...]:
    """All classes: the modelled types in their order, then the robot."""
    return (*modelled_types(), ROBOT)


@lru_cache(maxsize=1)
def known_types() -> tuple[str, ...]:
    """What somebody with more words than the network may call things: its classes, then the catalogue's other types."""
    own = detector_types()
    others = sorted(name for name, row in catalogue().items() if name not in own and row.kind != "structure")
    return (*own, *others)


def widened(log_probs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Log-probabilities over the network's classes, or over all types already, as over all `known_types()`."""
    wide = np.full(len(known_types()), IMPOSSIBLE)
    wide[: len(log_probs)] = log_probs
    return wide


@lru_cache(maxsize=1)
def heads() -> tuple[Head, Head]:
    """Things one can pick up on a fine grid, furniture and robots on a coarse one.

    Two maps, because a bowl in the middle of a table has the table's own centre.
    """
    rows = catalogue()
    small = tuple(t for t in modelled_types() if rows[t].kind == "pickup")
    large = tuple(t for t in detector_types() if t not in small)
    return Head("small", 4, small), Head("large", 8, large)


def network_input(rgb: Image, lens: Lens) -> NDArray[np.float32]:
    """(1, 5, H, W): red, green, blue in 0..1, one over the depth of the floor, the camera's height over 3 m."""
    height_px, width_px = (_padded(n) for n in rgb.shape[:2])
    planes = np.zeros((1, 5, height_px, width_px), dtype=np.float32)
    for channel, plane in enumerate(cv2.split(rgb)):
        np.multiply(plane, np.float32(1.0 / 255.0), out=planes[0, channel, : rgb.shape[0], : rgb.shape[1]])
    planes[0, 3, : rgb.shape[0], : rgb.shape[1]] = lens.floor_rows()[:, None]
    planes[0, 4] = lens.position_enu_m[2] / 3.0
    return planes


def _padded(size_px: int) -> int:
    return -(-size_px // MULTIPLE_PX) * MULTIPLE_PX
