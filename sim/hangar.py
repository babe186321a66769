"""The autopilots of the drones in a simulated building, each where the site file says that its drone looks for it."""

import time

from sim.aerials import aerial_of, simulated
from sim.autopilot.firmware import Firmware
from sim.autopilot.personality import PERSONALITIES
from sim.bullet import STEP_S
from sim.mavlink.endpoint import Aboard, Endpoint
from sim.mavlink.links import LeavesMachine, Link, LinkError, TcpServer, UdpIn, UdpOut
from sim.physics import Physics
from sim.scene import ORIGIN
from wire.bus import CannotRun
from wire.site import Robot, Site


class Hangar:
    """Decides before every step of the physics, and talks once a tick: `listen` before the steps, `tell` after."""

    def __init__(self, site: Site, physics: Physics) -> None:
        """Raises CannotRun when a link cannot be opened."""
        self._physics = physics
        self._firmwares: list[Firmware] = []
        self._endpoints: list[Endpoint] = []
        options, ceiling_m = site.sim, max(room.height_m for room in site.room)
        rows = simulated(site)
        if options is None or not rows:
            return
        personality, unix_s = PERSONALITIES[options.firmware], time.time()
        for sysid, robot in enumerate(rows, start=1):
            firmware = Firmware(physics.drones[robot.id], personality, sysid, ORIGIN, "fused", ceiling_m)
            try:
                self._endpoints.append(
                    Endpoint([Aboard(firmware, personality)], _links(robot, options.mavlink_out), unix_s)
                )
            except LinkError as error:
                self.close()
                remedy = "; send it to a MAVLink router here instead" if isinstance(error, LeavesMachine) else ""
                raise CannotRun(f"the autopilot of {robot.id}: {error}{remedy}") from error
            self._firmwares.append(firmware)
        physics.each_step.append(self._decide)

    def listen(self) -> None:
        """Take what clients have sent."""
        for endpoint in self._endpoints:
            endpoint.poll(self._now_s)

    def tell(self) -> None:
        """Send the telemetry that is due."""
        for endpoint in self._endpoints:
            endpoint.step(self._now_s)

    def close(self) -> None:
        for endpoint in self._endpoints:
            endpoint.close()

    @property
    def _now_s(self) -> float:
        return self._physics.step_count * STEP_S

    def _decide(self, now_s: float) -> None:
        for firmware in self._firmwares:
            firmware.step(now_s)


def _links(robot: Robot, stations: tuple[str, ...]) -> list[Link]:
    """The other end of the drone's own link, and one for each ground station."""
    aerial = aerial_of(robot)
    assert aerial is not None
    links: list[Link] = []
    try:
        match aerial.kind:
            case "udpin":
                links.append(UdpOut("127.0.0.1", aerial.port))
            case "udpout":
                links.append(UdpIn(aerial.port))
            case _:
                links.append(TcpServer(aerial.port))
        for station in stations:
            host, _, port = station.rpartition(":")
            links.append(UdpOut(host, int(port)))
    except LinkError:
        for link in links:
            link.close()
        raise
    return links
