"""Which renderer draws the building: OpenGL where it starts, PyBullet's own otherwise."""

import logging
import subprocess
import sys
from functools import lru_cache
from typing import Literal

from sim.models import parts
from sim.render.instances import PartsOf
from sim.render.picture import Renderer, RenderError
from sim.scene import Scene

Choice = Literal["auto", "gl", "bullet"]

TRIAL = "import moderngl; moderngl.create_context(standalone=True, require=330, backend='egl')"
REMEDY = "install the `sim` extra, libegl1 and libgl1-mesa-dri"

_log = logging.getLogger(__name__)


def make_renderer(scene: Scene, choice: Choice = "auto", parts_of: PartsOf = parts) -> Renderer:
    """The renderer asked for; `auto` falls back to PyBullet when OpenGL does not start."""
    if choice == "bullet":
        return _bullet(scene, parts_of)
    fault = gl_fault()
    if fault is None:
        from sim.render.gl import GlRenderer

        return GlRenderer(scene, parts_of)
    if choice == "gl":
        raise RenderError(f"OpenGL 3.3 does not start: {fault}; {REMEDY}")
    _log.warning("Cameras are drawn by PyBullet, slowly, as OpenGL 3.3 does not start: %s; %s", fault, REMEDY)
    return _bullet(scene, parts_of)


@lru_cache(maxsize=1)
def gl_fault() -> str | None:
    """Why OpenGL does not start here, or None. Tried in a process of its own, for a driver may crash."""
    done = subprocess.run([sys.executable, "-c", TRIAL], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return None
    return (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]


def _bullet(scene: Scene, parts_of: PartsOf) -> Renderer:
    from sim.render.bullet import BulletRenderer

    return BulletRenderer(scene, parts_of)
