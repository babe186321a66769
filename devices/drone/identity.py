"""What is at the other end of the link, in MAVSDK's words."""

import asyncio
from typing import Protocol

from mavsdk.asyncio import Autopilot
from mavsdk.asyncio import Vehicle as VehicleType

from devices.drone.pilot import Firmware

PATIENCE_S, LOOK_S = 3.0, 0.02
"""An autopilot of no known family is one all the same: for how long to look, and how often."""
_FIRMWARE: dict[int, Firmware] = {Autopilot.PX4: "px4", Autopilot.ARDUPILOT: "ardupilot"}


class Identified(Protocol):
    """The part of `mavsdk.asyncio.System` that says what it is."""

    async def autopilot_type(self) -> Autopilot:
        """UNKNOWN until MAVSDK has read a heartbeat."""

    async def vehicle_type(self) -> VehicleType:
        """GENERIC until then."""


async def identify(system: Identified) -> tuple[Firmware, VehicleType]:
    """MAVSDK shows a system before it has read the heartbeat that says what it is, and then reads it bit by bit."""
    deadline_s = asyncio.get_running_loop().time() + PATIENCE_S
    while True:
        autopilot, kind = await system.autopilot_type(), await system.vehicle_type()
        known = autopilot != Autopilot.UNKNOWN and kind not in (VehicleType.UNKNOWN, VehicleType.GENERIC)
        if known or asyncio.get_running_loop().time() > deadline_s:
            return _FIRMWARE.get(int(autopilot), "unknown"), kind
        await asyncio.sleep(LOOK_S)
