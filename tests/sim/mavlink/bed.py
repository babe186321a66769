"""A whole simulated drone and a client on a real socket, stepped together: time passes only as the test says."""

import socket
from collections.abc import Callable
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.bullet import STEP_S
from sim.mavlink.endpoint import Aboard, Endpoint
from sim.mavlink.links import TcpServer, UdpIn
from sim.mavlink.peer import Signing
from sim.sitl_flight import Flight
from sim.sitl_options import parse

STEPS = 2


class Bed:
    """Vehicles of one firmware, a TCP server and a UDP port."""

    def __init__(self, firmware: str, *arguments: str, key: bytes | None = None) -> None:
        options = parse(["--firmware", firmware, *arguments])
        signing = Signing(key, 1.8e9) if key is not None else None
        self.tcp, self.udp = TcpServer(0, signing=signing), UdpIn(0, signing=signing)
        self.flight = Flight(options)
        self.firmware = self.flight.firmwares[0]
        aboard = [Aboard(each, each.now.row) for each in self.flight.firmwares]
        self.endpoint = Endpoint(aboard, [self.tcp, self.udp])
        self.clients: list[Client] = []

    def __enter__(self) -> "Bed":
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    def advance(self, span_s: float) -> None:
        """Let time pass; clients take what comes."""
        for _ in range(max(1, round(span_s / STEP_S / STEPS))):
            for client in self.clients:
                client.beat(self.flight.now_s)
            self.endpoint.poll(self.flight.now_s)
            for _ in range(STEPS):
                self.flight.step()
            self.endpoint.step(self.flight.now_s)
            for client in self.clients:
                client.receive()

    def client(self, kind: str = "tcp", sysid: int = 245, key: bytes | None = None) -> "Client":
        client = Client(self, kind, sysid, key)
        self.clients.append(client)
        return client

    def close(self) -> None:
        for client in self.clients:
            client.socket.close()
        self.endpoint.close()
        self.flight.close()


class Client:
    """A ground station on the generated dialect; `sysid` tells two of them apart."""

    def __init__(self, bed: Bed, kind: str, sysid: int, key: bytes | None) -> None:
        self.bed = bed
        self.kind = kind
        stream = kind == "tcp"
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM if stream else socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", bed.tcp.port if stream else bed.udp.port))
        self.socket.setblocking(False)
        self.mav = mav.MAVLink(self, sysid, 190)
        self.reader = mav.MAVLink(None)
        self.reader.robust_parsing = True
        if key is not None:
            self.mav.signing.secret_key = key
            self.mav.signing.sign_outgoing = True
            self.mav.signing.timestamp = int((1.8e9 - 1_420_070_400) * 1e5)
        self.heard: list[Any] = []
        self.beats = True
        self._beat_s = -1.0

    def write(self, data: bytes) -> None:
        self.socket.send(data)

    def beat(self, now_s: float) -> None:
        if self.beats and now_s - self._beat_s >= 1.0:
            self._beat_s = now_s
            self.mav.heartbeat_send(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 4)

    def receive(self) -> None:
        while True:
            try:
                data = self.socket.recv(65536)
            except (BlockingIOError, ConnectionResetError):
                return
            if not data:
                return
            self.heard.extend(self.reader.parse_buffer(data) or ())

    def all(self, name: str) -> list[Any]:
        return [message for message in self.heard if message.get_type() == name]

    def wait(self, name: str, span_s: float = 5.0, such: Callable[[Any], bool] = lambda message: True) -> Any:
        """The first such message that came since the last `ask` or `forget`; fails when none comes in `span_s`."""
        until_s = self.bed.flight.now_s + span_s
        seen = 0
        while True:
            for message in self.heard[seen:]:
                if message.get_type() == name and such(message):
                    return message
            seen = len(self.heard)
            assert self.bed.flight.now_s < until_s, f"no {name} within {span_s} s; heard {self.texts()}"
            self.bed.advance(0.02)

    def forget(self) -> None:
        self.heard.clear()

    def texts(self) -> list[str]:
        return [message.text for message in self.all("STATUSTEXT")]

    def command(self, command: int, *params: float, target: tuple[int, int] = (1, 1)) -> int:
        """COMMAND_LONG; the result of its acknowledgement."""
        self.forget()
        seven = (*params, *(0.0,) * (7 - len(params)))
        self.mav.command_long_send(*target, command, 0, *seven)
        ack = self.wait("COMMAND_ACK", such=lambda message: message.command == command)
        return int(ack.result)

    def fly(self, height_m: float = 1.5) -> None:
        """Arm and be at `height_m` above home."""
        px4 = self.bed.firmware.now.row.name == "px4"
        self.wait("SYS_STATUS", 20.0, lambda m: bool(m.onboard_control_sensors_health & 0x10000000))
        if px4:
            self.mav.param_set_send(1, 1, b"MIS_TAKEOFF_ALT", height_m, mav.MAV_PARAM_TYPE_REAL32)
        else:
            assert self.command(mav.MAV_CMD_DO_SET_MODE, 1, 4) == 0
        assert self.command(mav.MAV_CMD_COMPONENT_ARM_DISARM, 1) == 0, self.texts()
        nan = float("nan")
        assert self.command(mav.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, nan, nan, nan, nan if px4 else height_m) in (0, 5)
        self.wait("LOCAL_POSITION_NED", 12.0, lambda m: m.z < -height_m + 0.15)
        self.forget()
