"""The view as a process core: every topic it reads, and what it draws of it."""

import socket
from collections.abc import Callable, Sequence

import rerun as rr

from hub.view.blueprint import blueprint
from hub.view.drawing import Drawing
from hub.view.house import draw_house
from hub.view.light import do_without_pandas
from wire.bus import CannotRun, Event, Node, Received, Reply
from wire.messages.command import RobotReport
from wire.messages.driver import CameraFrame
from wire.messages.observation import EventLog, ObservationBatch
from wire.messages.operator import TaskState
from wire.messages.plan import PlanState
from wire.messages.world import SnapshotRequest, WorldDelta, WorldState
from wire.model import Message
from wire.site import Site

_TOPICS = ("frame", "observation", "robot_report", "world_delta", "plan_state", "task_state", "event")


class ViewCore:
    """Draws into one Rerun recording: to live viewers on the site's port, and to a file when the site names one."""

    def __init__(self, site: Site, rec: rr.RecordingStream) -> None:
        self._site = site
        self._rec = rec
        self._flyers = [robot.id for robot in site.robot if robot.kind == "drone"]
        self._aboard: set[str] = set()
        """Cameras of drones."""
        self._drawing = Drawing(rec, self._flyers)
        draw = self._drawing
        self._handlers: dict[type[Message], Callable[..., None]] = {
            CameraFrame: self._frame,
            ObservationBatch: draw.observation,
            RobotReport: draw.report,
            WorldDelta: draw.world,
            PlanState: draw.plan,
            TaskState: draw.task,
            EventLog: draw.event,
        }

    def start(self, node: Node) -> None:
        self._lay_out()
        draw_house(self._rec, self._site)
        for topic in _TOPICS:
            node.subscribe(topic)
        node.ask("snapshot", SnapshotRequest())

    def _lay_out(self) -> None:
        xs = [x for room in self._site.room for x, _ in room.polygon_m]
        ys = [y for room in self._site.room for _, y in room.polygon_m]
        centre = ((min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2)
        span = max(max(xs) - min(xs), max(ys) - min(ys))
        carried = [r.id for r in self._site.robot if r.id not in self._flyers] + sorted(self._aboard)
        layout = blueprint([c.id for c in self._site.camera], carried, centre, span, flight=bool(self._flyers))
        self._rec.send_blueprint(layout, make_active=True)

    def _frame(self, frame: CameraFrame) -> None:
        """What a drone's cameras are called is known when their first picture comes."""
        self._drawing.frame(frame)
        if frame.camera not in self._aboard and self._drawing.flies(frame.camera):
            self._aboard.add(frame.camera)
            self._lay_out()

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        for event in events:
            if isinstance(event, Received):
                self._handlers[type(event.message)](event.message)
            elif isinstance(event, Reply) and isinstance(event.message, WorldState):
                world = event.message
                whole = WorldDelta(
                    seq=max(1, world.seq), stamp_s=world.stamp_s,
                    robots=world.robots, objects=world.objects, areas=world.areas,
                )  # fmt: skip
                self._drawing.world(whole)
        self._drawing.again(now_s)

    def stop(self) -> None:
        self._rec.flush()
        self._rec.disconnect()


def check_port(port: int) -> None:
    """Rerun only logs that it cannot serve: say it before, so that nobody looks at somebody else's view."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except OSError as error:
            raise CannotRun(
                f"the view cannot listen on 127.0.0.1:{port} ({error.strerror}): stop what uses that port "
                f"(`ss -ltnp 'sport = :{port}'` names it), or set another one as view.grpc_port in the site file"
            ) from None


def open_recording(site: Site) -> rr.RecordingStream:
    """A recording that serves live viewers on loopback and, when the site names a file, writes it too."""
    check_port(site.view.grpc_port)
    do_without_pandas()
    rec = rr.RecordingStream("r2x", recording_id=f"r2x-{site.name}")
    sinks: list[rr.GrpcServerSink | rr.FileSink] = [
        rr.GrpcServerSink(bind_ip="127.0.0.1", port=site.view.grpc_port, server_memory_limit=site.view.memory_limit)
    ]
    if site.view.save:
        sinks.append(rr.FileSink(site.view.save))
    rec.set_sinks(*sinks)
    return rec
