"""A whole flight by MAVSDK's asyncio API: `python mavsdk_flight.py URL`. Prints OK at the end."""

import asyncio
import json
import math
import sys
from collections.abc import AsyncIterator, Callable
from typing import Any

from mavsdk.asyncio import ComponentType, Configuration, Mavsdk
from mavsdk.asyncio.plugins.action import ActionAsync
from mavsdk.asyncio.plugins.mavlink_direct import MavlinkDirectAsync
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
        await photograph(mission, MavlinkDirectAsync(drone), home)
        await action.land()
        await until(telemetry.subscribe_armed(), lambda armed: not armed, 30, "landed and disarmed")
        print("OK")


def item(home: Any, north_deg: float, east_deg: float, pitch_deg: float = NAN, camera: str = "NONE") -> MissionItem:
    return MissionItem(
        home.latitude_deg + north_deg,
        home.longitude_deg + east_deg,
        2.0,
        1.5,
        True,
        pitch_deg,
        0.0 if math.isfinite(pitch_deg) else NAN,
        MissionItem.CameraAction[camera],
        NAN,
        0.5,
        0.3,
        NAN,
        0.5,
        MissionItem.VehicleAction.NONE,
    )


async def fly_mission(mission: MissionAsync, home: Any, ardupilot: bool) -> None:
    items = [item(home, 0.0, 0.0), item(home, 1e-5, 0.0), item(home, 1e-5, 1e-5), item(home, 0.0, 0.0)]
    await mission.upload_mission(MissionPlan(items))
    if not ardupilot:  # there item 0 is home, of a kind that MAVSDK's mission does not know
        back = await mission.download_mission()
        print("mission up and down", len(items), len(back.mission_items))
    await mission.start_mission()
    await until(mission.subscribe_mission_progress(), lambda p: p.current == p.total > 0, 60, "mission flown")
    print("mission flown")


async def photograph(mission: MissionAsync, wire: MavlinkDirectAsync, home: Any) -> None:
    """A picture of the floor ahead, pictures every half metre of way, and some by time, all ordered by the mission."""
    pictures: list[dict[str, Any]] = []

    async def gather() -> None:
        async for each in wire.subscribe_message("CAMERA_IMAGE_CAPTURED"):
            pictures.append(json.loads(each.fields_json))

    listening = asyncio.ensure_future(gather())
    down = asyncio.ensure_future(
        until(wire.subscribe_message("GIMBAL_DEVICE_ATTITUDE_STATUS"), looks(-45.0), 60, "the gimbal turned down")
    )
    items = [
        item(home, 0.0, 0.0, -45.0, "TAKE_PHOTO"),
        item(home, 1e-5, 0.0, camera="START_PHOTO_DISTANCE"),
        item(home, 3e-5, 0.0, camera="STOP_PHOTO_DISTANCE"),
        item(home, 3e-5, 1e-5, camera="START_PHOTO_INTERVAL"),
        item(home, 3e-5, 4e-5, camera="STOP_PHOTO_INTERVAL"),
    ]
    await mission.upload_mission(MissionPlan(items))
    await mission.start_mission()
    await until(mission.subscribe_mission_progress(), lambda p: p.current == p.total > 0, 60, "pictures taken")
    await down
    listening.cancel()
    norths = [(each["lat"] / 1e7 - home.latitude_deg) * 1e5 for each in pictures]
    print("pictures at", [round(north, 2) for north in norths])
    assert abs(norths[0]) < 0.5, "the first picture is not where it was to be taken"
    assert any(1.2 < north < 2.8 for north in norths), "no pictures by distance"
    assert sum(north > 2.8 for north in norths) >= 2, "no pictures by time"
    assert [each["image_index"] for each in pictures] == list(range(1, len(pictures) + 1))


def looks(pitch_deg: float) -> Callable[[Any], bool]:
    def such(message: Any) -> bool:
        w, x, y, z = json.loads(message.fields_json)["q"]
        return abs(math.degrees(math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))) - pitch_deg) < 2.0

    return such


if __name__ == "__main__":
    asyncio.run(fly(sys.argv[1]))
