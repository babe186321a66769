"""Draws what the site file knows: floors, walls, doors, fixed cameras."""

from math import cos, hypot, radians, sin

import numpy as np
import rerun as rr

from wire.frames import camera_axes
from wire.site import Camera, Site

_FLOOR_RGB = {
    "Kitchen": (196, 188, 170),
    "LivingRoom": (176, 152, 122),
    "Bedroom": (150, 160, 178),
    "Bathroom": (160, 188, 190),
}
WALL_HEIGHT_M = 1.1
"""Walls are drawn low so that one sees into the rooms."""


def draw_house(rec: rr.RecordingStream, site: Site) -> None:
    rec.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    for room in site.room:
        ring = [(x, y, 0.0) for x, y in room.polygon_m]
        fan = [(0, k, k + 1) for k in range(1, len(ring) - 1)]  # generated rooms are convex
        rgb = _FLOOR_RGB.get(room.kind, (170, 170, 170))
        rec.log(
            f"world/house/floors/{room.id}",
            rr.Mesh3D(vertex_positions=ring, triangle_indices=fan, vertex_colors=[rgb] * len(ring)),
            static=True,
        )
    middles = [tuple(np.mean(room.polygon_m, axis=0)) for room in site.room]
    rec.log(
        "world/house/names",
        rr.Points3D([(x, y, 0.05) for x, y in middles], radii=0.02, labels=[r.name for r in site.room]),
        static=True,
    )
    _draw_walls(rec, site)
    for camera in site.camera:
        _draw_camera(rec, camera)


def _draw_walls(rec: rr.RecordingStream, site: Site) -> None:
    centres, halves, turns = [], [], []
    for wall in site.wall:
        (ax, ay), (bx, by) = wall.start_m, wall.end_m
        centres.append(((ax + bx) / 2, (ay + by) / 2, WALL_HEIGHT_M / 2))
        halves.append((hypot(bx - ax, by - ay) / 2, wall.thickness_m / 2, WALL_HEIGHT_M / 2))
        turns.append(rr.RotationAxisAngle(axis=[0, 0, 1], radians=float(np.arctan2(by - ay, bx - ax))))
    rec.log(
        "world/house/walls",
        rr.Boxes3D(
            centers=centres, half_sizes=halves, rotation_axis_angles=turns,
            colors=[(214, 212, 206)] * len(centres), fill_mode="solid",
        ),
        static=True,
    )  # fmt: skip


def _draw_camera(rec: rr.RecordingStream, camera: Camera) -> None:
    yaw, tilt = radians(camera.yaw_deg), radians(camera.tilt_down_deg)
    place_camera(rec, camera.id, camera.position_enu_m, yaw, tilt, static=True)
    rec.log(
        f"world/cameras/{camera.id}/picture",
        rr.Pinhole(
            resolution=[camera.width_px, camera.height_px],
            focal_length=camera.focal_px,
            camera_xyz=rr.ViewCoordinates.RDF,
            image_plane_distance=0.6,
        ),
        static=True,
    )


def place_camera(
    rec: rr.RecordingStream,
    camera: str,
    position_enu_m: tuple[float, float, float],
    yaw_rad: float,
    tilt_down_rad: float,
    *,
    static: bool = False,
) -> None:
    axes = np.array(camera_axes(yaw_rad, tilt_down_rad)).T
    rec.log(f"world/cameras/{camera}", rr.Transform3D(translation=position_enu_m, mat3x3=axes), static=static)


def heading_arrow(yaw_rad: float, length_m: float) -> tuple[float, float, float]:
    return (length_m * cos(yaw_rad), length_m * sin(yaw_rad), 0.0)
