"""`python -m bench.sitl [--json]`: how soon the drone simulator is ready, what a vehicle costs, how soon it answers.

Start: from the process's birth to its first line of "ready". Processor: of a vehicle in the air in real time with one
client, as a part of one core. Answer: from COMMAND_LONG to its COMMAND_ACK over TCP on loopback.
"""

import argparse
import json
import re
import socket
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.sitl_options import vehicle_count

COMMANDS = 200
AIR_S = 10.0
TICKS = 100
"""Of the kernel's processor clock in a second."""


class Station:
    """One TCP client that waits."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), 5.0)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.codec = mav.MAVLink(self, 255, 190)

    def write(self, data: bytes) -> None:
        self.socket.sendall(data)

    def wait(self, name: str, span_s: float = 15.0) -> Any:
        end_s = time.monotonic() + span_s
        while time.monotonic() < end_s:
            for message in self.codec.parse_buffer(self.socket.recv(65536)) or ():
                if message.get_type() == name:
                    return message
        raise RuntimeError(f"no {name} within {span_s} s")

    def command(self, command: int, *params: float, sysid: int = 1) -> int:
        self.codec.command_long_send(sysid, 1, command, 0, *params, *(0.0,) * (7 - len(params)))
        return int(self.wait("COMMAND_ACK").result)


def _processor_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def _take_off(station: Station, vehicles: int) -> None:
    for sysid in range(1, vehicles + 1):
        end_s = time.monotonic() + 15.0
        while station.command(mav.MAV_CMD_DO_SET_MODE, 1, 4, sysid=sysid) or station.command(
            mav.MAV_CMD_COMPONENT_ARM_DISARM, 1, sysid=sysid
        ):
            if time.monotonic() > end_s:
                raise RuntimeError(f"vehicle {sysid} does not arm")
            time.sleep(0.2)
        station.command(mav.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 1.5, sysid=sysid)


def measure(vehicles: int) -> dict[str, float]:
    """The figures with this many vehicles."""
    begun_s = time.monotonic()
    command = [sys.executable, "-m", "sim.sitl", "--tcp", "0", "--vehicles", str(vehicles)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            port = 0
            for line in process.stdout:
                found = re.match(r"TCP on [\d.]+:(\d+)", line)
                port = int(found[1]) if found else port
                if line.startswith("ready"):
                    break
            start_s, start_processor_s = time.monotonic() - begun_s, _processor_s(process.pid)
            station = Station(port)
            _take_off(station, vehicles)
            answers_ms = []
            for _ in range(COMMANDS):
                sent_s = time.perf_counter()
                station.command(mav.MAV_CMD_REQUEST_MESSAGE, 148)
                answers_ms.append((time.perf_counter() - sent_s) * 1000)
            before_s, from_s = _processor_s(process.pid), time.monotonic()
            while time.monotonic() < from_s + AIR_S:
                station.socket.recv(65536)
            share = (_processor_s(process.pid) - before_s) / (time.monotonic() - from_s) / vehicles
            station.socket.close()
        finally:
            process.terminate()
    return {
        "start_s": round(start_s, 2),
        "start_processor_s": round(start_processor_s, 2),
        "core_share_per_vehicle": round(share, 3),
        "answer_ms": round(statistics.median(answers_ms), 2),
    }


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m bench.sitl", description=__doc__)
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.add_argument("--vehicles", type=vehicle_count, default=1, metavar="N")
    given = parser.parse_args(argv)
    figures = measure(given.vehicles)
    if given.json:
        print(json.dumps({"vehicles": given.vehicles, **figures}))
    else:
        for name, figure in figures.items():
            print(f"{name:24} {figure:8.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
