"""The cameras' drivers: who takes a picture at which tick, and the picture as a message."""

from dataclasses import dataclass
from math import cos, radians, sin

import cv2
import numpy as np

from sim.locomotion import Locomotion
from sim.physics import Physics
from sim.render import Camera, Picture, Renderer
from sim.render.picture import Content
from sim.rover import MAST_FORWARD_M, MAST_TOP_M
from sim.scene import Vec3
from wire import site as site_file
from wire.messages.driver import CameraFrame

JPEG_QUALITY = 85
MAST_WIDTH_PX, MAST_HEIGHT_PX, MAST_FOCAL_PX = 480, 360, 240.0
MAST_HZ = 2.0
DEPTH_RANGE_M = 10.0


@dataclass(frozen=True)
class _Slot:
    """One camera's place in time: a picture at every tick with tick % every == phase."""

    id: str
    fixed: site_file.Camera | None
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
        fixed = [(c.id, c, c.picture_hz) for c in site.camera if c.source == "mesh"]
        rows = fixed + [(robot, None, MAST_HZ) for robot in sorted(robots)]
        self._slots = []
        for index, (camera, pose, rate_hz) in enumerate(rows):
            every = max(1, round(1.0 / (rate_hz * site.clock.step_s)))
            self._slots.append(_Slot(camera, pose, every, (index * every // len(rows)) % every))
        self._seq = {slot.id: 0 for slot in self._slots}
        self._newest = {slot.id: _Shot() for slot in self._slots}

    def due(self, tick: int) -> bool:
        """Whether any camera takes a picture at this tick."""
        return any(tick % slot.every == slot.phase for slot in self._slots)

    def shoot(self, renderer: Renderer, tick: int, now_s: float) -> list[CameraFrame]:
        """The pictures due at this tick."""
        due = [slot for slot in self._slots if tick % slot.every == slot.phase]
        return [self._fixed(renderer, s.fixed, now_s) if s.fixed else self._mast(renderer, s.id, now_s) for s in due]

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
