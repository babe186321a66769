"""The view of a camera: its matrix, and the rows worth drawing for it, ordered and with their degree of detail."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.render.instances import Instances
from sim.render.meshes import BOX, DETAILS, SHADOW, SHAPES, TRIANGLE
from sim.render.picture import FAR_M, NEAR_M, ROBOT_ID, WALL_ID, Camera
from sim.render.portals import Portals
from sim.render.rows import Rows
from wire.frames import camera_axes

Matrix = NDArray[np.float64]

DETAIL_PX = (9.0, 40.0)
"""From this apparent radius on a round shape gets the next degree of detail."""
TINY_PX = 0.4
"""A shape with a smaller apparent radius is not drawn."""


def view_matrix(camera: Camera) -> Matrix:
    """4x4 from the site frame to the camera's RDF frame."""
    rotation = np.array(camera_axes(camera.yaw_rad, camera.tilt_down_rad))
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = -rotation @ np.array(camera.position_m)
    return matrix


def projection_matrix(camera: Camera) -> Matrix:
    """4x4 from RDF to clip space whose y points down, so that row 0 of what is read back is the top."""
    scale_x, scale_y = 2.0 * camera.focal_px / camera.width_px, 2.0 * camera.focal_px / camera.height_px
    span = FAR_M - NEAR_M
    return np.array(
        [
            (scale_x, 0.0, 0.0, 0.0),
            (0.0, scale_y, 0.0, 0.0),
            (0.0, 0.0, (FAR_M + NEAR_M) / span, -2.0 * FAR_M * NEAR_M / span),
            (0.0, 0.0, 1.0, 0.0),
        ]
    )


WAYS = THING, THING_PICTURED, BUILDING, BUILDING_PICTURED, SOFT_SHADOW = range(5)
"""In the order of drawing: things before the building, which is mostly behind them, and shadows on top of floors.

Things are lit at their corners, the large faces of the building at every pixel. Pictured ones have a surface.
"""


@dataclass(frozen=True)
class Batch:
    """Rows that share a mesh and a way of being lit, nearest first."""

    shape: int
    detail: int
    way: int
    """How its pixels come about, one of WAYS."""
    rows: Rows


def visible_batches(instances: Instances, portals: Portals, camera: Camera) -> list[Batch]:
    """Rows in the picture by room and by frustum, grouped by mesh."""
    rows = instances.rows()
    keep = (rows["rooms"] & portals.visible(camera)) != 0
    carrier = instances.robot_id(camera.carrier)
    if carrier is not None:
        keep &= rows["id"] != carrier
    rows = rows[keep]
    view = view_matrix(camera)
    centre = rows["centre"] @ view[:3, :3].T + view[:3, 3]
    middle, half = _bounds(rows, centre, rows["axes"] @ view[:3, :3].T)
    inside = _in_frustum(middle, half, camera)
    rows, middle, half = rows[inside], middle[inside], half[inside]
    radius_m = np.sqrt((half**2).sum(axis=(1, 2)))
    depth_m = np.maximum(middle[:, 2], NEAR_M)
    radius_px = camera.focal_px * radius_m / depth_m
    detail = np.where(np.isin(rows["shape"], (BOX, TRIANGLE, SHADOW)), 0, np.searchsorted(DETAIL_PX, radius_px))
    kind = (_ways(rows) * SHAPES + rows["shape"]) * DETAILS + detail
    order = np.lexsort((middle[:, 2] - radius_m, kind))
    order = order[radius_px[order] > TINY_PX]
    return _grouped(rows[order], kind[order])


def _ways(rows: Rows) -> NDArray[np.int64]:
    building = (rows["id"] >= WALL_ID) & (rows["id"] < ROBOT_ID)
    pictured = rows["surface"] > 0
    plain = np.where(building, BUILDING, THING)
    ways = np.where(pictured, np.where(building, BUILDING_PICTURED, THING_PICTURED), plain)
    return np.where(rows["shape"] == SHADOW, SOFT_SHADOW, ways)


def _bounds(rows: Rows, centre: Matrix, axes: Matrix) -> tuple[Matrix, Matrix]:
    """Middle and half sides of each row's box in the camera's frame."""
    half = axes / 2.0
    flat = rows["shape"] == TRIANGLE
    middle = centre + np.where(flat[:, None], half[:, 0] + half[:, 1], 0.0)
    half[flat, 2] = 0.0
    return middle, half


def _in_frustum(middle: Matrix, half: Matrix, camera: Camera) -> NDArray[np.bool_]:
    """False for boxes wholly beyond one of the five planes that matter."""
    slope_x, slope_y = camera.width_px / 2.0 / camera.focal_px, camera.height_px / 2.0 / camera.focal_px
    planes = np.array(
        [(1.0, 0.0, slope_x), (-1.0, 0.0, slope_x), (0.0, 1.0, slope_y), (0.0, -1.0, slope_y), (0.0, 0.0, 1.0)]
    )
    offset = np.array([0.0, 0.0, 0.0, 0.0, -NEAR_M])
    reach = np.abs(half @ planes.T).sum(axis=1)
    return np.asarray((middle @ planes.T + offset + reach > 0.0).all(axis=1))


def _grouped(rows: Rows, kind: NDArray[np.int64]) -> list[Batch]:
    ends = np.flatnonzero(np.diff(kind)) + 1
    starts = [0, *ends.tolist()] if len(rows) else []
    stops = [*ends.tolist(), len(rows)]
    return [_batch(rows[a:b], int(kind[a])) for a, b in zip(starts, stops, strict=False)]


def _batch(rows: Rows, kind: int) -> Batch:
    mesh, way = kind % (SHAPES * DETAILS), kind // (SHAPES * DETAILS)
    return Batch(mesh // DETAILS, mesh % DETAILS, way, rows)


def depth_from_window(window: NDArray[np.float32]) -> NDArray[np.float32]:
    """Metres along the optical axis from window depth 0..1; 0 where nothing was drawn."""
    metres = np.float32(NEAR_M * FAR_M) / (np.float32(FAR_M) - np.float32(FAR_M - NEAR_M) * window)
    return np.where(window > 1.0 - 1e-6, np.float32(0.0), metres)
