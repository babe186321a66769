"""What a vision model is asked: the duties that there are, their texts and the schemas of their answers. Pure."""

import json
from dataclasses import dataclass
from functools import lru_cache
from math import degrees
from pathlib import Path
from string import ascii_uppercase
from typing import Any, Literal

from devices.vision.gridmask import Grid
from devices.vision.layout import known_types
from devices.vision.lens import Lens
from devices.vision.quoting import quoted

STATES = ("open", "closed", "on", "off", "dirty", "clean", "sliced", "whole")
LANDMARKS = ("landmark_front", "landmark_back", "landmark_left", "landmark_right")
ROLES = ("main", "target", *LANDMARKS, "obstacle")
PARTS = ("head", "body", "tail")
CUBE_COLOURS = ("red", "green", "blue", "yellow", "orange", "purple")
LETTER_CUBES = tuple(f"cube_{letter}" for letter in ascii_uppercase)
COLOUR_CUBES = tuple(f"cube_{colour}" for colour in CUBE_COLOURS)
WALKER, PLACE = "robot", "place"
CUBE_EDGE_M = 0.25
TASK_CHARACTERS = 300


@dataclass(frozen=True)
class Duty:
    """One kind of look."""

    name: Literal["room", "birds_eye"]
    names: tuple[str, ...]
    """What the model may call things."""
    fields: tuple[str, ...]
    """What it says of each beside its name and place."""
    most_objects: int
    most_of_one: int
    """More of one name in one picture are not believed."""
    edge_m: float | None = None
    """Edge of the cubes that it is about: no two of them are nearer than this."""

    @property
    def events(self) -> bool:
        return self.name == "room"


@lru_cache(maxsize=1)
def room_duty() -> Duty:
    """A fixed camera: everything that the catalogue knows."""
    return Duty("room", known_types(), ("state",), 40, 12)


BIRDS_EYE = Duty(
    "birds_eye", (*LETTER_CUBES, *COLOUR_CUBES, WALKER, PLACE), ("yaw_deg", "role", "part"), 24, 3, CUBE_EDGE_M
)
"""From a drone: lettered and coloured cubes, and a walking robot by its parts."""


@lru_cache(maxsize=4)
def system_text(duty: Duty) -> str:
    """The same to the byte in every question of a duty, so that servers keep what they made of it."""
    folder = Path(__file__).with_name("prompts")
    return f"{(folder / 'grid.md').read_text()}\n{(folder / f'{duty.name}.md').read_text()}"


def user_text(duty: Duty, grid: Grid, lens: Lens, task: str = "") -> str:
    """What differs from picture to picture, the most changeable last."""
    lines = [
        f"Names: {', '.join(duty.names)}",
        f"Picture: {grid.width_px} x {grid.height_px} pixels. Grid: cells of {grid.cell_px:g} pixels, "
        f"x from {-grid.half_width:.2f} to {grid.half_width:.2f}, y from {-grid.half_height:.2f} to {grid.half_height:.2f}.",
        f"Camera: {lens.position_enu_m[2]:.2f} m above the floor, tilted {degrees(lens.tilt_down_rad):.1f} degrees down, "
        f"focal length {lens.focal_px:.1f} pixels.",
        f"Answer: at most {duty.most_objects} objects.",
    ]
    if task:
        lines.append(f"Task of the robots, for the roles only: {quoted(task, TASK_CHARACTERS)}")
    return "\n".join(lines)


@lru_cache(maxsize=4)
def answer_schema(duty: Duty) -> str:
    """The JSON schema that the reply is held to, as text."""
    return json.dumps(_schema(duty), separators=(",", ":"))


def _schema(duty: Duty) -> dict[str, Any]:
    choices: dict[str, dict[str, Any]] = {
        "state": {"enum": [*STATES, None]},
        "yaw_deg": {"type": ["integer", "null"]},
        "role": {"enum": [*ROLES, None]},
        "part": {"enum": [*PARTS, None]},
    }
    item = {
        "name": {"enum": list(duty.names)},
        "x": {"type": "number"},
        "y": {"type": "number"},
        **{field: choices[field] for field in duty.fields},
    }
    lists = {"texts": _strings(8)} | ({"events": _strings(3)} if duty.events else {})
    properties = {"objects": {"type": "array", "maxItems": duty.most_objects, "items": _object(item)}, **lists}
    return _object(properties)


def _object(properties: dict[str, Any]) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _strings(most: int) -> dict[str, Any]:
    return {"type": "array", "maxItems": most, "items": {"type": "string", "maxLength": 160}}
