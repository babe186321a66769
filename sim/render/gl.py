"""OpenGL without a window: every shape of a scene in a handful of instanced draws, colour and owner in one pass."""

from typing import Any

import cv2
import moderngl
import numpy as np
from numpy.typing import NDArray

from sim import textures
from sim.render import shaders
from sim.render.instances import Instances, PartsOf
from sim.render.lamps import lamp_table
from sim.render.meshes import vertices
from sim.render.picture import NOTHING_ID, Camera, Content, Picture
from sim.render.portals import Portals
from sim.render.rows import ROW
from sim.render.view import SOFT_SHADOW, WAYS, Batch, depth_from_window, projection_matrix, view_matrix, visible_batches
from sim.scene import Body, Scene, Vec3

MESH_FORMAT = ("3f 3f 2f 3f 3f", "position", "normal", "uv", "along_u", "along_v")
ROW_NAMES = ("axis_x", "axis_y", "axis_z", "centre", "rgb", "surface", "emission", "room", "owner")
WITHOUT_DISPLAY: dict[str, Any] = {"backend": "egl"}
ROW_FORMAT = f"3f 3f 3f 3f 3f 1f 1f 1f 1i {ROW.itemsize - ROW.fields['shape'][1] if ROW.fields else 0}x/i"


def open_context() -> moderngl.Context:
    """A context without a display."""
    return moderngl.create_context(standalone=True, require=330, **WITHOUT_DISPLAY)


class GlRenderer:
    """Draws with whatever OpenGL 3.3 the machine has; a software one is enough."""

    name = "gl"

    def __init__(self, scene: Scene, parts_of: PartsOf) -> None:
        self._context = open_context()
        self._instances = Instances(scene, parts_of)
        self._portals = Portals(scene, self._instances.finder)
        self._surfaces = _upload_surfaces(self._context)
        lamps, extents, ceiling_m = lamp_table(scene)
        self._programs = {way: _program(self._context, way) for way in WAYS}
        for program in self._programs.values():
            _write(program, "lamps", lamps)
            _write(program, "extents", extents)
            _write(program, "repeat_m", np.array(textures.REPEAT_M))
            _write(program, "ceiling_m", np.array([ceiling_m]))
        self._meshes: dict[tuple[int, int, int], _Mesh] = {}
        self._targets: dict[tuple[int, int], _Target] = {}
        self._context.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._context.front_face = "cw"

    def update(self, body: Body) -> None:
        self._instances.update(body)

    def set_robot(
        self, name: str, position_m: Vec3, yaw_rad: float, holding: bool = False, flies: bool = False
    ) -> None:
        self._instances.set_robot(name, position_m, yaw_rad, holding, flies)

    def render(self, camera: Camera, with_ids: bool = False, with_depth: bool = False) -> Picture:
        return self._render(camera, visible_batches(self._instances, self._portals, camera), with_ids, with_depth)

    def render_changed(
        self, camera: Camera, before: Content, with_depth: bool = False
    ) -> tuple[Content, Picture] | None:
        batches = visible_batches(self._instances, self._portals, camera)
        content = (camera, with_depth, [(b.shape, b.detail, b.way, b.rows.tobytes()) for b in batches])
        return None if content == before else (content, self._render(camera, batches, False, with_depth))

    def _render(self, camera: Camera, batches: list[Batch], with_ids: bool, with_depth: bool) -> Picture:
        # Each renderer has a context of its own, and OpenGL talks to one of them at a time.
        with self._context:
            return self._draw_all(camera, batches, with_ids, with_depth)

    def _draw_all(self, camera: Camera, batches: list[Batch], with_ids: bool, with_depth: bool) -> Picture:
        size = (camera.width_px, camera.height_px)
        if size not in self._targets:
            self._targets[size] = _Target(self._context, size)
        target = self._targets[size]
        frame = target.with_ids if with_ids else target.plain
        frame.use()
        frame.clear()
        self._surfaces.use()
        clip_from_site = (projection_matrix(camera) @ view_matrix(camera)).T.astype(np.float32).tobytes()
        for program in self._programs.values():
            _uniform(program, "clip_from_site").write(clip_from_site)
        for batch in batches:
            if batch.way != SOFT_SHADOW:
                self._draw(batch)
        self._darken(frame, [batch for batch in batches if batch.way == SOFT_SHADOW])
        return target.read(frame, with_ids, with_depth)

    def close(self) -> None:
        self._context.release()

    def _darken(self, frame: moderngl.Framebuffer, shadows: list[Batch]) -> None:
        """Shadows change the colour of what is there, neither its depth nor whose pixel it is."""
        self._context.enable(moderngl.BLEND)
        masks = frame.color_mask, frame.depth_mask
        frame.color_mask, frame.depth_mask = _colour_only(len(frame.color_attachments)), False
        for batch in shadows:
            self._draw(batch)
        frame.color_mask, frame.depth_mask = masks
        self._context.disable(moderngl.BLEND)

    def _draw(self, batch: Batch) -> None:
        key = (batch.shape, batch.detail, batch.way)
        if key not in self._meshes:
            mesh = vertices(batch.shape, batch.detail)
            self._meshes[key] = _Mesh(self._context, self._programs[batch.way], mesh)
        self._meshes[key].draw(batch.rows)


class _Mesh:
    """One shape's triangles and room for the rows of the picture being drawn."""

    def __init__(self, context: moderngl.Context, program: moderngl.Program, mesh: NDArray[np.float32]) -> None:
        self._context, self._program = context, program
        # A vertex that several triangles share is lit once.
        corners, order = np.unique(mesh, axis=0, return_inverse=True)
        self._vertices = context.buffer(corners.tobytes())
        self._order = context.buffer(order.astype(np.int32).tobytes())
        self._reserve(64)

    def draw(self, rows: NDArray[Any]) -> None:
        if len(rows) > self._capacity:
            self._array.release()
            self._rows.release()
            self._reserve(2 * len(rows))
        self._rows.orphan()
        self._rows.write(rows.tobytes())
        self._array.render(instances=len(rows))

    def _reserve(self, capacity: int) -> None:
        self._capacity = capacity
        self._rows = self._context.buffer(reserve=capacity * ROW.itemsize, dynamic=True)
        content = [(self._vertices, *MESH_FORMAT), (self._rows, ROW_FORMAT, *ROW_NAMES)]
        self._array = self._context.vertex_array(self._program, content, self._order, skip_errors=True)


class _Target:
    """Where pictures of one size are drawn and read back."""

    def __init__(self, context: moderngl.Context, size: tuple[int, int]) -> None:
        self._size = size
        colour = context.texture(size, 4)
        owners = context.texture(size, 1, dtype="i4")
        depth = context.depth_texture(size)
        self.plain = context.framebuffer([colour], depth)
        self.with_ids = context.framebuffer([colour, owners], depth)

    def read(self, frame: moderngl.Framebuffer, with_ids: bool, with_depth: bool) -> Picture:
        width, height = self._size
        rgba = np.frombuffer(frame.read(components=4), np.uint8).reshape(height, width, 4)
        rgb = np.asarray(cv2.cvtColor(rgba, cv2.COLOR_RGBA2RGB), dtype=np.uint8)
        ids = depth_m = None
        if with_ids:
            raw_ids = np.frombuffer(frame.read(components=1, attachment=1, dtype="i4"), np.int32)
            ids = raw_ids.reshape(height, width) + np.int32(NOTHING_ID)
        if with_depth:
            window = np.frombuffer(frame.read(components=1, attachment=-1, dtype="f4"), np.float32)
            depth_m = depth_from_window(window.reshape(height, width))
        return Picture(rgb, ids, depth_m)


def _program(context: moderngl.Context, way: int) -> moderngl.Program:
    vertex, fragment = shaders.sources(way)
    return context.program(vertex_shader=vertex, fragment_shader=fragment)


def _colour_only(attachments: int) -> Any:
    mask = ((True,) * 4, (False,) * 4)
    return mask if attachments == 2 else mask[0]


def _upload_surfaces(context: moderngl.Context) -> moderngl.TextureArray:
    images = textures.layers()
    count, height, width, _ = images.shape
    surfaces = context.texture_array((width, height, count), 3, images.tobytes(), alignment=1)
    surfaces.build_mipmaps()
    surfaces.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return surfaces


def _write(program: moderngl.Program, name: str, values: NDArray[np.float64]) -> None:
    # A compiler leaves out what a shader does not use.
    if name in program:
        _uniform(program, name).write(values.astype(np.float32).tobytes())


def _uniform(program: moderngl.Program, name: str) -> moderngl.Uniform:
    member = program[name]
    assert isinstance(member, moderngl.Uniform)
    return member
