"""The one way from a frame to located things, shared by every device with a camera.

    detector = EmbeddedDetector()
    tracker = Tracker()
    seen = look_at_frame(frame, detector)              # decodes, detects, projects
    result = tracker.update(seen)                      # -> result.objects, result.gone, result.changes
    view = floor_view(seen.lens, walls, doors)         # -> wire View
    batch = ObservationBatch(..., objects=result.objects, gone=result.gone, view=view)

`seen.sightings` are the raw detections of this one picture with their places, for those who need no tracks (is the
mug that I am to pick up in front of me?). Depth is used when the frame has it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from devices.vision.detector import Detector
from devices.vision.lens import Depth, Lens
from devices.vision.picture import decode_frame
from devices.vision.projection import Sighting, locate
from devices.vision.track import Eye
from devices.vision.walls import before_walls
from wire.messages.driver import CameraFrame
from wire.site import Door, Wall


@dataclass(frozen=True)
class Seen:
    """What one picture shows."""

    stamp_s: float
    lens: Lens
    depth_m: Depth | None
    sightings: tuple[Sighting, ...]
    eye: Eye = "embedded"


def look_at_frame(
    frame: CameraFrame, detector: Detector, walls: Sequence[Wall] = (), doors: Sequence[Door] = ()
) -> Seen:
    """Detect and locate; a camera without depth does better when it is told of the walls.

    Raises PictureError when the frame's bytes are not what it says.
    """
    picture = decode_frame(frame)
    detections = detector.look(picture.rgb, picture.lens)
    sightings = locate(detections, picture.lens, picture.depth_m)
    if picture.depth_m is None:
        sightings = before_walls(sightings, picture.lens, walls, doors)
    return Seen(picture.stamp_s, picture.lens, picture.depth_m, tuple(sightings))
