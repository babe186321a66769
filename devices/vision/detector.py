"""From a picture to detections: the interface of every detector, and the one whose weights are shipped."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np
import onnxruntime
from numpy.typing import NDArray

from devices.vision import layout
from devices.vision.lens import Floats, Image, Lens
from wire.catalogue import PROP_FLAG, PROPS, catalogue
from wire.messages.observation import BoxPx

MIN_CONFIDENCE = 0.3
_SAME_THING_IOU = 0.6


@dataclass(frozen=True)
class Detection:
    """One object in one picture."""

    type: str
    confidence: float
    u_px: float
    v_px: float
    """Where the centre of the whole object is in the picture, whatever of it is hidden."""
    box_px: BoxPx
    """Left, top, right, bottom of what is visible."""
    height_m: float
    """Of the object's centre above the floor, with its standard deviation: what a camera without depth goes by."""
    height_sd_m: float
    behind_m: float
    """How far behind the visible surface the centre lies: what a camera with depth goes by."""
    props: dict[str, float] = field(default_factory=dict)
    """Probability that a property that this type has is true."""
    log_probs: Floats = field(default_factory=lambda: np.zeros(0), compare=False)
    """Log-probability of every type of `layout.detector_types()`, or of all `layout.known_types()`: votes to be added up
    over pictures."""
    pixel_sd_px: float | None = None
    """How well the detector knows the place in the picture; None: as the size of the box lets one expect."""


class Detector(Protocol):
    """Anything that names the things in a picture."""

    def look(self, rgb: Image, lens: Lens) -> list[Detection]:
        """What is in an RGB picture taken through this lens, strongest first."""


class EmbeddedDetector:
    """The shipped convolutional network: every size of picture, no accelerator, one thread."""

    def __init__(self, weights: Path | None = None, min_confidence: float = MIN_CONFIDENCE) -> None:
        options = onnxruntime.SessionOptions()
        options.enable_mem_pattern = False  # planning for one size of picture costs memory and saves no time
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        options.log_severity_level = 3
        path = weights or Path(__file__).with_name("weights.onnx")
        self._session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
        self._min_confidence = min_confidence

    def look(self, rgb: Image, lens: Lens) -> list[Detection]:
        maps = self._session.run(None, {"picture": layout.network_input(rgb, lens)})
        found: list[Detection] = []
        for head, output in zip(layout.heads(), maps, strict=True):
            found += _read_head(head, output[0], lens, self._min_confidence)
        found.sort(key=lambda d: (-d.confidence, d.type, d.u_px))
        return _without_doubles(found)


def _read_head(head: layout.Head, output: NDArray[np.float32], lens: Lens, min_confidence: float) -> list[Detection]:
    """Detections at the local maxima of a head's heat."""
    logits = np.ascontiguousarray(output[layout.HEAT])
    peaks = (logits >= cv2.dilate(logits, np.ones((3, 3), np.uint8))) & (logits > _logit(min_confidence))
    rows, columns = np.nonzero(peaks)
    cells = output[:, rows, columns].T.astype(np.float64)
    found = []
    for row, column, cell in zip(rows.tolist(), columns.tolist(), cells, strict=True):
        u_px, v_px = (column + 0.5) * head.stride_px, (row + 0.5) * head.stride_px
        detection = _read_cell(head, cell, u_px, v_px, lens)
        if detection.confidence >= min_confidence:
            found.append(detection)
    return found


def _read_cell(head: layout.Head, cell: Floats, u_px: float, v_px: float, lens: Lens) -> Detection:
    log_probs = cell[layout.CLASSES :] - _log_sum_exp(cell[layout.CLASSES :])
    best = int(log_probs.argmax())
    width, height = np.exp(np.clip(cell[layout.SIZE], -4.0, 3.5)) * layout.SIZE_SCALE_PX / 2.0
    right, bottom = cell[layout.CENTRE] * layout.CENTRE_SCALE_PX
    return Detection(
        type=head.types[best],
        confidence=float(_sigmoid(cell[layout.HEAT]) * np.exp(log_probs[best])),
        u_px=float(u_px + right),
        v_px=float(v_px + bottom),
        box_px=(
            max(0.0, float(u_px - width)),
            max(0.0, float(v_px - height)),
            min(float(lens.width_px), float(u_px + width)),
            min(float(lens.height_px), float(v_px + height)),
        ),
        height_m=float(cell[layout.HEIGHT]),
        height_sd_m=float(np.exp(np.clip(cell[layout.HEIGHT_SPREAD], -5.0, 1.0)) * np.sqrt(2.0)),
        behind_m=float(cell[layout.BEHIND]),
        props=_props(head.types[best], cell[layout.PROPS]),
        log_probs=_all_types(head, log_probs),
    )


def _props(type_name: str, logits: Floats) -> dict[str, float]:
    row = catalogue().get(type_name)
    if row is None:
        return {}
    return {p: float(_sigmoid(v)) for p, v in zip(PROPS, logits, strict=True) if row.can(PROP_FLAG[p])}


def _all_types(head: layout.Head, log_probs: Floats) -> Floats:
    """Spread a head's log-probabilities over all types; the other head's types are all but impossible."""
    everything = np.full(len(layout.detector_types()), layout.IMPOSSIBLE)
    index = {name: i for i, name in enumerate(layout.detector_types())}
    everything[[index[name] for name in head.types]] = np.maximum(log_probs, layout.IMPOSSIBLE)
    return everything


def _without_doubles(found: list[Detection]) -> list[Detection]:
    """Drop a detection that lies on a stronger one of the same type."""
    kept: list[Detection] = []
    for one in found:
        if not any(one.type == k.type and overlap(one.box_px, k.box_px) > _SAME_THING_IOU for k in kept):
            kept.append(one)
    return kept


def overlap(a: BoxPx, b: BoxPx) -> float:
    """Intersection over union of two boxes."""
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    if width <= 0.0 or height <= 0.0:
        return 0.0
    shared = width * height
    return shared / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - shared)


def _sigmoid(x: float) -> float:
    return float(1.0 / (1.0 + np.exp(-np.clip(x, -30.0, 30.0))))


def _logit(p: float) -> float:
    return float(np.log(p / (1.0 - p)))


def _log_sum_exp(x: Floats) -> float:
    top = float(x.max())
    return top + float(np.log(np.exp(x - top).sum()))
