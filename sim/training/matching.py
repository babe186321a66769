"""Which detection is of which thing: the one rule by which the detector is judged."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from devices.vision import layout
from devices.vision.detector import overlap
from devices.vision.projection import Sighting
from sim.training.labels import Labels

MIN_IOU = 0.3
NEAR_PX = 5.0
"""Boxes of a few pixels hardly overlap when they are one pixel off."""


@dataclass
class Matched:
    """One picture: pairs of label and sighting, sightings of nothing, and clear labels that were missed."""

    pairs: list[tuple[Labels, Sighting]]
    wrong: list[Sighting]
    missed: Labels


def match(labels: Labels, clear: NDArray[np.bool_], sightings: Sequence[Sighting]) -> Matched:
    """Strongest sightings first, each to the best free label of its type; the unclear ones count neither way."""
    names = layout.detector_types()
    used: set[int] = set()
    pairs, wrong = [], []
    for sighting in sorted(sightings, key=lambda s: -s.detection.confidence):
        fits = [(_fit(labels[i], sighting), i) for i in range(len(labels)) if i not in used]
        right = [(fit, i) for fit, i in fits if fit > 0.0 and names[labels["type"][i]] == sighting.detection.type]
        if not right:
            wrong.append(sighting)
            continue
        _, best = max(right)
        used.add(best)
        if clear[best]:
            pairs.append((labels[best], sighting))
    missed = labels[[i for i in range(len(labels)) if clear[i] and i not in used]]
    return Matched(pairs, wrong, missed)


def _fit(label: Labels, sighting: Sighting) -> float:
    """How well boxes agree; 0 when they are not of one thing."""
    left, top, right, bottom = (float(x) for x in label["box"])
    shared = overlap((left, top, right, bottom), sighting.detection.box_px)
    a, b, c, d = sighting.detection.box_px
    apart = float(np.hypot((left + right - a - c) / 2.0, (top + bottom - b - d) / 2.0))
    if apart < NEAR_PX:
        return max(shared, 0.1)
    return shared if shared >= MIN_IOU else 0.0
