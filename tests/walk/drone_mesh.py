"""A mesh of a router, a simulated autopilot and a drone's process; the test is the hub."""

import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from tests.walk.mesh import end_all
from wire.bus import Received, Reply
from wire.messages.command import CancelRequest, Command, CommandAck, Result, RobotReport, TrafficOrder
from wire.messages.observation import EventLog
from wire.node import node_for
from wire.site import load_site

ROOT = Path(__file__).parents[2]
SITE = """
name = "drone-walk"
[router]
endpoint = "tcp/127.0.0.1:{port}"
secured = false
[clock]
mode = "wall"
[[room]]
id = "west"
name = "west room"
kind = "LivingRoom"
polygon_m = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]
[[room]]
id = "east"
name = "east room"
kind = "Kitchen"
polygon_m = [[4.0, 0.0], [8.0, 0.0], [8.0, 4.0], [4.0, 4.0]]
[[wall]]
start_m = [4.0, 0.0]
end_m = [4.0, 1.5]
[[wall]]
start_m = [4.0, 2.5]
end_m = [4.0, 4.0]
[[door]]
id = "door-1"
rooms = ["west", "east"]
start_m = [4.0, 1.5]
end_m = [4.0, 2.5]
[[robot]]
id = "drone-1"
kind = "drone"
start_m = [0.0, 0.0]
origin_enu_m = [1.5, 2.0, 0.0]
lost_hub_s = 1.0
land_after_s = 4.0
link = "udpin://127.0.0.1:{link_port}"
[[process]]
id = "router"
role = "router"
module = "wire.router"
[[process]]
id = "hub"
role = "hub"
module = "hub"
[[process]]
id = "drone-1"
role = "robot"
module = "devices.drone"
"""
START_M = (1.5, 2.0)
"""Where the autopilot's local frame has its origin, and the drone stands."""


def free_port(kind: socket.SocketKind) -> int:
    with socket.socket(type=kind) as free:
        free.bind(("127.0.0.1", 0))
        port: int = free.getsockname()[1]
        return port


class DroneMesh:
    """`firmware`: which family of autopilot is at the other end of the link."""

    def __init__(self, folder: Path, firmware: str = "ardupilot") -> None:
        self.folder, self._firmware = folder, firmware
        self._port, self._link_port = free_port(socket.SOCK_STREAM), free_port(socket.SOCK_DGRAM)
        self.site_file = folder / "site.toml"
        self.site_file.write_text(SITE.format(port=self._port, link_port=self._link_port))
        self.site = load_site(self.site_file)
        self.processes: dict[str, subprocess.Popen[bytes]] = {}
        self.reports: list[RobotReport] = []
        self.results: dict[str, Result] = {}
        self.acks: dict[int, CommandAck] = {}
        self.lines: list[str] = []
        self.there = True
        """Whether the hub gives signs of life."""
        self._seq, self._told_s = 0, 0.0

    def __enter__(self) -> "DroneMesh":
        self.start("router", "wire.router", "--site", str(self.site_file), "--id", "router")
        self._until(lambda: "routing on" in self.log("router"), 20.0, time.sleep)
        self.start_autopilot()
        self.start_drone()
        self._hub = node_for(self.site, "hub", "hub").__enter__()
        for topic in ("robot_report", "result", "event"):
            self._hub.subscribe(topic, "drone-1")
        return self

    def __exit__(self, *_: object) -> None:
        self._hub.__exit__(None, None, None)
        end_all(self.processes.values(), patience_s=10)

    def start_autopilot(self) -> None:
        link = f"127.0.0.1:{self._link_port}"
        self.start("autopilot", "sim.sitl", "--firmware", self._firmware, "--udp-out", link)

    def start_drone(self) -> None:
        self.start("drone-1", "devices.drone", "--site", str(self.site_file), "--id", "drone-1")

    def end(self, id: str) -> int:
        self.processes[id].terminate()
        return self.processes[id].wait(15)

    def start(self, id: str, module: str, *args: str) -> None:
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "R2X_STATE": str(self.folder / "state")}
        with (self.folder / f"{id}.log").open("ab") as log:
            self.processes[id] = subprocess.Popen(
                [sys.executable, "-m", module, *args], cwd=self.folder, env=environment, stdout=log, stderr=log
            )

    def kill(self, id: str) -> None:
        self.processes[id].kill()
        self.processes[id].wait()

    def log(self, id: str) -> str:
        file = self.folder / f"{id}.log"
        return file.read_text(errors="replace") if file.exists() else ""

    @property
    def report(self) -> RobotReport:
        return self.reports[-1]

    def ready(self) -> None:
        """The drone reports, hears the hub, and has found its autopilot."""
        self.until(lambda: bool(self.reports) and self.report.status == "idle", 30.0)
        self.until(lambda: any("found an autopilot" in line for line in self.lines), 30.0)
        assert not any("could not be set" in line for line in self.lines), self.lines

    def give(self, goal_id: str, action: str, **fields: object) -> None:
        """A goal, accepted."""
        command = {"epoch": 1, "robot": "drone-1", "valid_until_s": time.time() + 30.0, "timeout_s": 60.0, **fields}
        goal = Command.model_validate({"goal_id": goal_id, "action": action, **command})
        ack = self._ask("goal", goal)
        assert ack.accepted, ack.reason

    def cancel(self, goal_id: str) -> None:
        self._ask("cancel", CancelRequest(robot="drone-1", goal_id=goal_id, epoch=1))

    def ended(self, goal_id: str, limit_s: float = 60.0) -> Result:
        self.until(lambda: goal_id in self.results, limit_s)
        return self.results[goal_id]

    def do(self, goal_id: str, action: str, **fields: object) -> Result:
        self.give(goal_id, action, **fields)
        return self.ended(goal_id)

    def done(self, goal_id: str, action: str, **fields: object) -> None:
        result = self.do(goal_id, action, **fields)
        assert result.status == "done", result.reason

    def until(self, true: Callable[[], bool], limit_s: float = 30.0) -> None:
        self._until(true, limit_s, self._listen)

    def _until(self, true: Callable[[], bool], limit_s: float, wait: Callable[[float], None]) -> None:
        deadline = time.monotonic() + limit_s
        while not true():
            assert time.monotonic() < deadline, f"it did not come to pass: {self.reports[-1:]} {self.lines[-3:]}"
            wait(0.05)

    def _ask(self, service: str, message: Command | CancelRequest) -> CommandAck:
        number = self._hub.ask(service, message, "drone-1", timeout_s=5.0)
        self.until(lambda: number in self.acks)
        return self.acks[number]

    def _listen(self, seconds: float) -> None:
        if self.there and time.monotonic() - self._told_s > 0.2:
            self._told_s, self._seq = time.monotonic(), self._seq + 1
            order = TrafficOrder(robot="drone-1", seq=self._seq, stamp_s=time.time(), go=True)
            self._hub.publish("traffic", order, "drone-1")
        for event in self._hub.collect(seconds):
            if isinstance(event, Reply) and isinstance(event.message, CommandAck):
                self.acks[event.ask] = event.message
            elif isinstance(event, Received) and isinstance(event.message, RobotReport):
                self.reports.append(event.message)
            elif isinstance(event, Received) and isinstance(event.message, Result):
                self.results[event.message.goal_id] = event.message
            elif isinstance(event, Received) and isinstance(event.message, EventLog):
                self.lines.append(event.message.text)
