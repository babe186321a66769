"""Cubes with letters, coloured cubes and a walking robot, seen from above, without a language model.

One network finds, another reads the letter on a cube's top. What comes out has the form of a vision model's report, in
cells of the grid, so that whoever uses the one can use the other.
"""

from math import atan2
from pathlib import Path

import cv2
import numpy as np
import onnxruntime

from devices.vision.cube_layout import (
    KINDS,
    LETTERED,
    LETTERS,
    OFFSET_SCALE_PX,
    STRIDE_PX,
    crop,
    finder_picture,
    finder_scale,
    padded,
    planes,
)
from devices.vision.gridmask import grid_for
from devices.vision.lens import Floats, Image, Lens
from devices.vision.prompt import PARTS, WALKER
from devices.vision.reply import Entry, Report

LEAST_HEAT, LEAST_LETTER = 0.35, 0.4
CROWDED_PX = 12.0
"""At the finder's scale, where a cube is 25 wide: two finds nearer than this are one."""


class CubeDetector:
    """The shipped networks, or others by their folder."""

    def __init__(self, folder: Path | None = None) -> None:
        self._finder = _session((folder or Path(__file__).parent) / "cube_finder.onnx")
        self._reader = _session((folder or Path(__file__).parent) / "cube_reader.onnx")

    def report(self, rgb: Image, lens: Lens) -> Report:
        """What is in a picture from a camera that looks down."""
        grid = grid_for(lens)
        found = [(kind, u, v) for kind, u, v in self._find(rgb, lens) if grid.contains(*grid.cells(u, v))]
        cubes = [(u, v) for kind, u, v in found if kind == LETTERED]
        letters = iter(self._read(rgb, lens, cubes))
        entries = []
        for kind, u, v in found:
            x, y = grid.cells(u, v)
            if kind in PARTS:
                entries.append(Entry(WALKER, x, y, part=kind))
            elif kind != LETTERED:
                entries.append(Entry(kind, x, y))
            elif (read := next(letters)) is not None:
                entries.append(Entry(f"cube_{read[0]}", x, y, yaw_rad=read[1]))
        return Report(tuple(entries))

    def _find(self, rgb: Image, lens: Lens) -> list[tuple[str, float, float]]:
        """Kind and pixel of everything, strongest first."""
        picture = finder_picture(rgb, lens)
        (output,) = self._finder.run(None, {"picture": planes(padded(picture)[None])})
        maps: Floats = np.asarray(output[0], dtype=np.float64)
        heat = 1.0 / (1.0 + np.exp(-maps[: len(KINDS)]))
        scale = finder_scale(lens)
        finds = []
        for kind, plane in zip(KINDS, heat, strict=True):
            peaks = (plane >= cv2.dilate(plane, np.ones((3, 3)))) & (plane > LEAST_HEAT)
            for row, column in np.argwhere(peaks).tolist():
                u = (column + 0.5) * STRIDE_PX + maps[len(KINDS), row, column] * OFFSET_SCALE_PX
                v = (row + 0.5) * STRIDE_PX + maps[len(KINDS) + 1, row, column] * OFFSET_SCALE_PX
                finds.append((float(plane[row, column]), kind, float(u), float(v)))
        kept: list[tuple[str, float, float]] = []
        for _, kind, u, v in sorted(finds, reverse=True):
            part = kind in PARTS
            if all(abs(u - a) + abs(v - b) > CROWDED_PX or (k in PARTS) != part for k, a, b in kept):
                if part and any(k == kind for k, _, _ in kept):
                    continue
                kept.append((kind, u, v))
        return [(kind, u / scale, v / scale) for kind, u, v in kept]

    def _read(self, rgb: Image, lens: Lens, at: list[tuple[float, float]]) -> list[tuple[str, float] | None]:
        """Letter and turn of every cube; None where none can be read."""
        if not at:
            return []
        crops = np.array([crop(rgb, lens, u, v) for u, v in at], dtype=np.uint8)
        (output,) = self._reader.run(None, {"picture": planes(crops)})
        results: list[tuple[str, float] | None] = []
        for row in np.asarray(output, dtype=np.float64):
            odds = np.exp(row[: len(LETTERS)] - row[: len(LETTERS)].max())
            best = int(odds.argmax())
            sure = float(odds[best] / odds.sum()) >= LEAST_LETTER
            results.append((LETTERS[best], atan2(row[-1], row[-2])) if sure else None)
        return results


def _session(path: Path) -> onnxruntime.InferenceSession:
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 3
    return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
