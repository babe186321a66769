"""Clients that nobody here wrote fly `sim.sitl`, each a process of its own.

MAVProxy and dronekit are no part of this project's packages: name an interpreter that has them in R2X_CLIENTS_PYTHON.
"""

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

HERE = Path(__file__).parent
OTHERS = os.environ.get("R2X_CLIENTS_PYTHON", "")
others = pytest.mark.skipif(not OTHERS, reason="R2X_CLIENTS_PYTHON names no interpreter with MAVProxy and dronekit")
pytestmark = [pytest.mark.walk, pytest.mark.timeout(240)]


class Sitl(NamedTuple):
    firmware: str
    tcp: str
    udp: str


def free_udp_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.bind(("127.0.0.1", 0))
        return int(made.getsockname()[1])


@pytest.fixture(params=["ardupilot", "px4"])
def sitl(request, tmp_path) -> Iterator[Sitl]:
    udp = free_udp_port()
    said = tmp_path / "sitl.txt"
    command = [sys.executable, "-m", "sim.sitl", "--firmware", request.param]
    command += ["--tcp", "0", "--udp-out", f"127.0.0.1:{udp}"]
    with said.open("wb") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT, cwd=HERE.parent.parent)
    try:
        end_s = time.monotonic() + 30
        while "ready" not in said.read_text():
            assert process.poll() is None, said.read_text()
            assert time.monotonic() < end_s, said.read_text()
            time.sleep(0.05)
        found = re.search(r"TCP on ([\d.]+:\d+)", said.read_text())
        assert found, said.read_text()
        yield Sitl(request.param, found[1], f"127.0.0.1:{udp}")
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 0, said.read_text()
    assert "Traceback" not in said.read_text()


def run(python: str, script: str, *arguments: str) -> None:
    command = [python, str(HERE / script), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, check=False)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert done.stdout.rstrip().endswith("OK"), done.stdout[-3000:]


def test_mavsdk(sitl):
    run(sys.executable, "mavsdk_flight.py", f"udpin://{sitl.udp}" if sitl.firmware == "px4" else f"tcpout://{sitl.tcp}")


def test_pymavlink(sitl):
    run(sys.executable, "pymavlink_flight.py", f"udpin:{sitl.udp}" if sitl.firmware == "px4" else f"tcp:{sitl.tcp}")


@others
def test_mavproxy(sitl):
    mavproxy = str(Path(OTHERS).with_name("mavproxy.py"))
    run(OTHERS, "mavproxy_session.py", mavproxy, f"tcp:{sitl.tcp}", f"udpin:{sitl.udp}", sitl.firmware)


@others
def test_dronekit(sitl):
    if sitl.firmware == "px4":
        pytest.skip("dronekit never finds PX4 armable: it wants ArduPilot's EKF_STATUS_REPORT")
    run(OTHERS, "dronekit_flight.py", f"tcp:{sitl.tcp}")
