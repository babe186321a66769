"""A drone's process without its shell: the device that takes goals, the pilot that flies them."""

import logging
from collections.abc import Callable, Sequence
from math import inf

from devices.device import Device
from devices.drone.airspace import Airspace
from devices.drone.craft import Craft
from devices.drone.obstacles import Obstacles
from devices.drone.pilot import Found, Land, News, NoLink, Pilot, Said
from devices.drone.work import DroneWorker
from devices.goals_journal import GoalsJournal
from devices.row import robot_row
from wire.bus import Event, Node, Received, Reply
from wire.messages.command import TrafficOrder
from wire.messages.observation import EventLog
from wire.messages.world import SnapshotRequest, WorldDelta, WorldState
from wire.model import Message
from wire.site import Robot, Site

log = logging.getLogger("drone")
KIND = "drone"
CONTROL_S = 0.05
EARLY_S = 1e-6
FIRST_S = 5.0
WORLD_S = 30.0
"""So often the whole world is asked for: what changed while the hub was away was missed."""


class DroneCore:
    """See wire.bus.Core. `open_pilot` makes what flies this row of the site file."""

    def __init__(self, site: Site, id: str, journal: GoalsJournal, open_pilot: Callable[[Robot], Pilot]) -> None:
        row = robot_row(site, id, KIND, "flown")
        self._id, self._journal = id, journal
        self._hub_ids = [process.id for process in site.process if process.role == "hub"]
        self._pilot = open_pilot(row)
        self._obstacles = Obstacles(site.wall)
        space = Airspace(site)
        space.obstacles = self._obstacles.by_id
        self.craft = Craft(row, space, self._pilot)
        self._device = Device(id, DroneWorker(self.craft), journal, row.lost_hub_s)
        self._control_due_s = self._ask_due_s = 0.0
        self._lines, self._lost, self._said = 0, True, ""
        self._missed_s: float | None = None
        self._by_hand = False
        """When it is told that there has been no autopilot from the start; infinite once that is settled."""

    def start(self, node: Node) -> None:
        self._node = node
        node.subscribe("traffic", self._id)
        node.subscribe("world_delta")
        for hub_id in self._hub_ids:
            node.subscribe("health", hub_id)
        self._device.start(node)
        self._pilot.start()

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self.craft.now_s = now_s
        for news in self._pilot.news():
            self.craft.hear(news)
            self._tell_of(news)
        for event in events:
            if isinstance(event, Received | Reply):
                self._hear(event.message)
            self._device.hear(event, now_s)
        if now_s < self._control_due_s - EARLY_S:
            return
        self._control_due_s = now_s + CONTROL_S
        self._tell_of_losses()
        if now_s >= self._ask_due_s and not self._device.hub_lost(now_s):
            self._ask_due_s = now_s + WORLD_S
            self._node.ask("snapshot", SnapshotRequest())
        self._device.step(now_s)

    def _hear(self, message: Message | None) -> None:
        if isinstance(message, TrafficOrder):
            self.craft.order = message
        elif isinstance(message, WorldState | WorldDelta):
            self._obstacles.take(message)

    def stop(self) -> None:
        """What is in the air is landed: nobody looks after it any more."""
        if self.craft.airborne and not self.craft.lost and not self.craft.flown_by_others:
            self._pilot.ask(Land())
        self._pilot.stop()
        self._journal.close()

    # What people should know

    def _tell_of(self, news: News) -> None:
        match news:
            case Said() if news.urgent:
                self._tell(f"the autopilot says: {news.text}")
            case NoLink():
                self._tell(f"the link {self.craft.row.link} cannot be opened: {news.reason}")
            case Found():
                self._tell(f"found an autopilot: system {news.system}, {news.firmware}; {news.fault or 'ready'}")

    def _tell_of_losses(self) -> None:
        if self.craft.by_hand != self._by_hand:
            self._by_hand = self.craft.by_hand
            left = "a person flies it: left alone until its mode is switched" if self._by_hand else "given back"
            self._tell(f"{left} ({self.craft.mode})")
        if self.craft.lost != self._lost:
            self._lost = self.craft.lost
            link = self.craft.row.link
            self._tell(f"the autopilot at {link} is {'not heard any more' if self._lost else 'heard'}")
            self._missed_s = inf
        elif self._missed_s is None:
            self._missed_s = self.craft.now_s + FIRST_S
        elif self.craft.now_s >= self._missed_s:
            self._missed_s = inf
            self._tell(f"no autopilot is heard at {self.craft.row.link} yet")

    def _tell(self, text: str) -> None:
        if text == self._said:
            return
        self._said = text
        log.info("%s", text)
        line = EventLog(source=self._id, seq=self._lines, stamp_s=self.craft.now_s, text=text[:2000])
        self._lines += 1
        self._node.publish("event", line, self._id)
