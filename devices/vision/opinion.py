"""Which of the things that a vision model names does the detector know already? Compared in the picture, by name and place.

A model errs by more than the detector, and has no depth: the same thing may come out a metre away on the floor, but
hardly a cell away in the picture.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

from devices.vision.gridmask import grid_for
from devices.vision.look import Seen
from devices.vision.projection import Sighting
from devices.vision.track import Track
from wire.catalogue import type_row

SAME_NAME_CELLS = 1.5
OTHER_NAME_CELLS = 0.5
"""Nearer than this, two names are meant for one thing."""
LARGE_SHARE = 0.5
"""What is large may be pointed at anywhere within this part of its size."""


@dataclass(frozen=True)
class Opinion:
    """Sightings by their numbers: those of a known track, with its number, and those of things nobody knew."""

    agreed: dict[int, int]
    new: tuple[int, ...]


def compare(tracks: Sequence[Track], seen: Seen) -> Opinion:
    """Nearest pairs first. What is near to a known thing of its name is never new, even if another one is nearer to it:
    two entries for one thing are a slip that models often make."""
    pairs = []
    for i, sighting in enumerate(seen.sightings):
        for j, track in enumerate(tracks):
            cost = _cost(track, sighting, seen)
            if cost is not None:
                pairs.append((cost, i, j))
    agreed: dict[int, int] = {}
    used: set[int] = set()
    for _, i, j in sorted(pairs):
        if i not in agreed and j not in used:
            agreed[i] = j
            used.add(j)
    doubled = {i for _, i, _ in pairs} - agreed.keys()
    return Opinion(agreed, tuple(i for i in range(len(seen.sightings)) if i not in agreed and i not in doubled))


def _cost(track: Track, sighting: Sighting, seen: Seen) -> float | None:
    """Cells apart in the picture, more for another name; None when they cannot be one thing."""
    u, v, depth_m = seen.lens.pixels(track.position)[0].tolist()
    if depth_m <= 0.1:
        return None
    detection = sighting.detection
    apart_px = hypot(u - detection.u_px, v - detection.v_px)
    left, top, right, bottom = track.box_px
    apart_px = max(0.0, apart_px - LARGE_SHARE * min(right - left, bottom - top) / 2.0)
    cells = apart_px / grid_for(seen.lens).cell_px
    if track.type == detection.type:
        return cells if cells <= SAME_NAME_CELLS else None
    return cells + 1.0 if cells <= OTHER_NAME_CELLS and _carried(track.type) == _carried(detection.type) else None


def _carried(type: str) -> bool:
    """What is carried lies on furniture, in the same place of the picture: such two are never one."""
    return type_row(type).kind == "pickup"
