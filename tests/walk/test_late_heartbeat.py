"""An autopilot whose first words are not its heartbeat: MAVSDK shows it at once, and knows nothing of it yet."""

import socket
import time

import pytest
from pymavlink.dialects.v20 import common

from devices.drone.client import MavsdkPilot
from devices.drone.frame import LocalFrame
from devices.drone.pilot import Found
from tests.walk.drone_mesh import free_port

pytestmark = pytest.mark.walk


def first_found(heartbeat_after_s: float, kind: int, limit_s: float = 15.0) -> Found:
    """What the drone finds at a link over which status comes first, and heartbeats from some time on."""
    port = free_port(socket.SOCK_DGRAM)
    pilot = MavsdkPilot(f"udpin://127.0.0.1:{port}", LocalFrame((0.0, 0.0, 0.0), 0.0), 1.5, "test")
    link = common.MAVLink(None, srcSystem=1, srcComponent=1)
    status = common.MAVLink_sys_status_message(0, 0, 0, 100, 12000, -1, 90, 0, 0, 0, 0, 0, 0)
    mode = common.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    heartbeat = common.MAVLink_heartbeat_message(kind, common.MAV_AUTOPILOT_PX4, mode, 0, common.MAV_STATE_STANDBY, 3)
    pilot.start()
    began = time.monotonic()
    try:
        with socket.socket(type=socket.SOCK_DGRAM) as out:
            while time.monotonic() - began < limit_s:
                messages = [status]
                if time.monotonic() - began > heartbeat_after_s:
                    messages.append(heartbeat)
                for message in messages:
                    out.sendto(message.pack(link), ("127.0.0.1", port))
                for news in pilot.news():
                    if isinstance(news, Found):
                        return news
                time.sleep(0.1)
    finally:
        pilot.stop()
    raise AssertionError("nothing was found")


def test_it_is_known_by_its_heartbeat_however_late() -> None:
    found = first_found(1.5, common.MAV_TYPE_QUADROTOR)
    assert found == Found(1, "px4", "")


def test_what_does_not_hover_is_still_refused() -> None:
    found = first_found(0.0, common.MAV_TYPE_FIXED_WING)
    assert found.fault == "the vehicle is a fixed wing, and only a multicopter hovers"
