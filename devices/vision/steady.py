"""A detector that looks again only when the picture has changed: most pictures of a fixed camera show nothing new."""

import cv2
import numpy as np
from numpy.typing import NDArray

from devices.vision.detector import Detection, Detector
from devices.vision.lens import Image, Lens

CELL_PX = 8
"""Pictures are compared by the mean colours of squares this wide, which sensor noise hardly moves."""
CHANGED_LEVELS = 6.0
"""Of 255: a smallest thing that counts, 14 pixels, of another shade, moves the mean of its square by more."""
MOST_REPEATS = 10
"""Then it looks anyway: what was overlooked may be found, and slow changes of light are taken in."""


Cells = NDArray[np.float32]


class SteadyDetector:
    """Wraps the detector of one camera. A camera that has moved is looked through anew."""

    def __init__(self, detector: Detector) -> None:
        self._detector = detector
        self._lens: Lens | None = None
        self._cells: Cells | None = None
        self._found: list[Detection] = []
        self._repeats = 0

    def look(self, rgb: Image, lens: Lens) -> list[Detection]:
        """See devices.vision.detector.Detector; what was found in the last picture that differed."""
        cells = cells_of(rgb)
        if lens == self._lens and self._repeats < MOST_REPEATS and alike(cells, self._cells):
            self._repeats += 1
            return list(self._found)
        self._found = self._detector.look(rgb, lens)
        self._lens, self._cells, self._repeats = lens, cells, 0
        return list(self._found)


def cells_of(rgb: Image) -> Cells:
    """Mean colours of a picture's squares."""
    height_px, width_px = rgb.shape[:2]
    size = (max(1, width_px // CELL_PX), max(1, height_px // CELL_PX))
    return np.asarray(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA), dtype=np.float32)


def alike(a: Cells, b: Cells | None) -> bool:
    """Whether nothing that counts has changed from one picture to the other."""
    return b is not None and a.shape == b.shape and float(np.abs(a - b).max()) < CHANGED_LEVELS
