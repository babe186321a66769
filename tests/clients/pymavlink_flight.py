"""A whole flight by pymavlink alone: `python pymavlink_flight.py URL`, as tcp:HOST:PORT or udpin:HOST:PORT. Prints OK."""

import os
import sys
import time
from collections.abc import Callable
from typing import Any

os.environ["MAVLINK20"] = "1"  # read by pymavlink when it is imported
from pymavlink import mavutil

mav = mavutil.mavlink
NAN = float("nan")


class Station:
    """One connection; every wait has an end."""

    def __init__(self, url: str) -> None:
        self.link = mavutil.mavlink_connection(url, source_system=250)
        beat = self.wait("HEARTBEAT", lambda m: m.get_srcComponent() == 1)
        self.link.target_system, self.link.target_component = 1, 1
        self.px4 = beat.autopilot == mav.MAV_AUTOPILOT_PX4

    def wait(self, name: str, such: Callable[[Any], bool] = lambda message: True, span_s: float = 20.0) -> Any:
        until_s = time.monotonic() + span_s
        while time.monotonic() < until_s:
            message = self.link.recv_match(type=name, blocking=True, timeout=0.5)
            self.link.mav.heartbeat_send(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 4)
            if message is not None and such(message):
                return message
        raise RuntimeError(f"no such {name} within {span_s} s")

    def command(self, command: int, *params: float) -> None:
        self.link.mav.command_long_send(1, 1, command, 0, *params, *(0.0,) * (7 - len(params)))
        ack = self.wait("COMMAND_ACK", lambda m: m.command == command, 3.0)
        if ack.result not in (mav.MAV_RESULT_ACCEPTED, mav.MAV_RESULT_IN_PROGRESS):
            raise RuntimeError(f"command {command}: result {ack.result}")

    def mode(self, ardupilot: int, main: int, sub: int = 0) -> None:
        self.command(mav.MAV_CMD_DO_SET_MODE, 1, *((main, sub) if self.px4 else (ardupilot,)))

    def parameters(self) -> dict[str, float]:
        self.link.mav.param_request_list_send(1, 1)
        out: dict[str, float] = {}
        while True:
            value = self.wait("PARAM_VALUE", span_s=3.0)
            out[value.param_id] = value.param_value
            if len(out) == value.param_count:
                return out

    def upload(self, places: list[tuple[float, float, float]]) -> None:
        self.link.mav.mission_count_send(1, 1, len(places), 0)
        for _ in places:
            asked = self.wait(["MISSION_REQUEST", "MISSION_REQUEST_INT"], span_s=3.0)
            x, y, z = places[asked.seq]
            where = (round(x * 1e7), round(y * 1e7), z)
            self.link.mav.mission_item_int_send(1, 1, asked.seq, 6, 16, 0, 1, 0, 0.3, 0, NAN, *where, 0)
        if self.wait("MISSION_ACK", span_s=3.0).type != 0:
            raise RuntimeError("the mission was refused")

    def hold_at(self, place: tuple[float, float, float], span_s: float) -> None:
        """Setpoints at 20 Hz until there."""
        until_s = time.monotonic() + span_s
        while time.monotonic() < until_s:
            self.link.mav.set_position_target_local_ned_send(0, 1, 1, 1, 0x9F8, *place, 0, 0, 0, 0, 0, 0, 0, 0)
            at = self.wait("LOCAL_POSITION_NED", span_s=1.0)
            if sum((a - b) ** 2 for a, b in zip((at.x, at.y, at.z), place, strict=True)) < 0.2**2:
                return
        raise RuntimeError(f"not at {place} within {span_s} s")


def fly(url: str) -> None:
    station = Station(url)
    station.wait("SYS_STATUS", lambda m: bool(m.onboard_control_sensors_health & 0x10000000))
    print("parameters", len(station.parameters()))
    if not station.px4:
        station.mode(4, 0)
    station.command(mav.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    height = NAN if station.px4 else 1.5
    station.command(mav.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, NAN, NAN, NAN, height)
    station.wait("LOCAL_POSITION_NED", lambda m: m.z < -1.0)
    home = station.wait("GLOBAL_POSITION_INT")
    lat, lon = home.lat / 1e7, home.lon / 1e7
    for _ in range(10):
        station.link.mav.set_position_target_local_ned_send(0, 1, 1, 1, 0x9F8, 0, 0, -1.5, 0, 0, 0, 0, 0, 0, 0, 0)
        station.wait("LOCAL_POSITION_NED")
    station.mode(4, 6)
    for place in ((2.0, 0.0, -1.5), (2.0, 2.0, -2.0), (0.0, 0.0, -1.5)):
        station.hold_at(place, 10.0)
    print("offboard flown")
    station.upload([(lat, lon, 1.5), (lat + 1e-5, lon, 1.5), (lat, lon + 1e-5, 1.5)])
    station.mode(3, 4, 4)
    station.wait("MISSION_ITEM_REACHED", lambda m: m.seq == 2, 40.0)
    print("mission flown")
    station.mode(6, 4, 5)
    station.wait("EXTENDED_SYS_STATE", lambda m: m.landed_state == mav.MAV_LANDED_STATE_ON_GROUND, 60.0)
    station.wait("HEARTBEAT", lambda m: m.get_srcComponent() == 1 and not m.base_mode & 128, 20.0)
    print("OK")


if __name__ == "__main__":
    fly(sys.argv[1])
