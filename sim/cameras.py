"""The cameras' drivers: who takes a picture at which tick, and the picture as a message."""

from dataclasses import dataclass, replace
from math import cos, pi, radians, sin

import cv2
import numpy as np

from sim.locomotion import Locomotion
from sim.physics import Physics
from sim.render import Camera, Picture, Renderer
from sim.render.picture import Content
from sim.rover import MAST_FORWARD_M, MAST_TOP_M
from sim.scene import Vec3
from wire import site as site_file
from wire.frames import body_to_enu, heading_to_yaw_rad, ned_to_enu
from wire.messages.driver import CameraFrame

JPEG_QUALITY = 85
MAST_WIDTH_PX, MAST_HEIGHT_PX, MAST_FOCAL_PX = 480, 360, 240.0
MAST_HZ = 2.0
DEPTH_RANGE_M = 10.0
GIMBAL_WIDTH_PX, GIMBAL_HEIGHT_PX, GIMBAL_FOCAL_PX = 480, 360, 240.0
GIMBAL_HZ = 2.0
GIMBAL_FLU_M: Vec3 = (0.13, 0.0, 0.045)
"""From the point between a drone's feet."""
GIMBALS = {"front": 0.25, "down": pi / 2.0}
"""A drone's cameras and how far they look down, in radians."""


@dataclass(frozen=True)
class _Slot:
    """One camera's place in time: a picture at every tick with tick % every == phase. What is not fixed is carried."""

    id: str
    fixed: site_file.Camera | None
    carrier: str
    tilt_down_rad: float
    every: int
    phase: int


@dataclass(frozen=True)
class _Shot:
    """A camera's newest picture as it goes over the wire, and what it was drawn from."""

    content: Content = None
    jpeg: bytes = b""
    depth_mm: bytes | None = None


class Cameras:
    """Pictures are spread evenly over the ticks, so that no tick has to draw them all.

    Where nothing in it changed, a camera's picture is its last one.
    """

    def __init__(self, site: site_file.Site, physics: Physics, robots: dict[str, Locomotion]) -> None:
        self._physics = physics
        self._robots = robots
        rows = [_Slot(c.id, c, "", 0.0, _every(site, c.picture_hz), 0) for c in site.camera if c.source == "mesh"]
        rows += [_Slot(robot, None, robot, 0.0, _every(site, MAST_HZ), 0) for robot in sorted(robots)]
        for drone in sorted(physics.drones):
            for name, tilt_rad in GIMBALS.items():
                rows.append(_Slot(f"{drone}-{name}", None, drone, tilt_rad, _every(site, GIMBAL_HZ), 0))
        self._slots = [replace(row, phase=(k * row.every // len(rows)) % row.every) for k, row in enumerate(rows)]
        self._seq = {slot.id: 0 for slot in self._slots}
        self._newest = {slot.id: _Shot() for slot in self._slots}

    def due(self, tick: int) -> bool:
        """Whether any camera takes a picture at this tick."""
        return any(tick % slot.every == slot.phase for slot in self._slots)

    def shoot(self, renderer: Renderer, tick: int, now_s: float) -> list[CameraFrame]:
        """The pictures due at this tick."""
        return [self._take(renderer, s, now_s) for s in self._slots if tick % s.every == s.phase]

    def _take(self, renderer: Renderer, slot: _Slot, now_s: float) -> CameraFrame:
        if slot.fixed is not None:
            return self._fixed(renderer, slot.fixed, now_s)
        if slot.carrier in self._robots:
            return self._mast(renderer, slot.id, now_s)
        return self._gimbal(renderer, slot, now_s)

    def _fixed(self, renderer: Renderer, row: site_file.Camera, now_s: float) -> CameraFrame:
        yaw_rad, tilt_rad = radians(row.yaw_deg), radians(row.tilt_down_deg)
        camera = Camera(row.position_enu_m, yaw_rad, tilt_rad, row.width_px, row.height_px, row.focal_px)
        return self._frame(row.id, camera, self._shot(row.id, camera, renderer), now_s, row.position_enu_m, yaw_rad)

    def _mast(self, renderer: Renderer, robot: str, now_s: float) -> CameraFrame:
        """Drawn from where the camera is, reported from where the robot's localisation believes it to be."""
        rover = self._physics.robots[robot]
        camera = Camera(
            rover.eye_m(),
            rover.motion().yaw_rad,
            rover.tilt_down_rad,
            MAST_WIDTH_PX,
            MAST_HEIGHT_PX,
            MAST_FOCAL_PX,
            carrier=robot,
        )
        x, y, yaw_rad = self._robots[robot].estimate()
        eye_m = (x + MAST_FORWARD_M * cos(yaw_rad), y + MAST_FORWARD_M * sin(yaw_rad), MAST_TOP_M)
        shot = self._shot(robot, camera, renderer, with_depth=True)
        return self._frame(robot, camera, shot, now_s, eye_m, yaw_rad)

    def _gimbal(self, renderer: Renderer, slot: _Slot, now_s: float) -> CameraFrame:
        """A drone's camera, kept level: drawn from where it is, reported from where the autopilot estimates it to be."""
        drone = self._physics.drones[slot.carrier]
        feet_m, yaw_rad = drone.true_pose()
        camera = Camera(
            body_to_enu(GIMBAL_FLU_M, feet_m, yaw_rad),
            yaw_rad,
            slot.tilt_down_rad,
            GIMBAL_WIDTH_PX,
            GIMBAL_HEIGHT_PX,
            GIMBAL_FOCAL_PX,
            carrier=slot.carrier,
        )
        told = drone.estimate
        told_yaw_rad = heading_to_yaw_rad(told.heading_rad)
        eye_m = body_to_enu(GIMBAL_FLU_M, ned_to_enu(told.position_ned_m), told_yaw_rad)
        return self._frame(slot.id, camera, self._shot(slot.id, camera, renderer), now_s, eye_m, told_yaw_rad)

    def _shot(self, id: str, camera: Camera, renderer: Renderer, with_depth: bool = False) -> _Shot:
        drawn = renderer.render_changed(camera, self._newest[id].content, with_depth)
        if drawn is not None:
            content, picture = drawn
            self._newest[id] = _Shot(content, _jpeg(picture), _depth_mm(picture))
        return self._newest[id]

    def _frame(
        self, id: str, camera: Camera, shot: _Shot, now_s: float, position_m: Vec3, yaw_rad: float
    ) -> CameraFrame:
        self._seq[id] += 1
        return CameraFrame(
            camera=id,
            seq=self._seq[id] - 1,
            stamp_s=now_s,
            width_px=camera.width_px,
            height_px=camera.height_px,
            focal_px=camera.focal_px,
            position_enu_m=position_m,
            yaw_rad=yaw_rad,
            tilt_down_rad=camera.tilt_down_rad,
            jpeg=shot.jpeg,
            depth_mm=shot.depth_mm,
        )


def _every(site: site_file.Site, rate_hz: float) -> int:
    """Ticks from one picture to the next."""
    return max(1, round(1.0 / (rate_hz * site.clock.step_s)))


def _jpeg(picture: Picture) -> bytes:
    ok, data = cv2.imencode(
        ".jpg", cv2.cvtColor(picture.rgb, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    )
    if not ok:
        raise RuntimeError("OpenCV could not encode a picture as JPEG: reinstall opencv-python-headless")
    return bytes(data)


def _depth_mm(picture: Picture) -> bytes | None:
    if picture.depth_m is None:
        return None
    near = np.where(picture.depth_m <= DEPTH_RANGE_M, picture.depth_m, np.float32(0.0))
    return np.rint(near * 1000.0).astype("<u2").tobytes()
