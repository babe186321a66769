"""A simulated building flies the drones of its site file: any client at their addresses can."""

import socket

import pytest
from pymavlink import mavutil

from sim.aerials import aerial_of, drone_starts, simulated
from sim.hangar import Hangar
from sim.physics import Physics
from tests.sim.small_home import make_small_home
from tests.walk.drone_mesh import free_port
from wire.bus import CannotRun
from wire.site import parse_site

GUIDED, TAKEOFF, ARM = 4, mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM


def site_with(link: str, **sim: object):
    room = {
        "id": "hall",
        "name": "hall",
        "kind": "Other",
        "polygon_m": [[0.0, 0.0], [6.0, 0.0], [6.0, 5.0], [0.0, 5.0]],
    }
    robot = {"id": "drone-1", "kind": "drone", "start_m": [1.5, 2.0], "link": link}
    rows = [
        {"id": "sim", "role": "sim", "module": "sim"},
        {"id": "drone-1", "role": "robot", "module": "devices.drone"},
    ]
    return parse_site({"name": "t", "room": [room], "robot": [robot], "process": rows, "sim": {"seed": 1, **sim}}, "t")


class Flown:
    """A house, its hangar, and time."""

    def __init__(self, link: str, **sim: object) -> None:
        site = site_with(link, **sim)
        self.physics = Physics(make_small_home(), [], drones=drone_starts(site))
        try:
            self.hangar = Hangar(site, self.physics)
        except CannotRun:
            self.physics.close()
            raise

    def run(self, span_s: float) -> None:
        for _ in range(round(span_s / 0.05)):
            self.hangar.listen()
            self.physics.advance(12)
            self.hangar.tell()

    def close(self) -> None:
        self.hangar.close()
        self.physics.close()


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_a_client_at_the_drones_address_flies_it(firmware) -> None:
    port = free_port(socket.SOCK_DGRAM)
    flown = Flown(f"udpin://127.0.0.1:{port}", firmware=firmware)
    client = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", dialect="ardupilotmega")
    try:
        flown.run(3.0)
        beat = client.recv_match(type="HEARTBEAT", blocking=True, timeout=2.0)
        assert beat.get_srcSystem() == 1
        mode = GUIDED if firmware == "ardupilot" else 4 << 16 | 3 << 24
        client.mav.set_mode_send(1, 1, mode)
        client.mav.command_long_send(1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0)
        flown.run(0.5)
        height = 1.6 if firmware == "ardupilot" else 488.0 + 1.6
        client.mav.command_long_send(1, 1, TAKEOFF, 0, 0, 0, 0, float("nan"), float("nan"), float("nan"), height)
        flown.run(8.0)
        assert flown.physics.drones["drone-1"].true_pose()[0] == pytest.approx((1.5, 2.0, 1.6), abs=0.15)
        assert flown.physics.collisions == 0
    finally:
        client.close()
        flown.close()


def test_the_barometer_and_the_fix_agree_on_the_height_above_the_sea() -> None:
    port = free_port(socket.SOCK_DGRAM)
    flown = Flown(f"udpin://127.0.0.1:{port}")
    client = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", dialect="ardupilotmega")
    try:
        flown.run(2.0)
        fix = client.recv_match(type="GPS_RAW_INT", blocking=True, timeout=2.0)
        pressure = client.recv_match(type="SCALED_PRESSURE", blocking=True, timeout=2.0)
        standard_m = 44330.0 * (1.0 - (pressure.press_abs / 1013.25) ** 0.190295)
        assert standard_m == pytest.approx(fix.alt / 1000.0, abs=10.0)
    finally:
        client.close()
        flown.close()


def test_a_ground_station_may_look_on() -> None:
    port, station = free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_DGRAM)
    flown = Flown(f"udpin://127.0.0.1:{port}", mavlink_out=[f"127.0.0.1:{station}"])
    watcher = mavutil.mavlink_connection(f"udpin:127.0.0.1:{station}", dialect="ardupilotmega")
    try:
        flown.run(2.0)
        assert watcher.recv_match(type="HEARTBEAT", blocking=True, timeout=2.0) is not None
    finally:
        watcher.close()
        flown.close()


def test_a_port_in_use_is_told_with_the_drone() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(CannotRun, match=rf"the autopilot of drone-1: TCP port {port} is in use"):
            Flown(f"tcpout://127.0.0.1:{port}")


def test_a_ground_station_on_another_machine_is_told_of_a_way() -> None:
    port = free_port(socket.SOCK_DGRAM)
    with pytest.raises(CannotRun, match=r"leaves this machine.*; send it to a MAVLink router here"):
        Flown(f"udpin://127.0.0.1:{port}", mavlink_out=["192.0.2.7:14550"])


@pytest.mark.parametrize(
    ("link", "here"),
    [
        ("udpin://127.0.0.1:14540", True),
        ("udpout://localhost:14550", True),
        ("tcpout://127.0.0.1:5760", True),
        ("tcpout://10.0.0.7:5760", False),
        ("serial:///dev/ttyUSB0:57600", False),
    ],
)
def test_only_autopilots_on_this_machine_are_simulated(link, here) -> None:
    site = site_with(link)
    assert [r.id for r in simulated(site)] == (["drone-1"] if here else [])
    assert (aerial_of(site.robot[0]) is not None) == here
