"""Stands for a vision model: it looks at the pixels that it is sent, and reads the grid's geometry off the prompt.

No ground truth reaches it. In a room it sees what the embedded detector sees in the gridded picture, from above what the
detector of cubes sees; so its answers say something of the pipeline and nothing of any vision model.
"""

import json
import re
from functools import lru_cache
from math import degrees, radians
from typing import Any

import cv2
import numpy as np

from devices.vision.cube_detector import CubeDetector
from devices.vision.detector import Detection, EmbeddedDetector
from devices.vision.gridmask import Grid
from devices.vision.lens import Image, Lens
from devices.vision.picture import decode_jpeg
from tests.ollama_double.brain import ChatRequest
from tests.ollama_double.dials import Dials

MARK = "A coordinate grid is drawn over the picture."
ROOM = "from a fixed camera high in a room"
_PICTURE = re.compile(r"Picture: (\d+) x (\d+) pixels\. Grid: cells of ([\d.]+) pixels")
_CAMERA = re.compile(r"Camera: ([\d.]+) m above the floor, tilted ([\d.]+) degrees down, focal length ([\d.]+) pixels")
_NAMES = re.compile(r"^Names: (.+)$", re.MULTILINE)
_STATES = {
    "isOpen": ("open", "closed"),
    "isToggled": ("on", "off"),
    "isDirty": ("dirty", "clean"),
    "isSliced": ("sliced", "whole"),
}
SURE = 0.75


def knows(request: ChatRequest) -> bool:
    return bool(request.pictures) and MARK in request.system


def make(dials: Dials) -> "LookBrain":
    return LookBrain(dials)


class LookBrain:
    """See tests.ollama_double.brain.Brain."""

    def __init__(self, dials: Dials) -> None:
        self._dials = dials

    def reply(self, request: ChatRequest) -> str:
        picture, camera, names = (found.search(request.user) for found in (_PICTURE, _CAMERA, _NAMES))
        if picture is None or camera is None or names is None:
            return "I was told neither the grid nor what things are called."
        width, height, cell = int(picture[1]), int(picture[2]), float(picture[3])
        rgb = decode_jpeg(request.pictures[0])
        if rgb.shape[:2] != (height, width):
            return f"I was told of a picture of {width} x {height}, but see one of {rgb.shape[1]} x {rgb.shape[0]}."
        grid = Grid(width, height, cell)
        lens = Lens(width, height, float(camera[3]), (0.0, 0.0, float(camera[1])), 0.0, radians(float(camera[2])))
        report = _room(rgb, grid, lens) if ROOM in request.system else _above(rgb, grid, lens)
        offered = set(names[1].split(", "))
        report["objects"] = [o for o in report["objects"] if o["name"] in offered]
        if report["objects"] and self._dials.slips("invented_id", request.prompt, request.seed):
            report["objects"][0]["name"] = "Dragon"
        return json.dumps(report)


def _room(rgb: Image, grid: Grid, lens: Lens) -> dict[str, Any]:
    """What is in a room, as its prompt asks for it."""
    found = _detector().look(without_lines(rgb, grid), lens)
    objects = [
        _object(d, grid)
        for d in found
        if abs(2.0 * d.u_px / grid.width_px - 1.0) < 1.0 and 0.0 < d.v_px < grid.height_px
    ]
    open_ones = [o["name"] for o in objects if o["state"] in ("open", "on")]
    events = [
        f"The {name} is {state}."
        for name, state in {o["name"]: o["state"] for o in objects if o["name"] in open_ones}.items()
    ]
    return {"objects": objects[:40], "events": events[:3], "texts": []}


def _above(rgb: Image, grid: Grid, lens: Lens) -> dict[str, Any]:
    """What stands on a floor, as a drone's prompt asks for it."""
    found = _cubes().report(without_lines(rgb, grid), lens).entries
    objects = [
        {
            "name": e.name,
            "x": round(e.x_cells, 2),
            "y": round(e.y_cells, 2),
            "yaw_deg": None if e.yaw_rad is None else round(degrees(e.yaw_rad)),
            "role": None,
            "part": e.part,
        }
        for e in found
    ]
    return {"objects": objects[:24], "texts": []}


def _object(detection: Detection, grid: Grid) -> dict[str, Any]:
    x, y = grid.cells(detection.u_px, detection.v_px)
    state = None
    for prop, probability in detection.props.items():
        if probability > SURE or probability < 1.0 - SURE:
            state = _STATES[prop][0 if probability > SURE else 1]
            break
    return {"name": detection.type, "x": round(x, 2), "y": round(y, 2), "state": state}


def without_lines(rgb: Image, grid: Grid) -> Image:
    """The picture with its lines and numbers painted over from their sides: where they are follows from the prompt."""
    mask = np.zeros(rgb.shape[:2], np.uint8)
    for i in grid.columns():
        u = round(grid.pixel(i, 0.0)[0])
        mask[:, max(0, u - 1) : u + 2] = 255
    for j in grid.rows():
        v = round(grid.pixel(0.0, j)[1])
        mask[max(0, v - 1) : v + 2, :] = 255
    for i, j in grid.labelled():
        u, v = (round(p) for p in grid.pixel(i, j))
        mask[max(0, v - 14) : max(0, v), max(0, u) : u + 40] = 255
    return np.asarray(cv2.inpaint(rgb, mask, 2, cv2.INPAINT_TELEA), dtype=np.uint8)


@lru_cache(maxsize=1)
def _cubes() -> CubeDetector:
    return CubeDetector()


@lru_cache(maxsize=1)
def _detector() -> EmbeddedDetector:
    return EmbeddedDetector()
