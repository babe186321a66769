"""MAVSDK flies both firmwares by its asyncio API, on the link that each is known for; PX4's acceptance course included."""

import socket
import sys
from pathlib import Path

import pytest

from tests.walk.drone_mesh import free_port
from tests.walk.ground_station import FIRMWARES, Autopilot, fly

pytestmark = [pytest.mark.walk, pytest.mark.timeout(240)]


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_mavsdk(tmp_path: Path, firmware: str) -> None:
    port = free_port(socket.SOCK_DGRAM)
    with Autopilot(tmp_path, firmware, "--camera", "on", "--udp-out", f"127.0.0.1:{port}") as autopilot:
        url = f"udpin://127.0.0.1:{port}" if firmware == "px4" else f"tcpout://127.0.0.1:{autopilot.tcp_port}"
        fly("mavsdk_flight.py", url, folder=tmp_path, python=sys.executable, limit_s=200.0)
