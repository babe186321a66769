"""From pixels to the site: where a detected thing is and how sure that is.

A camera with depth measures the visible surface and adds how far behind it the centre lies. One without meets the
ray through the object's centre with the horizontal plane at the centre's height: exact along two axes, stretched
along the ray when the height is uncertain.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from devices.vision.detector import Detection
from devices.vision.lens import Depth, Floats, Lens
from wire.messages.observation import Covariance
from wire.model import Vec3

PIXEL_SD_PX = 1.0
BOX_SD = 0.04
"""The centre of a large box is less certain, in proportion to its size."""
MIN_DROP = 0.04
"""A ray this close to level (metres down per metre along the optical axis) meets no plane at a useful place."""
MAX_DEPTH_M = 12.0
DEPTH_SD = 0.02
"""Relative error of a measured depth."""
DEPTH_FLOOR_SD_M = 0.03
MIN_SD_M = 0.03


@dataclass(frozen=True)
class Sighting:
    """A detection and where in the site it is."""

    detection: Detection
    position_enu_m: Vec3
    """Centre of the object."""
    covariance_m2: Covariance
    depth_m: float
    """Along the optical axis."""


def locate(detections: Sequence[Detection], lens: Lens, depth_m: Depth | None = None) -> list[Sighting]:
    """Every detection that has a place; without depth those whose ray does not meet their plane are left out."""
    if not detections:
        return []
    found = []
    rays = lens.rays([d.u_px for d in detections], [d.v_px for d in detections])
    for detection, ray in zip(detections, rays, strict=True):
        surface_m = None if depth_m is None else surface_depth_m(detection, depth_m)
        if surface_m is None:
            sighting = on_plane(detection, ray, lens)
        else:
            sighting = at_depth(detection, ray, surface_m, lens)
        if sighting is not None:
            found.append(sighting)
    return found


def surface_depth_m(detection: Detection, depth_m: Depth) -> float | None:
    """Median depth in the middle of the visible box, or None where nothing was measured."""
    left, top, right, bottom = detection.box_px
    u, v = (left + right) / 2.0, (top + bottom) / 2.0
    half_width, half_height = max(0.6, (right - left) / 6.0), max(0.6, (bottom - top) / 6.0)
    rows = slice(max(0, int(v - half_height)), max(1, int(np.ceil(v + half_height))))
    columns = slice(max(0, int(u - half_width)), max(1, int(np.ceil(u + half_width))))
    patch = depth_m[rows, columns]
    measured = patch[patch > 0.0]
    return float(np.median(measured)) if measured.size else None


def at_depth(detection: Detection, ray: Floats, surface_m: float, lens: Lens) -> Sighting:
    """A measured surface, and the learned way from there to the centre."""
    along_m = max(surface_m + detection.behind_m, 0.05)
    point = np.array(lens.position_enu_m) + ray * along_m
    depth_sd_m = DEPTH_FLOOR_SD_M + DEPTH_SD * surface_m + 0.3 * abs(detection.behind_m)
    across_m = _pixel_sd(detection) / lens.focal_px * along_m
    slope = np.outer(ray, ray) * depth_sd_m**2 + (np.eye(3) * across_m**2)
    return Sighting(detection, _vec3(point), _covariance(slope), along_m)


def on_plane(detection: Detection, ray: Floats, lens: Lens) -> Sighting | None:
    """Where the ray meets the horizontal plane at the predicted height of the centre."""
    drop_m = lens.position_enu_m[2] - detection.height_m
    if abs(ray[2]) < MIN_DROP or drop_m / -ray[2] <= 0.05:
        return None
    along_m = float(drop_m / -ray[2])
    if along_m > MAX_DEPTH_M:
        return None
    point = np.array(lens.position_enu_m) + ray * along_m
    right, down, _ = lens.axes
    pixel = _pixel_sd(detection) / lens.focal_px
    # A shift of the ray sideways, or up and down, moves the point within the plane only.
    sideways = along_m * (right - ray * right[2] / ray[2]) * pixel
    upright = along_m * (down - ray * down[2] / ray[2]) * pixel
    higher = (ray / ray[2]) * detection.height_sd_m
    matrix = np.outer(sideways, sideways) + np.outer(upright, upright) + np.outer(higher, higher)
    return Sighting(detection, _vec3(point), _covariance(matrix), along_m)


def _pixel_sd(detection: Detection) -> float:
    if detection.pixel_sd_px is not None:
        return detection.pixel_sd_px
    left, top, right, bottom = detection.box_px
    return PIXEL_SD_PX + BOX_SD * max(right - left, bottom - top)


def _covariance(matrix: Floats) -> Covariance:
    floor = MIN_SD_M**2
    return (float(matrix[0, 0] + floor), float(matrix[0, 1]), float(matrix[1, 1] + floor), float(matrix[2, 2] + floor))


def _vec3(point: Floats) -> Vec3:
    return (float(point[0]), float(point[1]), float(point[2]))
