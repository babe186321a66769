"""Which drones of a site are flown by the simulator, and where their processes look for an autopilot."""

import re
from dataclasses import dataclass
from ipaddress import IPv4Address
from math import radians

from sim.physics import RobotStart
from wire.site import Robot, Site

_LINK = re.compile(r"(udpin|udpout|tcpout)://([^:]+):(\d+)")


@dataclass(frozen=True)
class Aerial:
    """The address of one drone's autopilot, as the drone has it."""

    kind: str
    port: int


def simulated(site: Site) -> list[Robot]:
    """The drones whose autopilot is looked for on this machine: the others fly by themselves."""
    return [robot for robot in site.robot if robot.kind == "drone" and aerial_of(robot) is not None]


def drone_starts(site: Site) -> list[RobotStart]:
    return [RobotStart(r.id, r.start_m, radians(r.start_yaw_deg)) for r in simulated(site)]


def aerial_of(robot: Robot) -> Aerial | None:
    """None when it is elsewhere, or at the end of a serial line."""
    found = _LINK.fullmatch(robot.link or "")
    return Aerial(found[1], int(found[3])) if found is not None and _is_here(found[2]) else None


def _is_here(host: str) -> bool:
    try:
        address = IPv4Address(host)
    except ValueError:
        return host == "localhost"
    return address.is_loopback or address.is_unspecified
