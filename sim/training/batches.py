"""From shards to batches: windows of pictures around rare things, flipped and re-lit, with their targets."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from devices.vision import layout
from devices.vision.lens import Image, Lens
from sim.training.labels import Labels
from sim.training.shards import Shard
from sim.training.targets import Target, make_target

WINDOW_PX = (256, 320)
"""Rows and columns of a training picture; the scale is that of the camera."""
WHOLE_PX = (480, 640)
WHOLE_SHARE = 0.35
"""Of the batches, that are a few whole pictures: near a camera a bed is larger than a window."""
MIN_VISIBLE_PX = 14
MIN_VISIBLE = 0.35
"""Of its area were nothing in front of it: less, and missing it is no fault."""


@dataclass
class Batch:
    """Arrays for the network, first axis the picture."""

    pictures: NDArray[np.float32]
    targets: tuple[Target, Target]


@dataclass
class Window:
    """A piece of a picture and what is in it."""

    rgb: Image
    planes: NDArray[np.float32]
    """The network's two channels of geometry."""
    labels: Labels
    clear: NDArray[np.bool_]


def clear_enough(labels: Labels) -> NDArray[np.bool_]:
    """Which labels a detector must find: enough pixels, and enough of the thing, of them visible.

    How much of its box's outline a type fills when unhidden is taken from the labels themselves.
    """
    share = labels["visible_px"] / np.maximum(labels["hull_px"], 1.0)
    clear = labels["visible_px"] >= MIN_VISIBLE_PX
    for number in np.unique(labels["type"]):
        of_type = labels["type"] == number
        full = float(np.quantile(share[of_type], 0.9))
        clear &= ~of_type | (share >= MIN_VISIBLE * full)
    return clear


class Sampler:
    """Endless batches from a shard, the same ones for the same seed."""

    def __init__(self, shard: Shard, batch: int, seed: int) -> None:
        self._shard, self._batch = shard, batch
        self._rng = np.random.default_rng(seed)
        self._clear = clear_enough(shard.labels)
        counts = np.bincount(shard.labels["type"][self._clear], minlength=len(layout.detector_types()))
        self._rarity = 1.0 / np.sqrt(np.maximum(counts, 20))
        self._is_large = np.array([lens.width_px >= WHOLE_PX[1] for lens in shard.lenses])
        self._weights = self._frame_weights()

    def _frame_weights(self) -> NDArray[np.float64]:
        """Rare things first; both kinds of camera equally often."""
        weights = np.array([self._frame_weight(span) for span in self._shard.spans])
        for kind in (self._is_large, ~self._is_large):
            weights[kind] /= max(1e-9, float(weights[kind].sum()))
        result: NDArray[np.float64] = weights / weights.sum()
        return result

    def _frame_weight(self, span: slice) -> float:
        types = self._shard.labels["type"][span][self._clear[span]]
        return float(self._rarity[types].sum() + 0.3 * self._rarity.mean())

    def __iter__(self) -> Iterator[Batch]:
        while True:
            whole = bool(self._is_large.any()) and self._rng.random() < WHOLE_SHARE
            size_px = WHOLE_PX if whole else WINDOW_PX
            weights = self._weights * self._is_large if whole else self._weights
            count = max(1, self._batch // 4) if whole else self._batch
            chosen = self._rng.choice(len(weights), count, p=weights / weights.sum())
            yield self._collate([self._window(int(i), size_px) for i in chosen], size_px)

    def _collate(self, windows: list[Window], size_px: tuple[int, int]) -> Batch:
        pictures = np.empty((len(windows), 5, *size_px), np.float32)
        per_head: tuple[list[Target], list[Target]] = ([], [])
        for picture, window in zip(pictures, windows, strict=True):
            picture[:3] = window.rgb.transpose(2, 0, 1) * np.float32(1.0 / 255.0)
            picture[3:] = window.planes
            for head, targets in zip(layout.heads(), per_head, strict=True):
                clear, open_ = window.labels[window.clear], window.labels[~window.clear]
                targets.append(make_target(head, clear, open_, size_px))
        return Batch(pictures, (_stack(per_head[0]), _stack(per_head[1])))

    def _window(self, frame: int, size_px: tuple[int, int]) -> Window:
        shard, span = self._shard, self._shard.spans[frame]
        bgr = cv2.imdecode(np.frombuffer(shard.jpegs[frame], np.uint8), cv2.IMREAD_COLOR)
        rgb: Image = np.asarray(bgr)[:, :, ::-1]
        labels, clear = shard.labels[span].copy(), self._clear[span]
        top, left = self._corner(labels, clear, rgb.shape[:2], size_px)
        window = cut_window(rgb, shard.lenses[frame], labels, clear, (top, left), size_px)
        if self._rng.random() < 0.5:
            window = _flip(window)
        return replace(window, rgb=self._relight(window.rgb))

    def _corner(
        self, labels: Labels, clear: NDArray[np.bool_], picture_px: tuple[int, ...], size_px: tuple[int, int]
    ) -> tuple[int, int]:
        """Top left of a window: about a thing, the rarer the likelier, or anywhere."""
        room = (max(0, picture_px[0] - size_px[0]), max(0, picture_px[1] - size_px[1]))
        if not clear.any() or self._rng.random() < 0.2:
            return int(self._rng.integers(room[0] + 1)), int(self._rng.integers(room[1] + 1))
        weights = self._rarity[labels["type"][clear]]
        left, top, right, bottom = labels["box"][clear][self._rng.choice(len(weights), p=weights / weights.sum())]
        middle = ((top + bottom) / 2.0, (left + right) / 2.0)
        corner = [
            int(np.clip(m - n * self._rng.uniform(0.15, 0.85), 0, r))
            for m, n, r in zip(middle, size_px, room, strict=True)
        ]
        return corner[0], corner[1]

    def _relight(self, rgb: Image) -> Image:
        """Exposure, white balance, contrast, sensor noise and a little blur, of another camera on another day."""
        rng = self._rng
        gain = np.exp(rng.normal(0.0, 0.12)) * np.exp(rng.normal(0.0, 0.03, 3))
        level = np.arange(256)[:, None] / 255.0
        curve = np.clip(gain * level ** np.exp(rng.normal(0.0, 0.12)) + rng.normal(0.0, 0.015), 0.0, 1.0)
        table = np.ascontiguousarray((curve * 255.0).astype(np.uint8)[None])
        lit: Image = cv2.LUT(np.ascontiguousarray(rgb), table).astype(np.uint8)
        if rng.random() < 0.15:
            lit = cv2.GaussianBlur(lit, (3, 3), rng.uniform(0.3, 0.8)).astype(np.uint8)
        if rng.random() < 0.4:
            noise = rng.standard_normal(lit.shape, dtype=np.float32) * np.float32(rng.uniform(1.0, 7.0))
            lit = np.clip(lit + noise, 0.0, 255.0).astype(np.uint8)
        return lit


def cut_window(
    rgb: Image,
    lens: Lens,
    labels: Labels,
    clear: NDArray[np.bool_],
    corner: tuple[int, int],
    size_px: tuple[int, int] = WINDOW_PX,
) -> Window:
    """Rows and columns of a picture from its top left corner on, padded with black where the picture ends."""
    top, left = corner
    rows, columns = min(size_px[0], rgb.shape[0] - top), min(size_px[1], rgb.shape[1] - left)
    piece = np.zeros((*size_px, 3), np.uint8)
    piece[:rows, :columns] = rgb[top : top + rows, left : left + columns]
    planes = np.zeros((2, *size_px), np.float32)
    planes[0, :rows, :columns] = lens.floor_rows()[top : top + rows, None]
    planes[1] = lens.position_enu_m[2] / 3.0
    labels, inside = _clip(labels, top, left, rows, columns)
    return Window(piece, planes, labels[inside > 0.0], (clear & (inside >= MIN_VISIBLE))[inside > 0.0])


def _clip(labels: Labels, top: int, left: int, rows: int, columns: int) -> tuple[Labels, NDArray[np.float64]]:
    """Labels in the window's pixels, and the share of each box that lies inside."""
    labels = labels.copy()
    shift = np.array([left, top, left, top], np.float32)
    whole = labels["box"] - shift
    box = np.clip(whole, 0.0, np.array([columns, rows, columns, rows], np.float32))
    labels["box"], labels["centre"] = box, labels["centre"] - shift[:2]
    area = (box[:, 2] - box[:, 0]) * (box[:, 3] - box[:, 1])
    return labels, area / np.maximum((whole[:, 2] - whole[:, 0]) * (whole[:, 3] - whole[:, 1]), 1.0)


def _flip(window: Window) -> Window:
    """Left to right; a padded picture is flipped with its padding, which is on the right only when it is none."""
    labels, width = window.labels.copy(), window.rgb.shape[1]
    labels["box"][:, [0, 2]] = width - labels["box"][:, [2, 0]]
    labels["centre"][:, 0] = width - labels["centre"][:, 0]
    return Window(np.ascontiguousarray(window.rgb[:, ::-1]), window.planes, labels, window.clear)


def _stack(targets: list[Target]) -> Target:
    return Target(
        np.stack([t.heat for t in targets]),
        np.stack([t.weight_heat for t in targets]),
        np.stack([t.values for t in targets]),
        np.stack([t.classes for t in targets]),
        np.stack([t.weight for t in targets]),
    )
