"""A flight by dronekit (ArduPilot only): `python dronekit_flight.py URL`, as tcp:HOST:PORT. Prints OK at the end.

Needs dronekit 2.9.2 in the interpreter that runs it; the two names it takes from `collections` moved in Python 3.10.
"""

import collections
import collections.abc
import sys
import time
from collections.abc import Callable

collections.MutableMapping = collections.abc.MutableMapping
collections.Callable = collections.abc.Callable

import dronekit  # noqa: E402 - after the names that it needs are back


def until(such: Callable[[], bool], span_s: float, what: str) -> None:
    end_s = time.monotonic() + span_s
    while not such():
        if time.monotonic() > end_s:
            raise RuntimeError(f"not within {span_s} s: {what}")
        time.sleep(0.1)


def fly(url: str) -> None:
    vehicle = dronekit.connect(url, wait_ready=True, timeout=30)
    print("connected", vehicle.version, len(vehicle.parameters))
    until(lambda: vehicle.is_armable, 20, "armable")
    vehicle.mode = dronekit.VehicleMode("GUIDED")
    until(lambda: vehicle.mode.name == "GUIDED", 5, "guided")
    vehicle.armed = True
    until(lambda: vehicle.armed, 5, "armed")
    vehicle.simple_takeoff(2.0)
    until(lambda: vehicle.location.global_relative_frame.alt > 1.8, 15, "at 2 m")
    here = vehicle.location.global_relative_frame
    vehicle.simple_goto(dronekit.LocationGlobalRelative(here.lat + 3e-5, here.lon, 2.0))
    until(lambda: vehicle.location.local_frame.north > 2.5, 20, "3 m to the north")
    print("gone to a place")
    commands = vehicle.commands
    commands.download()
    commands.wait_ready()
    commands.clear()
    for north in (0.0, 1e-5, 2e-5):
        place = (here.lat + north, here.lon, 2.0)
        commands.add(dronekit.Command(0, 0, 0, 3, 16, 0, 1, 0, 0.3, 0, 0, *place))
    commands.upload()
    commands.download()
    commands.wait_ready()
    if commands.count != 3:
        raise RuntimeError(f"{commands.count} items came back of 3")
    vehicle.mode = dronekit.VehicleMode("AUTO")
    until(lambda: commands.next == 3, 40, "at the last item")
    print("mission flown")
    vehicle.parameters["SIM_BAT_DRAIN"] = 0
    vehicle.mode = dronekit.VehicleMode("LAND")
    until(lambda: not vehicle.armed, 40, "landed and disarmed")
    vehicle.close()
    print("OK")


if __name__ == "__main__":
    fly(sys.argv[1])
