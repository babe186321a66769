"""A fixed camera on the mesh: pictures in, observations and a text log of changes out."""

import logging
from collections.abc import Sequence
from functools import partial
from math import inf
from typing import Protocol

from devices.vision.changes import describe
from devices.vision.detector import Detector
from devices.vision.glances import Glance, Glances
from devices.vision.lens import Image, Lens
from devices.vision.look import Seen, look_at_frame
from devices.vision.model_eyes import seen_by_model
from devices.vision.pending import Pending
from devices.vision.picture import PictureError, encode_jpeg
from devices.vision.steady import SteadyDetector
from devices.vision.tracking import Tracked, Tracker
from devices.vision.view import floor_view
from wire.bus import CannotRun, Event, Node, Received, Reply, Request
from wire.messages.command import DeviceCard
from wire.messages.driver import CameraFrame
from wire.messages.look import LookRequest
from wire.messages.observation import EventLog, ObservationBatch, View
from wire.site import Camera, Site, SiteError

log = logging.getLogger("camera")

MESH = "mesh"
SLACK = 0.9
"""A picture may come this much of the period after the last one."""


class Pictures(Protocol):
    """Pictures that do not come over the mesh."""

    @property
    def fault(self) -> str: ...
    def start(self) -> None: ...
    def stop(self) -> None: ...
    def take(self) -> Image | None: ...


class CctvCore:
    """Looks at its camera's pictures, at the camera's rate, with the calibration of the site file.

    With the detector, or with a vision model behind the planner's process, or with both: then the detector goes on at
    its rate, whatever becomes of the model.
    """

    def __init__(
        self, site: Site, process: str, camera: Camera, detector: Detector | None, pictures: Pictures | None
    ) -> None:
        self._site, self._process, self._camera = site, process, camera
        self._detector = None if detector is None else SteadyDetector(detector)
        self._glances = None if camera.perception == "embedded" else Glances(camera.id, camera.look_every_s)
        self._trouble = ""
        self._heard_model = False
        self._pictures = pictures
        self._looks: Pending[Seen | None] = Pending(f"look-{camera.id}")
        self._lens = Lens.of_camera(camera)
        self._view = floor_view(self._lens, site.wall, site.door)
        self._tracker = Tracker()
        self._looked_s: float | None = None
        self._now_s = 0.0
        self._seq = self._frame_seq = self._line_seq = 0

    def start(self, node: Node) -> None:
        self._node = node
        for id in sorted({self._camera.id, self._process}):
            node.serve("card", id)
        if self._pictures is None:
            node.subscribe("frame", self._camera.id)
        else:
            self._pictures.start()

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self._now_s = now_s
        newest = None
        for event in events:
            match event:
                case Request(service="card"):
                    event.reply(self._card())
                case Received(message=CameraFrame() as frame):
                    newest = frame
                case Reply(service="look_at"):
                    self._hear(event, now_s)
        if self._pictures is not None:
            newest = self._take(self._pictures, now_s)
        if newest is not None and self._due(newest.stamp_s):
            self._looked_s = newest.stamp_s
            if self._detector is not None:
                self._looks.begin(now_s, partial(self._look, self._detector, newest))
            if self._glances is not None:
                self._glance(self._glances, newest, now_s)
        for seen in self._looks.due(now_s):
            if seen is not None:
                self._report(seen)

    def rests_until_s(self) -> float:
        """The next picture is expected a period after the last one; when one is late, there is nothing to expect."""
        expected_s = inf if self._looked_s is None else self._looked_s + 1.0 / self._camera.picture_hz
        return min(expected_s if expected_s > self._now_s else inf, self._looks.next_due_s)

    def stop(self) -> None:
        self._looks.close()
        if self._pictures is not None:
            self._pictures.stop()

    def _card(self) -> DeviceCard:
        return DeviceCard(id=self._camera.id, kind="camera", boot_id=self._node.boot_id)

    def _due(self, stamp_s: float) -> bool:
        return self._looked_s is None or stamp_s - self._looked_s >= SLACK / self._camera.picture_hz

    def _take(self, pictures: Pictures, now_s: float) -> CameraFrame | None:
        """A picture of its own source as a frame, which is published for whoever wants to watch."""
        if pictures.fault:
            raise CannotRun(pictures.fault)
        if not self._due(now_s):
            return None
        rgb = pictures.take()
        if rgb is None:
            return None
        self._frame_seq += 1
        lens = self._lens
        frame = CameraFrame(
            camera=self._camera.id,
            seq=self._frame_seq,
            stamp_s=now_s,
            width_px=lens.width_px,
            height_px=lens.height_px,
            focal_px=lens.focal_px,
            position_enu_m=lens.position_enu_m,
            yaw_rad=lens.yaw_rad,
            tilt_down_rad=lens.tilt_down_rad,
            jpeg=encode_jpeg(rgb),
        )
        self._node.publish("frame", frame, self._camera.id)
        return frame

    def _look(self, detector: Detector, frame: CameraFrame) -> Seen | None:
        try:
            return look_at_frame(frame, detector, self._site.wall, self._site.door)
        except PictureError as error:
            log.warning("%s", error)
            return None

    def _glance(self, glances: Glances, frame: CameraFrame, now_s: float) -> None:
        """Show the model this picture, if it is time to."""
        match glances.offer(now_s, frame):
            case LookRequest() as request:
                glances.asked(self._node.ask("look_at", request))
            case Glance() as still:
                self._report_glance(still)

    def _hear(self, reply: Reply, now_s: float) -> None:
        """What the model says, or that it says nothing: once, however often it fails."""
        if self._glances is None:
            return
        glance = self._glances.hear(reply, now_s)
        if bool(self._glances.trouble) != bool(self._trouble):
            news = f"no answer from the vision model: {self._glances.trouble}" if self._glances.trouble else ""
            self._log(news or "the vision model answers again", now_s)
            log.warning("%s: %s", self._camera.id, news or "the vision model answers again")
        elif glance is not None and not self._heard_model:
            who = "a stand-in for the vision model" if glance.stand_in else "the vision model"
            log.info("%s: %s answers", self._camera.id, who)
        self._heard_model = self._heard_model or glance is not None
        self._trouble = self._glances.trouble
        if glance is not None:
            self._report_glance(glance)
            for line in self._glances.lines(glance, now_s):
                self._log(line, glance.stamp_s)

    def _report(self, seen: Seen) -> None:
        self._publish(self._tracker.update(seen), seen.stamp_s, self._view)

    def _report_glance(self, glance: Glance) -> None:
        """Without a view: what a model does not name may be there all the same."""
        seen = seen_by_model(glance.report, glance.lens, glance.stamp_s, self._site.wall, self._site.door)
        tracked = self._tracker.take_opinion(seen)
        if tracked.objects or tracked.gone or self._detector is None:
            self._publish(tracked, glance.stamp_s, None)

    def _publish(self, tracked: Tracked, stamp_s: float, view: View | None) -> None:
        self._seq += 1
        batch = ObservationBatch(
            source=self._camera.id,
            boot_id=self._node.boot_id,
            seq=self._seq,
            stamp_s=stamp_s,
            kind="cctv",
            objects=tracked.objects,
            gone=tracked.gone,
            view=view,
        )
        self._node.publish("observation", batch, self._camera.id)
        self._log_changes(tracked, stamp_s)

    def _log_changes(self, tracked: Tracked, stamp_s: float) -> None:
        known = [(t.type, t.position_enu_m) for t in self._tracker.tracks if t.confirmed]
        for change in tracked.changes:
            self._log(describe(change, known), stamp_s)

    def _log(self, text: str, stamp_s: float) -> None:
        self._line_seq += 1
        line = EventLog(source=self._camera.id, seq=self._line_seq, stamp_s=stamp_s, text=text[:2000])
        self._node.publish("event", line, self._camera.id)


def camera_of(site: Site, process: str, named: str | None = None) -> Camera:
    """The camera that a process serves: the one named in its arguments, or `cam-3` for `cctv-3`."""
    wanted = named if named is not None else f"cam-{process.removeprefix('cctv-')}"
    for camera in site.camera:
        if camera.id == wanted:
            return camera
    known = ", ".join(camera.id for camera in site.camera) or "none"
    raise SiteError(f"site {site.name} has no camera {wanted!r} for process {process}; its cameras are {known}")
