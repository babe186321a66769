"""A quadruped's process without its shell: the device that takes goals, the body that does them."""

from collections.abc import Sequence
from functools import partial
from math import inf

from devices.device import Device
from devices.goals_journal import GoalsJournal
from devices.quadruped.body import Body
from devices.quadruped.look import Eyes, Look
from devices.quadruped.map import FloorMap
from devices.quadruped.robot import Robot
from devices.quadruped.work import QuadrupedWorker
from devices.row import robot_row
from devices.vision.pending import Pending
from wire.bus import Event, Node, Received
from wire.messages.driver import CameraFrame
from wire.messages.observation import ObservationBatch
from wire.model import Message
from wire.site import Site

KIND = "quadruped"
CONTROL_S = 0.05
LOOK_UP_S = 0.25
EARLY_S = 1e-6


class QuadrupedCore:
    """Without eyes it walks by its lidar and reports nothing that it sees."""

    def __init__(self, site: Site, id: str, journal: GoalsJournal, eyes: Eyes | None = None) -> None:
        row = robot_row(site, id, KIND, "driven")
        self._id = id
        self._hub_ids = [process.id for process in site.process if process.role == "hub"]
        self._body = Body(id, FloorMap(site), sighted=eyes is not None)
        worker = QuadrupedWorker(Robot(self._body, site))
        self._device = Device(id, worker, journal, row.lost_hub_s)
        self._journal, self._eyes = journal, eyes
        self._looks: Pending[tuple[Look, ObservationBatch] | None] = Pending(f"look-{id}")
        self._control_due_s = 0.0

    def start(self, node: Node) -> None:
        self._node = node
        for topic in ("odometry", "scan", "gripper_state", "traffic"):
            node.subscribe(topic, self._id)
        if self._eyes is not None:
            node.subscribe("frame", self._id)
        for hub_id in self._hub_ids:
            node.subscribe("health", hub_id)
        self._device.start(node)

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self._body.now_s = now_s
        for event in events:
            if isinstance(event, Received):
                self._hear(event.message, now_s)
            self._device.hear(event, now_s)
        for seen in self._looks.due(now_s):
            if seen is not None:
                self._body.looks.append(seen[0])
                self._node.publish("observation", seen[1], self._id)
        if now_s < self._control_due_s - EARLY_S:
            return
        self._control_due_s = now_s + CONTROL_S
        self._device.step(now_s)
        if self._body.odometry is not None:
            self._body.publish(self._node)

    def _hear(self, message: Message, now_s: float) -> None:
        if not isinstance(message, CameraFrame):
            self._body.hear(message)
        elif self._eyes is not None:
            look = partial(self._eyes.look, message, self._body.holding, self._node.boot_id)
            self._looks.begin(now_s, look)

    def rests_until_s(self) -> float:
        """Whoever moves or has a goal steps in every tick; whoever may be asked to make way looks up now and then."""
        if not (self._device.at_rest and self._body.at_rest):
            return 0.0
        look_up_s = self._body.now_s + LOOK_UP_S if self._body.directed else inf
        return min(self._looks.next_due_s, look_up_s)

    def stop(self) -> None:
        self._looks.close()
        self._body.stand()
        if self._body.odometry is not None:
            self._body.publish(self._node)
        self._journal.close()
