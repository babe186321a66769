"""What is true of a picture: one row for each thing in it, from the picture's owner ids."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from devices.vision import layout
from devices.vision.detector import Detection
from devices.vision.lens import Depth, Lens
from devices.vision.projection import surface_depth_m
from wire.catalogue import PROP_FLAG, PROPS, catalogue
from wire.model import Vec3

LABEL = np.dtype(
    [
        ("frame", np.int32),
        ("key", np.int32),
        ("type", np.int16),
        ("box", np.float32, 4),
        ("centre", np.float32, 2),
        ("visible_px", np.int32),
        ("hull_px", np.float32),
        ("position", np.float32, 3),
        ("behind", np.float32),
        ("props", np.int8, len(PROPS)),
    ]
)
"""`box`: of what is visible. `centre`: the projected centre of the whole thing. `hull_px`: area of its bounding box's
outline, were nothing in front of it and the picture without borders. `props`: -1 where the type has none."""

Labels = NDArray[Any]


@dataclass(frozen=True)
class Thing:
    """What the labels need to know of a body or a robot."""

    type: str
    position_m: Vec3
    """Centre of the base."""
    yaw_rad: float
    size_m: Vec3
    props: Mapping[str, bool]


def label_picture(
    ids: NDArray[np.int32], depth_m: Depth, lens: Lens, things: Mapping[int, Thing], frame: int = 0
) -> Labels:
    """Every thing with at least one visible pixel."""
    numbers = {name: i for i, name in enumerate(layout.detector_types())}
    rows = []
    for key, box, visible_px in visible_boxes(ids):
        thing = things.get(key)
        if thing is None:
            continue
        corners, centre = _corners(thing)
        hull_px = _outline_area_px(lens.pixels(corners))
        u, v, centre_depth_m = lens.pixels(centre)[0]
        if centre_depth_m < 0.1:
            continue
        surface_m = _surface_depth_m(ids, depth_m, key, box)
        props = [int(thing.props[p]) if _has(thing.type, p, thing.props) else -1 for p in PROPS]
        rows.append(
            (
                frame,
                key,
                numbers[thing.type],
                box,
                (u, v),
                visible_px,
                hull_px,
                centre,
                centre_depth_m - surface_m,
                props,
            )
        )
    return np.array(rows, dtype=LABEL)


def visible_boxes(ids: NDArray[np.int32]) -> list[tuple[int, tuple[float, float, float, float], int]]:
    """(id, box, pixels) of every id in a picture, from one sort of its pixels."""
    flat = ids.ravel()
    order = np.argsort(flat, kind="stable")
    keys, starts = np.unique(flat[order], return_index=True)
    width = ids.shape[1]
    found = []
    for key, pixels in zip(keys.tolist(), np.split(order, starts[1:]), strict=True):
        rows, columns = pixels // width, pixels % width
        box = (columns.min(), rows.min(), columns.max() + 1.0, rows.max() + 1.0)
        found.append((key, tuple(float(x) for x in box), len(pixels)))
    return found  # type: ignore[return-value]


def _has(type_name: str, prop: str, props: Mapping[str, bool]) -> bool:
    row = catalogue().get(type_name)
    return row is not None and row.can(PROP_FLAG[prop]) and prop in props


def _corners(thing: Thing) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The eight corners of the bounding box, and its centre."""
    signs = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 1.0)])
    local = signs * np.array(thing.size_m)
    c, s = np.cos(thing.yaw_rad), np.sin(thing.yaw_rad)
    turned = np.stack([c * local[:, 0] - s * local[:, 1], s * local[:, 0] + c * local[:, 1], local[:, 2]], axis=1)
    centre = np.array((0.0, 0.0, thing.size_m[2] / 2.0))
    return turned + thing.position_m, centre + thing.position_m


def _outline_area_px(pixels: NDArray[np.float64]) -> float:
    """Area of the convex outline of projected corners; those behind the camera are left out."""
    ahead = pixels[pixels[:, 2] > 0.05]
    if len(ahead) < 3:
        return 1e9
    return float(cv2.contourArea(cv2.convexHull(ahead[:, :2].astype(np.float32))))


def _surface_depth_m(ids: NDArray[np.int32], depth_m: Depth, key: int, box: tuple[float, float, float, float]) -> float:
    """What `devices.vision.projection.surface_depth_m` will measure for this box."""
    measured = surface_depth_m(Detection("", 0.0, 0.0, 0.0, box, 0.0, 0.0, 0.0), depth_m)
    return float(np.median(depth_m[ids == key])) if measured is None else measured
