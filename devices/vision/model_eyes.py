"""A vision model as a detector: the question about a picture, and detections from the answer. Pure, but for `ModelDetector`.

The same detections as the embedded network's, so that all that follows (places, tracks, walls) is the same.
"""

from collections.abc import Callable, Sequence
from math import log

import numpy as np

from devices.vision.detector import Detection
from devices.vision.gridmask import Grid, draw, grid_for
from devices.vision.layout import ROBOT, known_types
from devices.vision.lens import Floats, Image, Lens
from devices.vision.look import Seen
from devices.vision.picture import encode_jpeg
from devices.vision.projection import locate
from devices.vision.prompt import Duty, answer_schema, room_duty, system_text, user_text
from devices.vision.reply import Entry, Report, read
from devices.vision.walls import before_walls
from wire.catalogue import ObjectType, type_row
from wire.messages.look import PICTURE_BYTES, LookReply, LookRequest
from wire.site import Door, Wall

CONFIDENCE = 0.6
"""Models do not say how sure they are; this is what a first look is worth."""
NAME_PROBABILITY = 0.75
STATE_PROBABILITY = 0.8
PLACE_SD_CELLS = 0.3
SUPPORT_M, SUPPORT_SD_M = 0.75, 0.3
"""Tops of tables, counters and shelves, on which things lie of which a model does not say on what."""
ON_WALL_M = 1.5
ROBOT_HEIGHT_M = 0.45
_SAYS = {
    "open": ("isOpen", True),
    "closed": ("isOpen", False),
    "on": ("isToggled", True),
    "off": ("isToggled", False),
    "dirty": ("isDirty", True),
    "clean": ("isDirty", False),
    "sliced": ("isSliced", True),
    "whole": ("isSliced", False),
}


def question(
    rgb: Image, lens: Lens, asker: str, duty: Duty | None = None, task: str = "", seed: int = 0
) -> LookRequest:
    """What to ask about a picture: with its grid drawn, as a JPEG that fits."""
    duty, grid = duty or room_duty(), grid_for(lens)
    return LookRequest(
        asker=asker,
        picture=_small_enough(draw(rgb, grid)),
        system=system_text(duty),
        user=user_text(duty, grid, lens, task),
        answer_schema=answer_schema(duty),
        max_tokens=1536,
        seed=seed,
    )


def _small_enough(rgb: Image) -> bytes:
    """Lines of one pixel need a high quality, which large noisy pictures have no room for."""
    for quality in (92, 80, 60, 40):
        jpeg = encode_jpeg(rgb, quality)
        if len(jpeg) <= PICTURE_BYTES:
            return jpeg
    raise ValueError(f"a picture of {rgb.shape[1]}x{rgb.shape[0]} does not fit into {PICTURE_BYTES} bytes")


def detections(report: Report, lens: Lens) -> list[Detection]:
    """A report on a room in the terms of detectors."""
    grid = grid_for(lens)
    return [_detection(entry, grid, lens) for entry in report.entries]


def seen_by_model(
    report: Report, lens: Lens, stamp_s: float, walls: Sequence[Wall] = (), doors: Sequence[Door] = ()
) -> Seen:
    """A report on a room, located; `stamp_s` is when the picture was taken."""
    sightings = before_walls(locate(detections(report, lens), lens), lens, walls, doors)
    return Seen(stamp_s, lens, None, tuple(sightings), "model")


def _detection(entry: Entry, grid: Grid, lens: Lens) -> Detection:
    row = type_row(entry.name)
    height_m, height_sd_m = _height(entry.name, row)
    u_px, v_px = grid.pixel(entry.x_cells, entry.y_cells)
    half_px = _half_px(u_px, v_px, height_m, row, lens)
    return Detection(
        type=entry.name,
        confidence=CONFIDENCE,
        u_px=u_px,
        v_px=v_px,
        box_px=(
            max(0.0, u_px - half_px),
            max(0.0, v_px - half_px),
            min(float(lens.width_px), u_px + half_px),
            min(float(lens.height_px), v_px + half_px),
        ),
        height_m=height_m,
        height_sd_m=height_sd_m,
        behind_m=min(row.size_m) / 2.0,
        props=_props(entry),
        log_probs=_log_probs(entry.name),
        pixel_sd_px=PLACE_SD_CELLS * grid.cell_px,
    )


def _height(name: str, row: ObjectType) -> tuple[float, float]:
    """Of a thing's centre above the floor, and how uncertain that is."""
    half_m = row.size_m[2] / 2.0
    if name == ROBOT:
        return ROBOT_HEIGHT_M, 0.1
    if "onWall" in row.placement:
        return ON_WALL_M, SUPPORT_SD_M
    if "onFloor" in row.placement or row.kind == "static":
        return half_m, 0.1
    return SUPPORT_M + half_m, SUPPORT_SD_M


def _half_px(u_px: float, v_px: float, height_m: float, row: ObjectType, lens: Lens) -> float:
    """Half the side of the square that a thing of this type fills at this place."""
    down = max(0.05, -float(lens.rays(u_px, v_px)[0, 2]))
    depth_m = min(12.0, max(0.3, (lens.position_enu_m[2] - height_m) / down))
    return max(2.0, lens.focal_px * max(row.size_m) / 2.0 / depth_m)


def _props(entry: Entry) -> dict[str, float]:
    if entry.state is None:
        return {}
    prop, value = _SAYS[entry.state]
    return {prop: STATE_PROBABILITY if value else 1.0 - STATE_PROBABILITY}


def _log_probs(name: str) -> Floats:
    types = known_types()
    log_probs = np.full(len(types), log((1.0 - NAME_PROBABILITY) / (len(types) - 1)))
    log_probs[types.index(name)] = log(NAME_PROBABILITY)
    return log_probs


class ModelDetector:
    """See devices.vision.detector.Detector: asks and waits, for tools that have time. Cameras use `glances`."""

    def __init__(self, ask: Callable[[LookRequest], LookReply], duty: Duty | None = None) -> None:
        self._ask, self._duty = ask, duty or room_duty()

    def look(self, rgb: Image, lens: Lens) -> list[Detection]:
        """Raises ReplyError when the answer is none; nothing is seen when there is no answer."""
        reply = self._ask(question(rgb, lens, "detector", self._duty))
        return detections(read(reply.text, self._duty, grid_for(lens)), lens) if reply.text else []
