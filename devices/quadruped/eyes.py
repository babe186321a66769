"""The robot's own perception: the mast camera's pictures become looks for its skills and observations for the mesh."""

import logging
from dataclasses import replace
from math import cos, dist, sin

import numpy as np

from devices.quadruped.look import Look, Points, Thing
from devices.vision.detector import Detection, Detector
from devices.vision.layout import ROBOT, known_types
from devices.vision.lens import Depth, Lens
from devices.vision.look import Seen, look_at_frame
from devices.vision.picture import PictureError
from devices.vision.projection import Sighting
from devices.vision.steady import SteadyDetector
from devices.vision.tracking import Tracker
from devices.vision.view import floor_view
from wire.messages.driver import CameraFrame
from wire.messages.observation import ObservationBatch
from wire.site import Site

log = logging.getLogger("eyes")

HAND_FROM_CAMERA_M, HAND_BELOW_CAMERA_M = 0.32, 0.56
"""Where the robot carries things: ahead of the camera and below it."""
LOAD_M, TOO_NEAR_M = 0.4, 0.5
"""While something is carried, what is this near to the hand or to the camera is the load."""
EVERY_PX = 8
FARTHEST_M = 3.2
SUSPICION = 0.12
"""What is less likely than this is not worth a second look."""


class PictureEyes:
    """Own perception of one robot."""

    def __init__(self, site: Site, robot: str, detector: Detector) -> None:
        self._site, self._robot, self._detector = site, robot, SteadyDetector(detector)
        self._tracker = Tracker()
        self._seq = 0

    def look(self, frame: CameraFrame, carrying: bool, boot_id: str) -> tuple[Look, ObservationBatch] | None:
        """See devices.quadruped.look.Eyes."""
        try:
            seen = look_at_frame(frame, self._detector)
        except PictureError as error:
            log.warning("%s", error)
            return None
        if carrying:
            seen = replace(seen, sightings=tuple(s for s in seen.sightings if not is_load(s, seen.lens)))
        tracked = self._tracker.update(seen)
        view = floor_view(seen.lens, self._site.wall, self._site.door)
        self._seq += 1
        batch = ObservationBatch(
            source=self._robot,
            boot_id=boot_id,
            seq=self._seq,
            stamp_s=frame.stamp_s,
            kind="robot",
            objects=tracked.objects,
            gone=tracked.gone,
            view=view if view.polygon_m else None,
        )
        return self._look_of(seen), batch

    def _look_of(self, seen: Seen) -> Look:
        things = tuple(
            Thing(
                s.detection.type,
                s.detection.confidence,
                s.position_enu_m,
                dict(s.detection.props),
                alternatives(s.detection),
            )
            for s in seen.sightings
            if s.detection.type != ROBOT
        )
        lens = seen.lens
        return Look(
            stamp_s=seen.stamp_s,
            camera_m=lens.position_enu_m[:2],
            yaw_rad=lens.yaw_rad,
            hfov_rad=2.0 * float(np.arctan(lens.width_px / 2.0 / lens.focal_px)),
            things=things,
            surface_m=surface_points(lens, seen.depth_m),
        )


def alternatives(detection: Detection) -> dict[str, float]:
    """Other types that a detection may be of, each with the confidence it would have."""
    if not len(detection.log_probs):
        return {}
    shares = np.exp(detection.log_probs - detection.log_probs.max())
    return {
        type: float(detection.confidence * share)
        for type, share in zip(known_types(), shares, strict=False)
        if detection.confidence * share >= SUSPICION and type not in (detection.type, ROBOT)
    }


def is_load(sighting: Sighting, lens: Lens) -> bool:
    """Whether what is seen is what the robot carries itself."""
    x, y, z = lens.position_enu_m
    hand = (x + HAND_FROM_CAMERA_M * cos(lens.yaw_rad), y + HAND_FROM_CAMERA_M * sin(lens.yaw_rad))
    near_hand = dist(sighting.position_enu_m, (*hand, z - HAND_BELOW_CAMERA_M)) < LOAD_M
    return near_hand or dist(sighting.position_enu_m, lens.position_enu_m) < TOO_NEAR_M


def surface_points(lens: Lens, depth_m: Depth | None) -> Points:
    """Every so many pixels of the depth picture as a point of the site."""
    if depth_m is None:
        return np.zeros((0, 3), np.float32)
    half = EVERY_PX // 2
    v, u = np.mgrid[half : lens.height_px : EVERY_PX, half : lens.width_px : EVERY_PX]
    along = depth_m[half::EVERY_PX, half::EVERY_PX].ravel()
    known = (along > 0.0) & (along < FARTHEST_M)
    rays = lens.rays(u.ravel() + 0.5, v.ravel() + 0.5)[known]
    points: Points = (np.array(lens.position_enu_m) + rays * along[known, None]).astype(np.float32)
    return points
