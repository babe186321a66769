"""Simulated drones and their wire, run by the wall clock."""

import ipaddress
import select
import time
from collections.abc import Sequence
from math import inf, radians
from types import FrameType
from typing import Any

from sim.autopilot.firmware import Firmware
from sim.autopilot.personality import PERSONALITIES
from sim.bullet import STEP_S, add_floor, open_bullet
from sim.flight.quadrotor import Quadrotor
from sim.generator.home import make_home
from sim.mavlink.endpoint import Aboard, Endpoint
from sim.mavlink.links import Link, LinkError, TcpServer, UdpIn, UdpOut
from sim.mavlink.peer import Signing
from sim.physics import EVERYTHING, FIRST_ROBOT, FLOOR, Physics
from sim.sitl_options import Options
from wire.frames import heading_to_yaw_rad

APART_M = 1.5
STEPS_PER_TURN = 2
FARTHEST_BEHIND_S = 0.5
"""A machine that is slower than the clock lets time slip rather than hurry after it."""


class Flight:
    """The vehicles in their world. Time is the number of steps."""

    def __init__(self, options: Options) -> None:
        self.steps = 0
        yaw_rad = heading_to_yaw_rad(radians(options.home[3]))
        starts: Sequence[tuple[tuple[float, float], float]]
        if options.house is None:
            self._bullet: Any = open_bullet()
            add_floor(self._bullet, FLOOR, EVERYTHING)
            starts = [((APART_M * k, 0.0), yaw_rad) for k in range(options.vehicles)]
            ceiling_m = inf
        else:
            scene = make_home(options.house)
            self._bullet = Physics(scene, ()).bullet
            starts = [(at, yaw_rad if options.turned else own_rad) for at, own_rad in scene.robot_starts]
            ceiling_m = max(wall.height_m for wall in scene.walls)
        self.vehicles = [
            Quadrotor(
                self._bullet,
                f"drone-{k + 1}",
                (x, y, 0.0),
                start_rad,
                options.seed + k,
                FIRST_ROBOT << k,
                EVERYTHING,
                options.gps == "fused",
                options.home[2],
            )
            for k, ((x, y), start_rad) in enumerate(starts[: options.vehicles])
        ]
        row = PERSONALITIES[options.firmware]
        self.firmwares = [
            Firmware(vehicle, row, k, options.home[:3], options.gps, ceiling_m, nose_to_region=not options.camera)
            for k, vehicle in enumerate(self.vehicles, start=1)
        ]

    @property
    def now_s(self) -> float:
        return self.steps * STEP_S

    def step(self) -> None:
        """One step of firmware, vehicles and physics."""
        now_s = self.now_s
        for firmware in self.firmwares:
            firmware.step(now_s)
        for vehicle in self.vehicles:
            vehicle.before_step(now_s)
        self._bullet.stepSimulation()
        self.steps += 1

    def close(self) -> None:
        self._bullet.disconnect()


class Sitl:
    """Vehicles and their wire, run until told to stop."""

    def __init__(self, options: Options) -> None:
        """Raises LinkError when a link cannot be opened; none is left open then."""
        self.options = options
        self.running = True
        unix_s = time.time()
        signing = Signing(options.sign_key, unix_s) if options.sign_key is not None else None
        self.links = _open(options, signing)
        self.flight = Flight(options)
        row = PERSONALITIES[options.firmware]
        self.endpoint = Endpoint(
            [Aboard(each, row, camera=options.camera) for each in self.flight.firmwares], self.links, unix_s
        )

    def run(self) -> None:
        """Real time until `running` is false. A message is acted on as soon as it comes."""
        flight, endpoint = self.flight, self.endpoint
        begun_s = time.monotonic() - flight.now_s
        while self.running:
            wait_s = begun_s + flight.now_s - time.monotonic()
            if wait_s > 0:
                select.select([file for link in self.links for file in link.files()], [], [], wait_s)
            endpoint.poll(flight.now_s)
            behind_s = time.monotonic() - begun_s - flight.now_s
            if behind_s < 0:
                continue
            if behind_s > FARTHEST_BEHIND_S:
                begun_s += behind_s
            for _ in range(STEPS_PER_TURN):
                flight.step()
            endpoint.step(flight.now_s)

    def stop(self, signal_number: int = 0, frame: FrameType | None = None) -> None:
        """For a signal handler."""
        self.running = False

    def close(self) -> None:
        self.endpoint.close()
        self.flight.close()

    def lines(self) -> list[str]:
        """What it is, what it listens on, and how to connect."""
        options = self.options
        where = "a bare floor" if options.house is None else f"home {options.house}"
        ids = "system id 1" if options.vehicles == 1 else f"system ids 1 to {options.vehicles}"
        latitude, longitude, altitude_m, _ = options.home
        fixed = f"origin {latitude:.6f}, {longitude:.6f}, {altitude_m:g} m; position also as a GPS fix"
        lines = [
            f"{options.vehicles} x {PERSONALITIES[options.firmware].banner}, {ids}, over {where}",
            fixed
            if options.gps == "fused"
            else "no GPS: no position until a client sends poses, no origin until it sets one",
        ]
        here = "127.0.0.1" if ipaddress.ip_address(options.bind).is_unspecified else options.bind
        for link in self.links:
            if isinstance(link, TcpServer):
                at = f"{here}:{link.port}"
                lines.append(f"TCP on {at}: mavproxy.py --master tcp:{at}; MAVSDK tcpout://{at}")
            elif isinstance(link, UdpIn):
                at = f"{here}:{link.port}"
                lines.append(f"UDP on {at}: mavproxy.py --master udpout:{at}; MAVSDK udpout://{at}")
        for host, port in options.udp_out:
            known = "QGroundControl finds it by itself; " if port == 14550 else ""
            lines.append(f"UDP to {host}:{port}: {known}MAVSDK udpin://{host}:{port}")
        if options.sign_key is not None:
            lines.append("only commands signed with the key are taken")
        return lines


def _open(options: Options, signing: Signing | None) -> list[Link]:
    links: list[Link] = []
    try:
        links.extend(TcpServer(port, options.bind, signing) for port in options.tcp)
        links.extend(UdpIn(port, options.bind, signing) for port in options.udp_in)
        links.extend(UdpOut(host, port, options.bind, signing) for host, port in options.udp_out)
    except LinkError:
        for link in links:
            link.close()
        raise
    return links
