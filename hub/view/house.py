"""Draws what does not change: floors, walls, fixed cameras, and the shape of a robot."""

from math import hypot, radians

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
    place_lens(rec, camera.id, camera.width_px, camera.height_px, camera.focal_px, plane_m=0.6)


def place_lens(
    rec: rr.RecordingStream, camera: str, width_px: int, height_px: int, focal_px: float, plane_m: float
) -> None:
    """What the camera's pictures show of the world; they hang at `plane_m` in front of it."""
    rec.log(
        f"world/cameras/{camera}/picture",
        rr.Pinhole(
            resolution=[width_px, height_px],
            focal_length=focal_px,
            camera_xyz=rr.ViewCoordinates.RDF,
            image_plane_distance=plane_m,
        ),
        static=True,
    )


def draw_robot(rec: rr.RecordingStream, robot: str, rgb: tuple[int, int, int]) -> None:
    """A body, a mast and a nose about the origin of the robot's own frame."""
    path = f"world/robots/{robot}"
    rec.log(
        f"{path}/body",
        rr.Boxes3D(
            centers=[(0.0, 0.0, 0.28), (0.0, 0.0, 0.88)],
            half_sizes=[(0.32, 0.17, 0.16), (0.03, 0.03, 0.42)],
            colors=[rgb, (60, 60, 60)],
            labels=[robot, ""],
            fill_mode="solid",
        ),
        static=True,
    )
    nose = rr.Arrows3D(origins=[(0.0, 0.0, 0.45)], vectors=[(0.55, 0.0, 0.0)], colors=[rgb])
    rec.log(f"{path}/heading", nose, static=True)


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
