"""PyBullet's own software renderer, for machines without OpenGL: the same shapes, flat colours, no lamps."""

from typing import Any

import numpy as np
import pybullet
from numpy.typing import NDArray

from sim import textures
from sim.render.instances import Instances, PartsOf
from sim.render.meshes import DETAILS, SHADOW, vertices
from sim.render.picture import NOTHING_ID, Camera, Content, Picture
from sim.render.rows import Rows
from sim.render.view import depth_from_window, projection_matrix, view_matrix
from sim.scene import Body, Scene, Vec3

FLIP = np.diag([1.0, -1.0, -1.0, 1.0])
"""Between RDF and OpenGL's own camera frame, which looks along -z with y up."""
UPRIGHT = np.diag([1.0, -1.0, 1.0, 1.0])
AWAY_M = (0.0, 0.0, -1000.0)


class BulletRenderer:
    """Draws in a PyBullet client of its own, so that physics is untouched."""

    name = "bullet"

    def __init__(self, scene: Scene, parts_of: PartsOf) -> None:
        self._client = pybullet.connect(pybullet.DIRECT)
        self._instances = Instances(scene, parts_of)
        self._bodies: dict[int | str, list[int]] = {}
        self._owners = np.full(1, NOTHING_ID, dtype=np.int32)
        self._tints = textures.layers().mean(axis=(1, 2)) / 255.0

    def update(self, body: Body) -> None:
        self._instances.update(body)

    def set_robot(
        self, name: str, position_m: Vec3, yaw_rad: float, holding: bool = False, flies: bool = False
    ) -> None:
        self._instances.set_robot(name, position_m, yaw_rad, holding, flies)

    def render(self, camera: Camera, with_ids: bool = False, with_depth: bool = False) -> Picture:
        self._refresh()
        self._shift(camera.carrier, AWAY_M)
        shape = (camera.height_px, camera.width_px)
        _, _, rgba, window, mask = pybullet.getCameraImage(
            camera.width_px,
            camera.height_px,
            _columns(FLIP @ view_matrix(camera)),
            _columns(_projection(camera)),
            lightDirection=(2.0, -3.0, 8.0),
            lightAmbientCoeff=0.68,
            lightDiffuseCoeff=0.38,
            lightSpecularCoeff=0.0,
            shadow=0,
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=self._client,
        )
        self._shift(camera.carrier, (0.0, 0.0, 0.0))
        # Depending on how PyBullet was built these are arrays or plain tuples.
        rgb = np.ascontiguousarray(np.asarray(rgba, dtype=np.uint8).reshape(*shape, 4)[..., :3])
        ids = self._owners[np.asarray(mask, dtype=np.int32).reshape(shape)] if with_ids else None
        depth_m = depth_from_window(np.asarray(window, dtype=np.float32).reshape(shape)) if with_depth else None
        return Picture(rgb, ids, depth_m)

    def render_changed(self, camera: Camera, before: Content, with_depth: bool = False) -> tuple[Content, Picture]:
        # The engine does not say what a picture is drawn from: every one is drawn.
        return None, self.render(camera, with_depth=with_depth)

    def close(self) -> None:
        pybullet.disconnect(self._client)

    def _refresh(self) -> None:
        """Make again what has changed since the last picture."""
        for owner in sorted(self._instances.changed, key=str):
            for number in self._bodies.get(owner, []):
                pybullet.removeBody(number, physicsClientId=self._client)
            rows = self._solid(owner)
            self._bodies[owner] = [self._create(row) for row in rows]
            self._own(self._bodies[owner], rows)
        self._instances.changed.clear()

    def _solid(self, owner: int | str) -> Rows:
        """All but the soft shadows, which this renderer cannot draw."""
        rows = self._instances.group(owner)
        solid: Rows = rows[rows["shape"] != SHADOW]
        return solid

    def _own(self, numbers: list[int], rows: Rows) -> None:
        """Remember whose pixels PyBullet's numbers are; its -1, nothing, finds the last entry."""
        size = max([len(self._owners) - 2, *numbers]) + 2
        owners = np.full(size, NOTHING_ID, dtype=np.int32)
        owners[: len(self._owners)] = self._owners
        owners[numbers] = rows["id"]
        self._owners = owners

    def _create(self, row: Any) -> int:
        mesh = vertices(int(row["shape"]), DETAILS - 1)
        tint = self._tints[int(row["surface"])] * row["rgb"]
        colour = tint + (1.0 - tint) * 0.5 * row["emission"]
        looks = pybullet.createVisualShape(
            pybullet.GEOM_MESH,
            vertices=(mesh[:, :3] @ row["axes"]).tolist(),
            normals=_normals(mesh, row["axes"]).tolist(),
            indices=list(range(len(mesh))),
            rgbaColor=[*colour.tolist(), 1.0],
            physicsClientId=self._client,
        )
        return int(
            pybullet.createMultiBody(
                baseVisualShapeIndex=looks, basePosition=row["centre"].tolist(), physicsClientId=self._client
            )
        )

    def _shift(self, robot: str | None, by_m: Vec3) -> None:
        """Put a robot's shapes aside, or back in their place with no shift."""
        if robot is None or robot not in self._bodies:
            return
        for number, row in zip(self._bodies[robot], self._solid(robot), strict=True):
            position = (row["centre"] + np.array(by_m)).tolist()
            pybullet.resetBasePositionAndOrientation(number, position, (0, 0, 0, 1), physicsClientId=self._client)


def _projection(camera: Camera) -> NDArray[np.float64]:
    """For OpenGL's camera frame, moved by half a pixel because TinyRenderer samples a pixel at its corner."""
    shift = np.eye(4)
    shift[0, 3], shift[1, 3] = -1.0 / camera.width_px, -1.0 / camera.height_px
    return np.asarray(shift @ UPRIGHT @ projection_matrix(camera) @ FLIP)


def _columns(matrix: NDArray[np.float64]) -> list[float]:
    """A matrix as PyBullet wants it."""
    return [float(value) for value in matrix.T.ravel()]


def _normals(mesh: NDArray[np.float32], axes: NDArray[np.float32]) -> NDArray[np.float32]:
    scaled = mesh[:, 3:6] @ (axes / (axes**2).sum(axis=1, keepdims=True))
    return np.asarray(scaled / np.linalg.norm(scaled, axis=1, keepdims=True))
