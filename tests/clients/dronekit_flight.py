"""A flight by dronekit: `python dronekit_flight.py ADDRESS FIRMWARE`. Prints OK at the end.

dronekit holds no PX4 for armable, so that one is only connected to and read.
"""

import collections
import collections.abc
import sys
import time
from collections.abc import Callable

collections.MutableMapping = collections.abc.MutableMapping  # which dronekit still takes from where it once was

from dronekit import Command, LocationGlobalRelative, Vehicle, VehicleMode, connect  # noqa: E402
from pymavlink import mavutil  # noqa: E402

NORTH_DEG = 1.35e-5
"""1.5 m."""
RELATIVE = mavutil.mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT


def until(such: Callable[[], bool], span_s: float, what: str) -> None:
    deadline = time.monotonic() + span_s
    while not such():
        if time.monotonic() > deadline:
            raise RuntimeError(f"not within {span_s} s: {what}")
        time.sleep(0.1)
    print(what)


def up(vehicle: Vehicle, height_m: float) -> None:
    until(lambda: vehicle.is_armable, 15, "armable")
    vehicle.mode = VehicleMode("GUIDED")
    until(lambda: vehicle.mode.name == "GUIDED", 5, "guided")
    vehicle.armed = True
    until(lambda: vehicle.armed, 5, "armed")
    vehicle.simple_takeoff(height_m)
    until(lambda: vehicle.location.global_relative_frame.alt > 0.9 * height_m, 10, "up")


def home_by(vehicle: Vehicle, mode: str) -> None:
    vehicle.mode = VehicleMode(mode)
    until(lambda: vehicle.mode.name == mode, 5, mode)
    until(lambda: not vehicle.armed, 20, "landed and disarmed")


def set_parameter(vehicle: Vehicle, name: str, value: float) -> None:
    vehicle.parameters[name] = value
    until(lambda: abs(vehicle.parameters[name] - value) < 1e-4, 5, f"{name} is {value}")


def upload(vehicle: Vehicle, latitude_deg: float, longitude_deg: float) -> None:
    commands = vehicle.commands
    commands.clear()
    for command, north_deg, height_m in (
        (mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0.0, 1.2),
        (mavutil.mavlink.MAV_CMD_NAV_WAYPOINT, NORTH_DEG, 1.2),
        (mavutil.mavlink.MAV_CMD_NAV_LAND, NORTH_DEG, 0.0),
    ):
        place = (latitude_deg + north_deg, longitude_deg, height_m)
        commands.add(Command(0, 0, 0, RELATIVE, command, 0, 1, 0, 0, 0, 0, *place))
    commands.upload()
    commands.download()
    commands.wait_ready()
    got = [(each.command, round(each.z, 2)) for each in commands]
    if got != [(22, 1.2), (16, 1.2), (21, 0.0)]:
        raise RuntimeError(f"a mission came back as {got}")
    print("mission up and down")


def fly(vehicle: Vehicle) -> None:
    up(vehicle, 1.2)
    home = vehicle.location.global_relative_frame
    goal = LocationGlobalRelative(home.lat + NORTH_DEG, home.lon, 1.2)
    vehicle.simple_goto(goal, groundspeed=1.0)
    until(lambda: abs(vehicle.location.local_frame.north - 1.5) < 0.2, 10, "gone to a place")
    set_parameter(vehicle, "RTL_ALT", 100)
    home_by(vehicle, "RTL")
    until(lambda: abs(vehicle.location.local_frame.north) < 0.3, 5, "at home")
    upload(vehicle, home.lat, home.lon)
    vehicle.mode = VehicleMode("GUIDED")
    until(lambda: vehicle.mode.name == "GUIDED", 5, "guided again")
    vehicle.armed = True
    until(lambda: vehicle.armed, 5, "armed again")
    vehicle.mode = VehicleMode("AUTO")
    until(lambda: vehicle.commands.next >= 2, 15, "on its way")
    until(lambda: not vehicle.armed, 20, "the mission is flown")
    until(lambda: abs(vehicle.location.local_frame.north - 1.5) < 0.3, 5, "where it leads")


def main(address: str, firmware: str) -> None:
    vehicle = connect(address, wait_ready=True, timeout=30)
    try:
        print(vehicle.version, vehicle.mode, vehicle.system_status, vehicle.battery, vehicle.gps_0)
        if firmware == "ardupilot":
            fly(vehicle)
        else:
            set_parameter(vehicle, "MIS_TAKEOFF_ALT", 1.25)
    finally:
        vehicle.close()
    print("OK")


if __name__ == "__main__":
    main(*sys.argv[1:])
