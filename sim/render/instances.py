"""The scene as rows of unit shapes: what every renderer draws, kept up to date body by body."""

from collections.abc import Callable, Sequence
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from sim.render.building import RoomFinder, building_rows
from sim.render.meshes import SHADOW, SHAPE_CODE
from sim.render.picture import ROBOT_ID
from sim.render.robot import robot_parts
from sim.render.rows import ROW, Rows
from sim.scene import Body, Part, Scene, Vec3

PartsOf = Callable[[Body], Sequence[Part]]

ON_FLOOR_M = 0.05
ROBOT_SIZE_M = (0.65, 0.35, 0.45)


class Instances:
    """All rows of a scene. A changed body costs its own rows only."""

    def __init__(self, scene: Scene, parts_of: PartsOf) -> None:
        self.finder = RoomFinder(scene.rooms)
        self._parts_of = parts_of
        self._groups: dict[int | str, Rows] = {"building": building_rows(scene)}
        self._robots: dict[str, int] = {}
        self._stack: Rows | None = None
        self.changed: set[int | str] = set()
        """Owners (body keys, robot names, `building`) changed since somebody emptied this set."""
        for body in scene.bodies.values():
            self.update(body)
        self.changed.add("building")

    def update(self, body: Body) -> None:
        """Replace the rows of one body by what it looks like now."""
        self._set(body.key, _empty() if body.gone else self._body_rows(body))

    def set_robot(self, name: str, position_m: Vec3, yaw_rad: float, holding: bool) -> None:
        number = self._robots.setdefault(name, len(self._robots))
        rows = part_rows(robot_parts(number, holding), position_m, yaw_rad)
        rows = np.concatenate([rows, _shadow(ROBOT_SIZE_M, position_m, yaw_rad)])
        rows["id"] = ROBOT_ID + number
        rows["room"], _ = self.finder.place(position_m)
        rows["rooms"] = self.finder.everywhere
        self._set(name, rows)

    def group(self, owner: int | str) -> Rows:
        return self._groups[owner]

    def robot_id(self, name: str | None) -> int | None:
        """The id in the pictures of a robot that has been placed."""
        number = self._robots.get(name) if name is not None else None
        return None if number is None else ROBOT_ID + number

    def rows(self) -> Rows:
        """Everything, in one array."""
        if self._stack is None:
            self._stack = np.concatenate(list(self._groups.values()))
        return self._stack

    def _body_rows(self, body: Body) -> Rows:
        rows = part_rows(self._parts_of(body), body.position_m, body.yaw_rad)
        if body.position_m[2] < ON_FLOOR_M:
            rows = np.concatenate([rows, _shadow(body.size_m, body.position_m, body.yaw_rad)])
        rows["id"] = body.key
        rows["room"], rows["rooms"] = self.finder.place(body.position_m)
        return rows

    def _set(self, owner: int | str, rows: Rows) -> None:
        self._groups[owner] = rows
        self._stack = None
        self.changed.add(owner)


def part_rows(parts: Sequence[Part], position_m: Vec3, yaw_rad: float) -> Rows:
    """Parts of something that stands at a position, turned by a yaw."""
    rows = np.zeros(len(parts), dtype=ROW)
    c, s = cos(yaw_rad), sin(yaw_rad)
    for row, part in zip(rows, parts, strict=True):
        x, y, z = part.centre_m
        row["shape"] = SHAPE_CODE[part.shape]
        row["centre"] = (position_m[0] + c * x - s * y, position_m[1] + s * x + c * y, position_m[2] + z)
        row["axes"] = _axes(yaw_rad + part.yaw_rad, part.pitch_rad) * np.array(part.size_m)[:, None]
        row["rgb"], row["surface"], row["emission"] = part.rgb, part.texture, part.emission
    return rows


def _shadow(size_m: Vec3, position_m: Vec3, yaw_rad: float) -> Rows:
    """Under a thing, larger than its footprint by what is soft of it."""
    footprint = (size_m[0] * 1.15 + 0.10, size_m[1] * 1.15 + 0.10, 0.008)
    rows = part_rows([Part("box", (0.0, 0.0, 0.0), footprint, (0.0, 0.0, 0.0))], position_m, yaw_rad)
    rows["shape"] = SHADOW
    return rows


def _axes(yaw_rad: float, pitch_rad: float) -> NDArray[np.float64]:
    """Unit x, y, z of a frame that is pitched about its own y, then turned about the vertical; as rows."""
    cy, sy, cp, sp = cos(yaw_rad), sin(yaw_rad), cos(pitch_rad), sin(pitch_rad)
    return np.array([(cy * cp, sy * cp, -sp), (-sy, cy, 0.0), (cy * sp, sy * sp, cp)])


def _empty() -> Rows:
    return np.zeros(0, dtype=ROW)
