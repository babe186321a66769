"""dronekit flies the ArduCopter there and back and on a mission, and reads a PX4, which it never holds for armable."""

from pathlib import Path

import pytest

from tests.walk.ground_station import FIRMWARES, Autopilot, fly, needs_clients

pytestmark = [pytest.mark.walk, needs_clients]


@pytest.mark.parametrize("firmware", FIRMWARES)
def test_dronekit(tmp_path: Path, firmware: str) -> None:
    # It says degrees in single precision, which near (1, 1) are centimetres.
    with Autopilot(tmp_path, firmware, "--home", "1,1,50,0") as autopilot:
        fly("dronekit_flight.py", f"tcp:127.0.0.1:{autopilot.tcp_port}", firmware, folder=tmp_path)
