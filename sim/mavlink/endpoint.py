"""All vehicles on all links: what comes in goes to whom it is meant for, and each one's streams go out."""

import logging
from collections.abc import Callable, Sequence
from typing import NamedTuple
from weakref import WeakSet

from sim.autopilot.interface import Autopilot, Severity
from sim.autopilot.personality import Personality
from sim.mavlink.craft import AUTOPILOT, Craft, Sender
from sim.mavlink.links import Link
from sim.mavlink.node import Node
from sim.mavlink.peer import Message, Peer

log = logging.getLogger(__name__)
LOG_EVERY_S = 30.0


class Aboard(NamedTuple):
    """One vehicle to be put on the wire."""

    autopilot: Autopilot
    personality: Personality
    capture: Callable[[], bool] = lambda: True
    """Takes a picture; whether there is one."""
    camera: bool = True
    """Whether a camera and a gimbal show themselves."""


class Endpoint:
    """Non-blocking; whoever owns the clock calls `poll` and `step`."""

    def __init__(self, vehicles: Sequence[Aboard], links: Sequence[Link], unix_s: float = 0.0) -> None:
        """`unix_s` is the wall time at now_s = 0. Raises ValueError when two vehicles have one system id."""
        self.links = list(links)
        self._peers: list[Peer] = []
        self._greeted: WeakSet[Peer] = WeakSet()
        self._logged_s, self._logged_bad = 0.0, 0
        ids = [vehicle.autopilot.sysid for vehicle in vehicles]
        if len(set(ids)) != len(ids) or not all(1 <= each <= 254 for each in ids):
            raise ValueError(f"system ids {ids}: each must be from 1 to 254 and no two the same")
        self.nodes = [
            Node(Craft(autopilot, personality, lambda: self._peers, unix_s, capture, camera))
            for autopilot, personality, capture, camera in vehicles
        ]

    def _refresh(self) -> None:
        self._peers = [peer for link in self.links for peer in link.peers()]

    def poll(self, now_s: float) -> None:
        """Take what has come on every link and act on it."""
        for link in self.links:
            for peer, message in link.poll(now_s):
                if peer not in self._greeted:
                    self._refresh()
                self._dispatch(peer, message, now_s)
        self._refresh()

    def _dispatch(self, peer: Peer, message: Message, now_s: float) -> None:
        sender = Sender(peer, message.get_srcSystem(), message.get_srcComponent())
        if sender.sysid == 0:
            return
        if peer not in self._greeted:
            self._greeted.add(peer)
            self._greet(sender)
        for node in self.nodes:
            if (sender.sysid, sender.compid) != (node.craft.sysid, AUTOPILOT):
                node.handle(message, sender, now_s)

    def _greet(self, sender: Sender) -> None:
        for node in self.nodes:
            for text in node.craft.texts(Severity.INFO, node.craft.personality.banner):
                node.craft.reply(sender, text)

    def step(self, now_s: float) -> None:
        """Send what is due."""
        for node in self.nodes:
            node.step(now_s)
        if now_s - self._logged_s >= LOG_EVERY_S:
            self._log(now_s)

    def _log(self, now_s: float) -> None:
        bad = sum(peer.counts.bad for peer in self._peers)
        if bad > self._logged_bad:
            log.info("%d broken or unknown frames since %.0f s ago", bad - self._logged_bad, now_s - self._logged_s)
        self._logged_s, self._logged_bad = now_s, bad

    def close(self) -> None:
        """Close every link."""
        for link in self.links:
            link.close()
