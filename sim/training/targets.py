"""What the network should say about a picture: heat, regressions and classes for each head, as arrays."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from devices.vision import layout
from sim.training.labels import Labels

Floats = NDArray[np.float32]


@dataclass
class Target:
    """For one head of one picture; `values` and `classes` count where `weight` is positive."""

    heat: Floats
    weight_heat: Floats
    """0 where it is open whether something should be seen."""
    values: Floats
    """Channels 1..11 of the head (its heat left out)."""
    classes: NDArray[np.int64]
    weight: Floats


def make_target(head: layout.Head, labels: Labels, ignored: Labels, size_px: tuple[int, int]) -> Target:
    """`labels` should be found, `ignored` may be; boxes and centres in pixels of this picture."""
    stride = head.stride_px
    rows, columns = size_px[0] // stride, size_px[1] // stride
    target = Target(
        np.zeros((rows, columns), np.float32),
        np.ones((rows, columns), np.float32),
        np.zeros((layout.CLASSES - 1, rows, columns), np.float32),
        np.full((rows, columns), -1, np.int64),
        np.zeros((rows, columns), np.float32),
    )
    names = layout.detector_types()
    for label in ignored:
        if names[label["type"]] in head.types:
            left, top, right, bottom = (label["box"] / stride).astype(int)
            target.weight_heat[top : bottom + 1, left : right + 1] = 0.0
    order = np.argsort(-(labels["box"][:, 2] - labels["box"][:, 0]), kind="stable")
    for label in labels[order]:  # the smaller overwrite the larger
        name = names[label["type"]]
        if name in head.types:
            _mark(target, label, head.types.index(name), stride)
    return target


def _mark(target: Target, label: Labels, number: int, stride: int) -> None:
    """One thing: a bump of heat at its box's centre, and values in the cells about it."""
    left, top, right, bottom = (float(x) for x in label["box"])
    u, v = (left + right) / 2.0, (top + bottom) / 2.0
    rows, columns = target.heat.shape
    column, row = min(int(u / stride), columns - 1), min(int(v / stride), rows - 1)
    sigma = min(max(min(right - left, bottom - top) / stride / 7.0, 0.7), 2.2)
    reach = int(3.0 * sigma) + 1
    r0, r1, c0, c1 = (
        max(0, row - reach),
        min(rows, row + reach + 1),
        max(0, column - reach),
        min(columns, column + reach + 1),
    )
    grid_r, grid_c = np.mgrid[r0:r1, c0:c1]
    bump = np.exp(-((grid_r + 0.5 - v / stride) ** 2 + (grid_c + 0.5 - u / stride) ** 2) / (2.0 * sigma**2))
    window = target.heat[r0:r1, c0:c1]
    np.maximum(window, bump, out=window)
    target.heat[row, column] = 1.0
    target.weight_heat[row, column] = 1.0
    for r, c, weight in _neighbours(row, column, rows, columns):
        if weight < 1.0 and target.weight[r, c] == 1.0:
            continue
        target.weight[r, c], target.classes[r, c] = weight, number
        target.values[:, r, c] = _values(label, (c + 0.5) * stride, (r + 0.5) * stride)


def _neighbours(row: int, column: int, rows: int, columns: int) -> Sequence[tuple[int, int, float]]:
    """The cell itself in full, those about it in part."""
    cells = [(row + dr, column + dc, 1.0 if dr == dc == 0 else 0.3) for dr in (-1, 0, 1) for dc in (-1, 0, 1)]
    return [(r, c, w) for r, c, w in cells if 0 <= r < rows and 0 <= c < columns]


def _values(label: Labels, u_px: float, v_px: float) -> Floats:
    """In the order of the head's channels after its heat."""
    left, top, right, bottom = label["box"]
    return np.array(
        [
            (label["centre"][0] - u_px) / layout.CENTRE_SCALE_PX,
            (label["centre"][1] - v_px) / layout.CENTRE_SCALE_PX,
            np.log(max(right - left, 1.0) / layout.SIZE_SCALE_PX),
            np.log(max(bottom - top, 1.0) / layout.SIZE_SCALE_PX),
            label["position"][2],
            0.0,
            label["behind"],
            *label["props"],
        ],
        dtype=np.float32,
    )
