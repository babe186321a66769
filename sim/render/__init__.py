"""Cameras of the simulated building."""

from sim.render.choose import make_renderer
from sim.render.picture import Camera, Picture, Renderer

__all__ = ["Camera", "Picture", "Renderer", "make_renderer"]
