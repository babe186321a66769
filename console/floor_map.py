"""The floor plan as a picture: rooms, walls, camera cones, the robots' paths, the objects believed."""

from collections.abc import Sequence
from math import cos, degrees, inf, radians, sin
from pathlib import Path

import cv2
import numpy as np

from wire.messages.world import WorldState
from wire.model import Vec2, Vec3
from wire.site import Camera, Site, Wall

_PX_PER_M = 70
_MARGIN_M = 0.6
_ROOM_BGR = {
    "Kitchen": (214, 232, 240),
    "LivingRoom": (206, 222, 238),
    "Bedroom": (238, 228, 220),
    "Bathroom": (232, 238, 214),
}
_ROBOT_BGR = ((30, 130, 240), (220, 120, 30), (190, 60, 190), (90, 170, 40), (40, 200, 220), (70, 70, 220))
_VERIFIED_BGR, _BELIEVED_BGR, _CAMERA_BGR = (40, 140, 40), (150, 150, 60), (170, 90, 10)
_TITLE, _TITLE_PX = 0.6, 24
"""Size of the title's letters, and the height of one of its lines."""
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
        self._taken: list[tuple[int, int, int, int]] = []
        """Names that are written: left, top, right, bottom."""
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
        for turn_deg in np.linspace(-half, half, 61):
            angle = radians(camera.yaw_deg + float(turn_deg))
            free_m = self._free_m((x, y), (cos(angle), sin(angle)), reach_m)
            fan.append((x + free_m * cos(angle), y + free_m * sin(angle)))
        glass = self._image.copy()
        cv2.fillPoly(glass, [self._polygon(fan)], (240, 190, 90))
        cv2.addWeighted(glass, 0.35, self._image, 0.65, 0, self._image)

    def _free_m(self, start_m: Vec2, towards: Vec2, reach_m: float) -> float:
        """Metres that are seen from a point in a direction, at most to the first wall."""
        return min((reach_m, *(wall_m(start_m, towards, wall) for wall in self._site.wall)))

    def draw_cameras(self) -> None:
        """The cameras themselves, over walls and paths."""
        for camera in self._site.camera:
            x, y, _ = camera.position_enu_m
            cv2.circle(self._image, self._px((x, y)), 7, _CAMERA_BGR, -1, cv2.LINE_AA)
            self._label(camera.id, (x, y), 12, _CAMERA_BGR, 0.45)

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
            self._label(robot, trail[-1], 16, colour, 0.55)

    def _quadrotor(self, at_m: Vec2, colour: tuple[int, int, int]) -> None:
        """Two crossed arms with a rotor at each of their ends."""
        x, y = self._px(at_m)
        tips = [(x + i * 10, y + j * 10) for i, j in ((1, 1), (-1, -1), (1, -1), (-1, 1))]
        for a, b in (tips[:2], tips[2:]):
            cv2.line(self._image, a, b, colour, 3, cv2.LINE_AA)
        for tip in tips:
            cv2.circle(self._image, tip, 6, colour, 2, cv2.LINE_AA)

    def draw_objects(self, world: WorldState) -> None:
        """First all dots, then their names where there is room."""
        for obj in world.objects:
            colour = _VERIFIED_BGR if obj.verified else _BELIEVED_BGR
            cv2.circle(self._image, self._px(obj.position_enu_m), 4, colour, -1, cv2.LINE_AA)
        for obj in world.objects:
            self._label(obj.type, obj.position_enu_m, 7, (60, 60, 60), 0.34)

    def draw_title(self, text: str) -> None:
        """Above the floor plan, in as many lines as it takes; to be drawn last, for it moves the plan down."""
        lines, wide_px = [""], self._image.shape[1] - 16
        for word in text.split():
            longer = f"{lines[-1]} {word}".strip()
            if lines[-1] and cv2.getTextSize(longer, _FONT, _TITLE, 1)[0][0] > wide_px:
                lines.append(word)
            else:
                lines[-1] = longer
        room = np.full((_TITLE_PX * (len(lines) - 1), self._image.shape[1], 3), 255, np.uint8)
        self._image = np.vstack([room, self._image])
        for number, line in enumerate(lines):
            self._write(line, (8, 24 + number * _TITLE_PX), (40, 40, 40), _TITLE)

    def draw_legend(self) -> None:
        """What the marks mean, along the lower edge."""
        y, x = self._image.shape[0] - 12, 12
        for text, colour, filled in (
            ("seen by a robot from close by", _VERIFIED_BGR, True),
            ("believed, not looked at closely", _BELIEVED_BGR, True),
            ("camera, and what it watches", _CAMERA_BGR, True),
            ("where a robot began", (60, 60, 60), False),
            ("where it is", (60, 60, 60), True),
        ):
            cv2.circle(self._image, (x, y - 4), 5, colour, -1 if filled else 2, cv2.LINE_AA)
            self._write(text, (x + 10, y), (60, 60, 60), 0.38)
            x += 26 + cv2.getTextSize(text, _FONT, 0.38, 1)[0][0]

    def _label(self, text: str, at_m: Vec2 | Vec3, clear_px: int, colour: tuple[int, int, int], size: float) -> None:
        """A name beside a point: right, left, above or below of it, wherever it covers no other name."""
        (wide, high), _ = cv2.getTextSize(text, _FONT, size, 1)
        x, y = self._px(at_m)
        corners = (
            (x + clear_px, y + high // 2),
            (x - clear_px - wide, y + high // 2),
            (x - wide // 2, y - clear_px),
            (x - wide // 2, y + clear_px + high),
        )
        free = [(a, b) for a, b in corners if self._is_free(a, b, wide, high)]
        left, base = free[0] if free else corners[0]
        left = min(max(left, 2), self._image.shape[1] - wide - 2)
        self._taken.append((left, base - high, left + wide, base))
        self._write(text, (left, base), colour, size)

    def _is_free(self, left: int, base: int, wide: int, high: int) -> bool:
        """Whether a name there lies in the picture and on no other name."""
        right, top = left + wide, base - high
        inside = left >= 0 and top >= 0 and right <= self._image.shape[1] and base <= self._image.shape[0]
        return inside and all(right < a or left > c or base < b or top > d for a, b, c, d in self._taken)

    def _text(self, text: str, at_m: Vec2, colour: tuple[int, int, int], size: float) -> None:
        self._write(text, self._px(at_m), colour, size)

    def _write(self, text: str, at_px: tuple[int, int], colour: tuple[int, int, int], size: float) -> None:
        cv2.putText(self._image, text, at_px, _FONT, size, colour, 1, cv2.LINE_AA)

    def save(self, path: Path) -> None:
        cv2.imwrite(str(path), self._image)


def wall_m(start_m: Vec2, towards: Vec2, wall: Wall) -> float:
    """Metres from a point in a direction (a unit vector) to a wall; infinite where it is not met."""
    (x, y), (dx, dy) = start_m, towards
    (x1, y1), (x2, y2) = wall.start_m, wall.end_m
    wx, wy = x2 - x1, y2 - y1
    across = dx * wy - dy * wx
    if abs(across) < 1e-9:
        return inf
    along_m = ((x1 - x) * wy - (y1 - y) * wx) / across
    share = ((x1 - x) * dy - (y1 - y) * dx) / across
    return along_m if along_m > 0.0 and 0.0 <= share <= 1.0 else inf
