"""A whole flight by MAVSDK's asyncio API: `python mavsdk_flight.py URL`. Prints OK at the end."""

import asyncio
import sys
from collections.abc import AsyncIterator, Callable
from typing import Any

from mavsdk.asyncio import ComponentType, Configuration, Mavsdk
from mavsdk.asyncio.plugins.action import ActionAsync
from mavsdk.asyncio.plugins.mission import MissionAsync, MissionItem, MissionPlan
from mavsdk.asyncio.plugins.offboard import OffboardAsync, PositionNedYaw, VelocityNedYaw
from mavsdk.asyncio.plugins.param import ParamAsync
from mavsdk.asyncio.plugins.telemetry import TelemetryAsync
from mavsdk.logging import log_subscribe

NAN = float("nan")
ARDUPILOT = 2
COURSE = [(0.0, 0.0, -2.0), (0.0, 5.0, -2.0), (5.0, 5.0, -4.0), (5.0, 0.0, -4.0), (0.0, 0.0, -2.0)]
"""PX4's own acceptance course: each within 0.3 m in 10 s."""


async def until(stream: AsyncIterator[Any], such: Callable[[Any], bool], span_s: float, what: str) -> Any:
    async def first() -> Any:
        async for each in stream:
            if such(each):
                return each
        raise RuntimeError(f"the stream ended before: {what}")

    try:
        return await asyncio.wait_for(first(), span_s)
    except TimeoutError:
        raise RuntimeError(f"not within {span_s} s: {what}") from None


def near(place: tuple[float, float, float], slack_m: float) -> Callable[[Any], bool]:
    def such(at: Any) -> bool:
        p = at.position
        return sum((a - b) ** 2 for a, b in zip((p.north_m, p.east_m, p.down_m), place, strict=True)) < slack_m**2

    return such


async def fly(url: str) -> None:
    log_subscribe(lambda *_: True)
    async with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        await sdk.add_any_connection(url)
        drone = await sdk.first_autopilot(timeout_s=10)
        if drone is None:
            raise RuntimeError("no autopilot within 10 s")
        action, telemetry, offboard = ActionAsync(drone), TelemetryAsync(drone), OffboardAsync(drone)
        params, mission = ParamAsync(drone), MissionAsync(drone)
        health = await until(telemetry.subscribe_health(), lambda h: h.is_armable, 15, "armable")
        print("health", health)
        everything = await params.get_all_params()
        print("parameters", len(everything.int_params), len(everything.float_params))
        await params.set_param_float("SIM_BAT_DRAIN", 0.0)
        await action.set_takeoff_altitude(2.0)
        await action.set_return_to_launch_altitude(2.0)
        assert abs(await action.get_return_to_launch_altitude() - 2.0) < 1e-3
        await action.arm()
        await action.takeoff()
        await until(telemetry.subscribe_position_velocity_ned(), lambda p: p.position.down_m < -1.8, 10, "up")
        home = await until(telemetry.subscribe_home(), lambda h: True, 10, "home")
        await action.goto_location(home.latitude_deg + 2e-5, home.longitude_deg, home.absolute_altitude_m + 2.0, 0.0)
        await until(telemetry.subscribe_position_velocity_ned(), lambda p: p.position.north_m > 1.9, 15, "went to")
        print("gone to a place")
        await offboard.set_position_ned(PositionNedYaw(*COURSE[0], 0.0))
        await offboard.start()
        for place in COURSE:
            await offboard.set_position_ned(PositionNedYaw(*place, 0.0))
            await until(telemetry.subscribe_position_velocity_ned(), near(place, 0.3), 10, f"at {place}")
        print("course flown")
        await offboard.set_velocity_ned(VelocityNedYaw(1.0, 0.0, 0.0, 90.0))
        await until(telemetry.subscribe_position_velocity_ned(), lambda p: p.velocity.north_m_s > 0.9, 5, "1 m/s")
        await offboard.stop()
        await fly_mission(mission, home, (await drone.autopilot_type()) == ARDUPILOT)
        await action.land()
        await until(telemetry.subscribe_armed(), lambda armed: not armed, 30, "landed and disarmed")
        print("OK")


async def fly_mission(mission: MissionAsync, home: Any, ardupilot: bool) -> None:
    def item(north: float, east: float) -> MissionItem:
        return MissionItem(
            home.latitude_deg + north,
            home.longitude_deg + east,
            2.0,
            1.5,
            True,
            NAN,
            NAN,
            MissionItem.CameraAction.NONE,
            NAN,
            NAN,
            0.3,
            NAN,
            NAN,
            MissionItem.VehicleAction.NONE,
        )

    items = [item(0.0, 0.0), item(1e-5, 0.0), item(1e-5, 1e-5), item(0.0, 0.0)]
    await mission.upload_mission(MissionPlan(items))
    if not ardupilot:  # there item 0 is home, of a kind that MAVSDK's mission does not know
        back = await mission.download_mission()
        print("mission up and down", len(items), len(back.mission_items))
    await mission.start_mission()
    await until(mission.subscribe_mission_progress(), lambda p: p.current == p.total > 0, 60, "mission flown")
    print("mission flown")


if __name__ == "__main__":
    asyncio.run(fly(sys.argv[1]))
