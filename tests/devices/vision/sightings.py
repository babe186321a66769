"""Sightings as a camera that makes small mistakes would report them."""

import numpy as np

from devices.vision import layout
from devices.vision.detector import Detection
from devices.vision.lens import Depth, Lens
from devices.vision.look import Seen
from devices.vision.projection import Sighting

LENS = Lens(640, 480, 320.0, (0.0, 0.0, 2.3), 0.0, 0.5)
Place = tuple[str, float, float, float]


def sighting(what: Place, lens: Lens = LENS, props: dict[str, float] | None = None, sure: float = 0.9) -> Sighting:
    """One thing (type, x, y, z) where the lens sees it."""
    name, *position = what
    u, v, depth_m = lens.pixels(position)[0].tolist()
    size_px = lens.focal_px * 0.2 / depth_m if name in layout.heads()[0].types else lens.focal_px * 0.9 / depth_m
    half = size_px / 2.0
    types = layout.detector_types()
    log_probs = np.full(len(types), np.log((1.0 - sure) / len(types)))
    log_probs[types.index(name)] = np.log(sure)
    box = (u - half, v - half, u + half, v + half)
    detection = Detection(name, sure, u, v, box, position[2], 0.05, 0.1, props or {}, log_probs)
    return Sighting(detection, (position[0], position[1], position[2]), (0.01, 0.0, 0.01, 0.0025), depth_m)


def seen(stamp_s: float, *sightings: Sighting, lens: Lens = LENS, depth_m: Depth | None = None) -> Seen:
    return Seen(stamp_s, lens, depth_m, sightings)
