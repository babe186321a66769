"""Which renderer draws the building: OpenGL where it starts, PyBullet's own otherwise."""

import logging
from typing import Literal

from sim.render.instances import PartsOf
from sim.render.picture import Renderer, RenderError
from sim.scene import Scene

Choice = Literal["auto", "gl", "bullet"]

_log = logging.getLogger(__name__)


def make_renderer(scene: Scene, choice: Choice, parts_of: PartsOf) -> Renderer:
    """The renderer asked for; `auto` falls back to PyBullet when OpenGL does not start."""
    if choice == "bullet":
        return _bullet(scene, parts_of)
    try:
        return _gl(scene, parts_of)
    except RenderError as error:
        if choice == "gl":
            raise
        _log.warning("Cameras are drawn by PyBullet, which is slower: %s", error)
        return _bullet(scene, parts_of)


def _gl(scene: Scene, parts_of: PartsOf) -> Renderer:
    try:
        from sim.render.gl import GlRenderer, open_context
    except ImportError as error:
        raise RenderError(f"OpenGL cannot be used: {error}; install the `sim` extra") from error
    return GlRenderer(open_context(), scene, parts_of)


def _bullet(scene: Scene, parts_of: PartsOf) -> Renderer:
    from sim.render.bullet import BulletRenderer

    return BulletRenderer(scene, parts_of)
