"""The scene as rows of unit shapes: what every renderer draws, kept up to date body by body."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from sim.render.building import RoomFinder, building_rows
from sim.render.drone import drone_parts
from sim.render.meshes import SHADOW, SHAPE_CODE
from sim.render.picture import ROBOT_ID
from sim.render.robot import robot_parts
from sim.render.rows import ROW, Rows
from sim.scene import Body, Part, Scene, Vec3
from sim.textures import BOARD, WOOD

PartsOf = Callable[[Body], Sequence[Part]]

ON_FLOOR_M = 0.05
ROBOT_SIZE_M = (0.65, 0.35, 0.45)
ROBOT_REACH_M = 0.6
"""From a robot's middle to the farthest of what it carries."""


class Instances:
    """All rows of a scene. A changed body costs its own rows only, a moved one not even its looks."""

    def __init__(self, scene: Scene, parts_of: PartsOf) -> None:
        self.finder = RoomFinder(scene.rooms)
        self._parts_of = parts_of
        self._groups: dict[int | str, Rows] = {"building": building_rows(scene)}
        self._robots: dict[str, int] = {}
        self._poses: dict[str, tuple[Vec3, float, bool]] = {}
        self._models: dict[int, tuple[object, Rows]] = {}
        self._stack: Rows | None = None
        self.changed: set[int | str] = set()
        """Owners (body keys, robot names, `building`) changed since somebody emptied this set."""
        for body in scene.bodies.values():
            self.update(body)
        self.changed.add("building")

    def update(self, body: Body) -> None:
        """Replace the rows of one body by what it looks like now."""
        self._set(body.key, np.zeros(0, dtype=ROW) if body.gone else self._body_rows(body))

    def set_robot(self, name: str, position_m: Vec3, yaw_rad: float, holding: bool, flies: bool) -> None:
        pose = (position_m, yaw_rad, holding)
        if self._poses.get(name) == pose:
            return
        self._poses[name] = pose
        number = self._robots.setdefault(name, len(self._robots))
        rows = placed(robot_rows(number, holding, flies), position_m, yaw_rad)
        rows["id"] = ROBOT_ID + number
        rows["room"], _ = self.finder.place(position_m)
        rows["rooms"] = self.finder.around(position_m, ROBOT_REACH_M)
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
            # As plain bytes: NumPy joins structured rows field by field, a hundred times slower.
            self._stack = np.concatenate([rows.view(np.uint8) for rows in self._groups.values()]).view(ROW)
        return self._stack

    def _body_rows(self, body: Body) -> Rows:
        rows = placed(self._model(body), body.position_m, body.yaw_rad)
        if body.position_m[2] >= ON_FLOOR_M:
            rows = rows[:-1]
        rows["id"] = body.key
        rows["room"], rows["rooms"] = self.finder.place(body.position_m)
        return rows

    def _model(self, body: Body) -> Rows:
        """Its looks in its own frame, the shadow last; made again when more than its place has changed."""
        looks = (body.type, body.size_m, body.look, tuple(sorted(body.props.items())))
        known = self._models.get(body.key)
        if known is None or known[0] != looks:
            known = (looks, part_rows(self._parts_of(body), body.size_m))
            self._models[body.key] = known
        return known[1]

    def _set(self, owner: int | str, rows: Rows) -> None:
        self._groups[owner] = rows
        self._stack = None
        self.changed.add(owner)


@lru_cache(maxsize=32)
def robot_rows(number: int, holding: bool, flies: bool) -> Rows:
    if flies:
        return part_rows(drone_parts(number), ROBOT_SIZE_M)[:-1]  # its shadow would hang in the air
    return part_rows(robot_parts(number, holding), ROBOT_SIZE_M)


def part_rows(parts: Sequence[Part], size_m: Vec3) -> Rows:
    """Parts of something in its own frame, and last the shadow below its footprint."""
    rows = np.zeros(len(parts) + 1, dtype=ROW)
    for row, part in zip(rows, parts, strict=False):
        row["shape"] = SHAPE_CODE[part.shape]
        row["centre"] = part.centre_m
        row["axes"] = _axes(part.yaw_rad, part.pitch_rad) * np.array(part.size_m)[:, None]
        row["rgb"], row["emission"] = part.rgb, part.emission
        row["surface"] = BOARD if part.texture == WOOD else part.texture
    # Larger than the footprint by what is soft of it, and above the floor by less than anything's height.
    depth_m, width_m = (side_m * 1.12 + min(0.10, 0.25 * side_m) for side_m in size_m[:2])
    rows[-1]["axes"] = np.diag((depth_m, width_m, 0.008))
    rows[-1]["shape"] = SHADOW
    return rows


def placed(rows: Rows, position_m: Vec3, yaw_rad: float) -> Rows:
    """A copy of rows that stands at a position, turned by a yaw."""
    moved = rows.copy()
    turn = _axes(yaw_rad, 0.0)
    moved["axes"] = rows["axes"] @ turn
    moved["centre"] = rows["centre"] @ turn + np.array(position_m)
    return moved


def _axes(yaw_rad: float, pitch_rad: float) -> NDArray[np.float64]:
    """Unit x, y, z of a frame that is pitched about its own y, then turned about the vertical; as rows."""
    cy, sy, cp, sp = cos(yaw_rad), sin(yaw_rad), cos(pitch_rad), sin(pitch_rad)
    return np.array([(cy * cp, sy * cp, -sp), (-sy, cy, 0.0), (cy * sp, sy * sp, cp)])
