"""What every object looks like, by type, size, look and state; and how much room it takes."""

from sim.boxes import Box, body_box
from sim.models.form import Form
from sim.models.registry import MODELS
from sim.models.surfaces import Surface, surfaces
from sim.scene import Body, Part

__all__ = ["MODELS", "Surface", "collision_boxes", "parts", "surfaces"]


def parts(body: Body) -> tuple[Part, ...]:
    """The primitives of a body in its own frame. The same body always looks the same."""
    return tuple(MODELS[body.type](Form(body)))


def collision_boxes(body: Body) -> tuple[Box, ...]:
    """What robots bump into: the whole bounding box, open doors left out."""
    return (body_box(body),)
