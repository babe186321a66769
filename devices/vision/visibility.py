"""Should this camera see a known thing in this picture? Only then does not seeing it mean anything."""

from devices.vision import layout
from devices.vision.look import Seen
from devices.vision.track import Track
from wire.catalogue import catalogue

MARGIN_PX = 8.0
HIDING_M = 0.3
"""Something this much nearer hides what is behind it."""


def should_be_visible(track: Track, seen: Seen) -> bool:
    """Inside the picture, as near as when it was seen, and nothing nearer in front of it."""
    u, v, depth_m = seen.lens.pixels(track.position)[0].tolist()
    inside = MARGIN_PX < u < seen.lens.width_px - MARGIN_PX and MARGIN_PX < v < seen.lens.height_px - MARGIN_PX
    if depth_m <= 0.1 or not inside or depth_m > 1.3 * track.first.depth_m + 0.3:
        return False
    if seen.depth_m is not None:
        return _depth_allows(u, v, depth_m, track, seen)
    return not any(
        other.detection.box_px[0] <= u <= other.detection.box_px[2]
        and other.detection.box_px[1] <= v <= other.detection.box_px[3]
        and other.depth_m < depth_m - HIDING_M
        and _hides(other.detection.type)
        for other in seen.sightings
    )


def _depth_allows(u: float, v: float, depth_m: float, track: Track, seen: Seen) -> bool:
    """Nothing measured in front of where the thing's near side should be."""
    assert seen.depth_m is not None
    measured_m = float(seen.depth_m[int(v), int(u)])
    row = catalogue().get(track.type)
    half_m = max(row.size_m) / 2.0 if row else 0.4
    return measured_m == 0.0 or measured_m > depth_m - half_m - 0.15


def _hides(type_name: str) -> bool:
    """Small things hide nothing that matters."""
    return type_name in layout.heads()[1].types
