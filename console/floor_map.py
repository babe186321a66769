"""The floor plan as a picture: rooms, walls, camera cones, the robots' paths, the objects believed."""

from collections.abc import Sequence
from math import cos, degrees, radians, sin
from pathlib import Path

import cv2
import numpy as np

from wire.messages.world import WorldState
from wire.model import Vec2, Vec3
from wire.site import Camera, Site

_PX_PER_M = 70
_MARGIN_M = 0.6
_ROOM_BGR = {
    "Kitchen": (214, 232, 240),
    "LivingRoom": (206, 222, 238),
    "Bedroom": (238, 228, 220),
    "Bathroom": (232, 238, 214),
}
_ROBOT_BGR = ((30, 130, 240), (220, 120, 30), (190, 60, 190), (90, 170, 40), (40, 200, 220), (70, 70, 220))
_FONT = cv2.FONT_HERSHEY_SIMPLEX


class FloorMap:
    """A canvas in site coordinates: x to the right, y up."""

    def __init__(self, site: Site) -> None:
        xs = [x for room in site.room for x, _ in room.polygon_m]
        ys = [y for room in site.room for _, y in room.polygon_m]
        self._west_m, self._north_m = min(xs) - _MARGIN_M, max(ys) + _MARGIN_M
        width = int((max(xs) - min(xs) + 2 * _MARGIN_M) * _PX_PER_M)
        height = int((max(ys) - min(ys) + 2 * _MARGIN_M) * _PX_PER_M)
        self._image = np.full((height, width, 3), 255, np.uint8)
        self._site = site
        self._flyers = {robot.id for robot in site.robot if robot.kind == "drone"}

    def _px(self, point_m: Vec2 | Vec3) -> tuple[int, int]:
        return (int((point_m[0] - self._west_m) * _PX_PER_M), int((self._north_m - point_m[1]) * _PX_PER_M))

    def _polygon(self, points_m: Sequence[Vec2]) -> np.ndarray:
        return np.array([self._px(p) for p in points_m], np.int32)

    def draw_house(self) -> None:
        for room in self._site.room:
            cv2.fillPoly(self._image, [self._polygon(room.polygon_m)], _ROOM_BGR.get(room.kind, (235, 235, 235)))
        for camera in self._site.camera:
            self._cone(camera)
        for wall in self._site.wall:
            thickness = max(3, int(wall.thickness_m * _PX_PER_M))
            cv2.line(self._image, self._px(wall.start_m), self._px(wall.end_m), (90, 90, 90), thickness)
        for room in self._site.room:
            middle = np.mean(room.polygon_m, axis=0)
            self._text(room.name, (float(middle[0]) - 0.5, float(middle[1])), (120, 110, 100), 0.55)

    def _cone(self, camera: Camera, reach_m: float = 3.0) -> None:
        half = degrees(np.arctan2(camera.width_px / 2, camera.focal_px))
        x, y, _ = camera.position_enu_m
        fan = [(x, y)]
        for turn_deg in np.linspace(-half, half, 13):
            angle = radians(camera.yaw_deg + float(turn_deg))
            fan.append((x + reach_m * cos(angle), y + reach_m * sin(angle)))
        glass = self._image.copy()
        cv2.fillPoly(glass, [self._polygon(fan)], (240, 190, 90))
        cv2.addWeighted(glass, 0.35, self._image, 0.65, 0, self._image)
        cv2.circle(self._image, self._px((x, y)), 7, (170, 90, 10), -1, cv2.LINE_AA)
        self._text(camera.id, (x + 0.12, y + 0.12), (170, 90, 10), 0.45)

    def draw_paths(self, trails: dict[str, list[Vec2]]) -> None:
        for index, (robot, trail) in enumerate(sorted(trails.items())):
            if not trail:
                continue
            colour = _ROBOT_BGR[index % len(_ROBOT_BGR)]
            cv2.polylines(self._image, [self._polygon(trail)], False, colour, 3, cv2.LINE_AA)
            cv2.circle(self._image, self._px(trail[0]), 6, colour, 2, cv2.LINE_AA)
            if robot in self._flyers:
                self._quadrotor(trail[-1], colour)
            else:
                cv2.circle(self._image, self._px(trail[-1]), 11, colour, -1, cv2.LINE_AA)
            self._text(robot, (trail[-1][0] + 0.2, trail[-1][1] + 0.2), colour, 0.55)

    def _quadrotor(self, at_m: Vec2, colour: tuple[int, int, int]) -> None:
        """Two crossed arms with a rotor at each of their ends."""
        x, y = self._px(at_m)
        tips = [(x + i * 10, y + j * 10) for i, j in ((1, 1), (-1, -1), (1, -1), (-1, 1))]
        for a, b in (tips[:2], tips[2:]):
            cv2.line(self._image, a, b, colour, 3, cv2.LINE_AA)
        for tip in tips:
            cv2.circle(self._image, tip, 6, colour, 2, cv2.LINE_AA)

    def draw_objects(self, world: WorldState) -> None:
        for obj in world.objects:
            colour = (40, 140, 40) if obj.verified else (150, 150, 60)
            cv2.circle(self._image, self._px(obj.position_enu_m), 4, colour, -1, cv2.LINE_AA)
            self._text(obj.type, (obj.position_enu_m[0] + 0.07, obj.position_enu_m[1] - 0.04), (60, 60, 60), 0.34)

    def draw_title(self, text: str) -> None:
        self._text(text, (self._west_m + 0.1, self._north_m - 0.32), (40, 40, 40), 0.6)

    def _text(self, text: str, at_m: Vec2, colour: tuple[int, int, int], size: float) -> None:
        cv2.putText(self._image, text, self._px(at_m), _FONT, size, colour, 1, cv2.LINE_AA)

    def save(self, path: Path) -> None:
        cv2.imwrite(str(path), self._image)
