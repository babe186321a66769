"""A script on pymavlink alone flies both firmwares: streams, parameters, offboard, a mission, return; by TCP and by UDP."""

from pathlib import Path

import pytest

from tests.walk.ground_station import FIRMWARES, Autopilot, fly, needs_clients

pytestmark = [pytest.mark.walk, needs_clients]


@pytest.mark.parametrize("firmware", FIRMWARES)
@pytest.mark.parametrize("transport", ["tcp", "udp"])
def test_pymavlink(tmp_path: Path, firmware: str, transport: str) -> None:
    with Autopilot(tmp_path, firmware) as autopilot:
        tcp, udp = f"tcp:127.0.0.1:{autopilot.tcp_port}", f"udpout:127.0.0.1:{autopilot.udp_port}"
        fly("pymavlink_flight.py", tcp if transport == "tcp" else udp, folder=tmp_path)
