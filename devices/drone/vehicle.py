"""One autopilot through MAVSDK's plugins: its streams become telemetry, orders become calls.

Runs in the client's loop. An order that MAVSDK refuses is answered with its reason, never raised.
"""

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine
from math import isfinite
from typing import Any

from mavsdk.asyncio import MavsdkError, System
from mavsdk.asyncio import Vehicle as VehicleType
from mavsdk.asyncio.plugins.action import ActionAsync
from mavsdk.asyncio.plugins.camera import CameraAsync
from mavsdk.asyncio.plugins.mavlink_direct import MavlinkDirectAsync, MavlinkMessage
from mavsdk.asyncio.plugins.offboard import OffboardAsync, PositionNedYaw, VelocityNedYaw
from mavsdk.asyncio.plugins.telemetry import StatusTextType, TelemetryAsync

from devices.drone.frame import LocalFrame
from devices.drone.identity import identify
from devices.drone.pilot import (
    Arm,
    Disarm,
    Firmware,
    Found,
    Hover,
    Land,
    Landed,
    News,
    Order,
    Pictured,
    Said,
    Setpoint,
    Shoot,
    Steer,
    TakeOff,
    Telemetry,
)
from wire.model import Vec3

STREAM_HZ = 20.0
STALE_S = 1.0
"""A position older than this is none."""
CORE_SILENT_S = 0.5
"""Without a newer setpoint for this long the velocity is no longer fed forward."""
CAMERA_S = 3.0
"""A camera introduces itself after its heartbeat, which comes every second."""
DO_SET_MODE, ARM_DISARM = 176, 400
CUSTOM_MODE, GUIDED = 1.0, 4.0
ACKS = {0: "", 1: "rejected for now", 2: "denied", 3: "unsupported", 4: "failed", 6: "cancelled"}
"""MAV_RESULT."""
_LANDED: tuple[Landed, ...] = ("unknown", "on_ground", "in_air", "taking_off", "landing")


class Vehicle:
    """Build it as soon as the system is known: plugins hear only what comes after they were made."""

    def __init__(self, system: System, frame: LocalFrame, tell: Callable[[News], None]) -> None:
        self._system, self._frame, self._tell = system, frame, tell
        self._action, self._telemetry = ActionAsync(system), TelemetryAsync(system)
        self._offboard, self._camera = OffboardAsync(system), CameraAsync(system)
        self._direct = MavlinkDirectAsync(system)
        self._firmware: Firmware = "unknown"
        self._located_s = self.heard_s = asyncio.get_running_loop().time()
        self._position: Vec3 | None = None
        self._velocity: Vec3 = (0.0, 0.0, 0.0)
        self._yaw_rad, self._mode, self._landed = 0.0, "UNKNOWN", 0
        self._armed: bool | None = None
        self._battery: float | None = None
        self._battery_left_s: float | None = None
        self._health_ok = self._armable = False
        self._cameras: list[int] = []
        self._has_camera = asyncio.Event()
        self._wanted: Setpoint | None = None
        self._fresh = asyncio.Event()

    async def prepare(self, height_m: float) -> Found:
        """Who it is, and the settings without which it would behave as outdoors."""
        self._firmware, kind = await identify(self._system)
        body = _in_words(kind.name)
        fault = "" if kind == VehicleType.MULTICOPTER else f"the vehicle is a {body}, and only a multicopter hovers"
        for what, urgent, setting in (
            ("the rate of its positions", False, self._telemetry.set_rate_position_velocity_ned(STREAM_HZ)),
            ("the rate of its attitude", False, self._telemetry.set_rate_attitude_euler(STREAM_HZ)),
            ("its take-off height", True, self._action.set_takeoff_altitude(height_m)),
            ("its return height", True, self._action.set_return_to_launch_altitude(height_m)),
        ):
            if reason := await _reason(setting):
                self._tell(Said(f"{what} could not be set: {reason}", urgent))
        return Found(await self._system.get_system_id(), self._firmware, fault)

    def streams(self) -> list[Coroutine[Any, Any, None]]:
        """Run all of these for as long as the autopilot is wanted."""
        telemetry, camera = self._telemetry, self._camera
        return [
            self._each(telemetry.subscribe_position_velocity_ned(), self._on_position),
            self._each(telemetry.subscribe_attitude_euler(), self._on_attitude),
            self._each(telemetry.subscribe_health(), self._on_health),
            self._each(telemetry.subscribe_armed(), self._on_armed),
            self._each(telemetry.subscribe_flight_mode(), self._on_mode),
            self._each(telemetry.subscribe_landed_state(), self._on_landed),
            self._each(telemetry.subscribe_battery(), self._on_battery),
            self._each(telemetry.subscribe_status_text(), self._on_text),
            self._each(camera.subscribe_camera_list(), self._on_cameras),
            self._each(camera.subscribe_capture_info(), self._on_capture),
            self._send_setpoints(),
        ]

    # Orders

    async def obey(self, order: Order) -> str:
        """Carry an order out as far as the autopilot's answer; why it was refused, or empty."""
        match order:
            case Arm():
                return await self._arm()
            case Disarm():
                return await _reason(self._action.disarm())
            case TakeOff():
                setting = await _reason(self._action.set_takeoff_altitude(order.height_m))
                return setting or await _reason(self._action.takeoff())
            case Land():
                self._wanted = None
                return await _reason(self._action.land())
            case Steer():
                return await self._steer(order.setpoint)
            case Hover():
                return await self._hover(order.setpoint)
            case Shoot():
                return await self._shoot()

    def fly(self, setpoint: Setpoint) -> None:
        if self._wanted is not None:
            self._wanted = setpoint
            self._fresh.set()

    async def _arm(self) -> str:
        """ArduCopter does not arm in the mode in which it has landed, and MAVSDK would put it into BRAKE, in which it
        does not arm either: so GUIDED first, and the arming without MAVSDK's own ideas."""
        if self._firmware != "ardupilot":
            return await _reason(self._action.arm())
        await self._command(DO_SET_MODE, CUSTOM_MODE, GUIDED)  # refused, it is armed or not in the mode in which it is
        return await self._command(ARM_DISARM, 1.0)

    async def _command(self, command: int, param1: float, param2: float = 0.0) -> str:
        """A MAVLink command for which MAVSDK has no call: why it was refused, or empty."""
        system = await self._system.get_system_id()
        fields = {"target_system": system, "target_component": 1, "command": command, "confirmation": 0}
        fields |= {"param1": param1, "param2": param2} | {f"param{i}": 0.0 for i in range(3, 8)}
        message = MavlinkMessage("COMMAND_LONG", 0, 0, system, 1, json.dumps(fields))
        try:
            answer = json.loads((await self._direct.send_command(message)).fields_json)
        except MavsdkError as error:
            return _words(error)
        result = answer.get("result")
        return ACKS.get(result, f"MAV_RESULT {result}")

    async def _steer(self, setpoint: Setpoint) -> str:
        self._wanted = setpoint
        reason = await self._send(setpoint) or await _reason(self._offboard.start())
        if reason:
            self._wanted = None
        return reason

    async def _hover(self, setpoint: Setpoint) -> str:
        """PX4 holds by itself. ArduCopter stays in GUIDED at its last target: in LOITER it takes its height from the
        sticks of a remote control, and MAVSDK's hold is BRAKE, which stops it anywhere."""
        self._wanted = None
        if self._firmware == "px4":
            return await _reason(self._action.hold())
        return await self._send(setpoint) or await _reason(self._offboard.start())

    async def _shoot(self) -> str:
        try:
            await asyncio.wait_for(self._has_camera.wait(), CAMERA_S)
        except TimeoutError:
            return "the vehicle has no camera on its link"
        return await _reason(self._camera.take_photo(self._cameras[0]))

    async def _send_setpoints(self) -> None:
        while True:
            try:
                await asyncio.wait_for(self._fresh.wait(), CORE_SILENT_S)
            except TimeoutError:
                if self._wanted is not None:
                    await self._send(self._wanted, standing=True)
                continue
            self._fresh.clear()
            if self._wanted is not None:
                await self._send(self._wanted)

    async def _send(self, setpoint: Setpoint, standing: bool = False) -> str:
        """MAVSDK repeats it by itself, 20 times a second."""
        heading_deg = self._frame.heading_deg(setpoint.yaw_rad)
        position = PositionNedYaw(*self._frame.local(setpoint.position_enu_m), heading_deg)
        velocity_ned = self._frame.local_vector(setpoint.velocity_enu_mps)
        if standing or not any(velocity_ned):
            return await _reason(self._offboard.set_position_ned(position))
        velocity = VelocityNedYaw(*velocity_ned, heading_deg)
        return await _reason(self._offboard.set_position_velocity_ned(position, velocity))

    # Streams

    async def _each(self, stream: AsyncIterator[Any], take: Callable[[Any], None]) -> None:
        async for value in stream:
            take(value)

    def _on_position(self, value: Any) -> None:
        position, velocity = value.position, value.velocity
        ned = (position.north_m, position.east_m, position.down_m)
        speed = (velocity.north_m_s, velocity.east_m_s, velocity.down_m_s)
        if not all(map(isfinite, (*ned, *speed))):
            return
        self._position, self._velocity = self._frame.point(ned), self._frame.vector(speed)
        self._located_s = asyncio.get_running_loop().time()
        self._tell_all()

    def _on_attitude(self, value: Any) -> None:
        self.heard_s = asyncio.get_running_loop().time()
        if isfinite(value.yaw_deg):
            self._yaw_rad = self._frame.yaw_rad(value.yaw_deg)

    def _on_health(self, value: Any) -> None:
        """Comes with every heartbeat, whatever else fails."""
        self._health_ok, self._armable = value.is_local_position_ok, value.is_armable
        self._tell_all()

    def _on_armed(self, armed: bool) -> None:
        self._armed = armed

    def _on_mode(self, mode: Any) -> None:
        self._mode = mode.name

    def _on_landed(self, state: Any) -> None:
        self._landed = int(state)

    def _on_battery(self, value: Any) -> None:
        """MAVSDK gives percent, and NaN or a negative number where the autopilot does not know."""
        percent = value.remaining_percent
        if isfinite(percent) and percent >= 0.0:
            self._battery = min(1.0, percent / 100.0)
        left_s = value.time_remaining_s
        self._battery_left_s = left_s if isfinite(left_s) and left_s > 0.0 else None

    def _on_text(self, text: Any) -> None:
        self._tell(Said(text.text, text.type >= StatusTextType.WARNING))

    def _on_cameras(self, value: Any) -> None:
        self._cameras = sorted(camera.component_id for camera in value.cameras)
        if self._cameras:
            self._has_camera.set()
        else:
            self._has_camera.clear()

    def _on_capture(self, value: Any) -> None:
        self._tell(Pictured(max(0, value.index), value.is_success))

    def _tell_all(self) -> None:
        self.heard_s = asyncio.get_running_loop().time()
        if self._armed is None:
            return  # the first heartbeat says whether it may be in the air
        known = self.heard_s - self._located_s < STALE_S
        self._tell(
            Telemetry(
                self._position if known else None,
                self._velocity,
                self._yaw_rad,
                self._armed,
                _LANDED[self._landed],
                self._mode,
                self._battery,
                known and self._health_ok,
                self._armable,
                self._battery_left_s,
            )
        )


async def _reason(call: Awaitable[Any]) -> str:
    """Why MAVSDK could not do it; empty when it has."""
    try:
        await call
    except MavsdkError as error:
        return _words(error)
    return ""


def _words(error: MavsdkError) -> str:
    result = getattr(error, "result", None)
    return _in_words(str(getattr(result, "name", result) or error))


def _in_words(name: str) -> str:
    """A name of MAVSDK's enumerations in a sentence."""
    return name.lower().replace("_", " ")
