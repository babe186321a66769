"""The camera's gimbal as a component that is its own manager: pitch and yaw on command, and who is in control."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Command
from sim.flight.state import Quaternion
from sim.mavlink.craft import Craft, Sender
from sim.mavlink.pack import boot_ms
from sim.mavlink.peer import Message

GIMBAL = 154
"""MAV_COMP_ID_GIMBAL."""
PITCH_RANGE_RAD = (-math.pi / 2, math.pi / 6)
YAW_RANGE_RAD = (-math.pi, math.pi)
RATE_RADPS = math.radians(90)
REPORT_S = 0.2
CAPABILITIES = 0x2 | 0x8 | 0x20 | 0x40 | 0x100 | 0x200
"""Neutral, roll lock, pitch axis and follow, yaw axis and follow."""
SELF, NOBODY, UNCHANGED = -2.0, -3.0, -1.0
"""How CONFIGURE names who is to be in control."""

RETRACTED, NEUTRAL, ANGLES = 0.0, 1.0, 2.0
"""MAV_MOUNT_MODE; it has no place to retract to and looks ahead then."""
LEVEL_DEG = 0.1


def _reaches(angle_rad: float, range_rad: tuple[float, float]) -> bool:
    """NaN is for where it is."""
    slack = 1e-3
    return math.isnan(angle_rad) or range_rad[0] - slack <= angle_rad <= range_rad[1] + slack


class Gimbal:
    """Component 154; turns at a bounded rate towards what it was told last."""

    compid = GIMBAL

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self.pitch_rad = 0.0
        self.yaw_rad = 0.0
        """Of the body, clockwise from its nose."""
        self._to = (0.0, 0.0)
        self._control = (0, 0)
        self._last_s = 0.0
        self._beat_s = self._report_s = -math.inf

    def step(self, now_s: float) -> None:
        """Turn; heartbeat at 1 Hz and attitude at 5 Hz."""
        most = RATE_RADPS * min(max(now_s - self._last_s, 0.0), 0.5)
        self._last_s = now_s
        self.pitch_rad += min(max(self._to[0] - self.pitch_rad, -most), most)
        self.yaw_rad += min(max(self._to[1] - self.yaw_rad, -most), most)
        if not self._craft.camera:
            return
        if now_s - self._beat_s >= 1.0:
            self._beat_s = now_s
            beat = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GIMBAL, mav.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)
            self._craft.broadcast(beat, GIMBAL)
            self._craft.broadcast(self._status(now_s), GIMBAL)
        if now_s - self._report_s >= REPORT_S:
            self._report_s = now_s
            self._craft.broadcast(self._attitude(now_s), GIMBAL)

    @property
    def attitude(self) -> Quaternion:
        """Of the camera in the body's axes: yaw, then pitch."""
        cp, sp = math.cos(self.pitch_rad / 2), math.sin(self.pitch_rad / 2)
        cy, sy = math.cos(self.yaw_rad / 2), math.sin(self.yaw_rad / 2)
        return (cy * cp, -sy * sp, cy * sp, sy * cp)

    def _attitude(self, now_s: float) -> Message:
        flags = mav.GIMBAL_DEVICE_FLAGS_ROLL_LOCK | mav.GIMBAL_DEVICE_FLAGS_YAW_IN_VEHICLE_FRAME
        still = (0.0, 0.0, 0.0, 0)
        return mav.MAVLink_gimbal_device_attitude_status_message(
            0, 0, boot_ms(now_s), flags, list(self.attitude), *still
        )

    def _status(self, now_s: float) -> Message:
        return mav.MAVLink_gimbal_manager_status_message(boot_ms(now_s), 0, GIMBAL, *self._control, 0, 0)

    def turn(self, pitch_rad: float, yaw_rad: float) -> bool:
        """Turn to these angles in the body's axes, NaN for as it is; False for what is out of reach."""
        if not (_reaches(pitch_rad, PITCH_RANGE_RAD) and _reaches(yaw_rad, YAW_RANGE_RAD)):
            return False
        pitch, yaw = self._to
        self._to = (pitch if math.isnan(pitch_rad) else pitch_rad, yaw if math.isnan(yaw_rad) else yaw_rad)
        return True

    def wrong(self, command: Command) -> int | None:
        """Which param (1 to 7) makes no sense, 0 when all do; None for what it does not know."""
        first, second, third, _ = command.params
        match command.id:
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW:
                if not _reaches(math.radians(first), PITCH_RANGE_RAD):
                    return 1
                return 0 if _reaches(math.radians(second), YAW_RANGE_RAD) else 2
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE:
                if first in (SELF, NOBODY, UNCHANGED):
                    return 0
                return (0 if 0 <= second <= 255 else 2) if 0 <= first <= 255 else 1
            case mav.MAV_CMD_DO_MOUNT_CONFIGURE:
                return 0 if first in (RETRACTED, NEUTRAL, ANGLES) else 1
            case mav.MAV_CMD_DO_MOUNT_CONTROL:
                if not self._by_angles(command):
                    return 0 if command.z in (RETRACTED, NEUTRAL) else 7
                if not _reaches(math.radians(first), PITCH_RANGE_RAD):
                    return 1
                if abs(second) > LEVEL_DEG:  # it keeps level by itself and cannot be leant
                    return 2
                return 3 if math.isinf(third) else 0
        return None

    def _by_angles(self, command: Command) -> bool:
        """Whether DO_MOUNT_CONTROL gives angles: ArduCopter takes it so whatever the mode that it says."""
        return command.z == ANGLES or self._craft.personality.name == "ardupilot"

    def order(self, command: Command, who: tuple[int, int], now_s: float) -> Ack | None:
        """Turn, by the manager's command or the older ones of mounts, and say who is in control; `who` orders it."""
        wrong = self.wrong(command)
        if wrong is None:
            return None
        if wrong:
            return Ack.DENIED
        first, second, third, _ = command.params
        match command.id:
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW:
                self.turn(math.radians(first), math.radians(second))
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE:
                self._configure(first, second, who)
            case mav.MAV_CMD_DO_MOUNT_CONTROL if self._by_angles(command):
                self.turn(math.radians(first), math.remainder(math.radians(third), math.tau))
            case mav.MAV_CMD_DO_MOUNT_CONTROL:
                self.turn(0.0, 0.0)
            case mav.MAV_CMD_DO_MOUNT_CONFIGURE if first != ANGLES:
                self.turn(0.0, 0.0)
        return Ack.ACCEPTED

    def command(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        return self.order(command, (sender.sysid, sender.compid), now_s)

    def _configure(self, sysid: float, compid: float, who: tuple[int, int]) -> None:
        if sysid == SELF:
            self._control = who
        elif sysid == NOBODY:
            self._control = (0, 0)
        elif sysid != UNCHANGED:
            self._control = (int(sysid), int(compid))

    def set_attitude(self, message: Message, sender: Sender, now_s: float) -> None:
        """GIMBAL_MANAGER_SET_ATTITUDE: a quaternion in the body's axes."""
        w, x, y, z = message.q
        sine = 2 * (w * y - z * x)
        if -1.001 <= sine <= 1.001:
            yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
            self.turn(math.asin(min(max(sine, -1.0), 1.0)), yaw)

    def set_pitch_yaw(self, message: Message, sender: Sender, now_s: float) -> None:
        """GIMBAL_MANAGER_SET_PITCHYAW."""
        self.turn(message.pitch, message.yaw)

    def message(self, message_id: int, sender: Sender, now_s: float) -> Message | None:
        ranges = (0.0, 0.0, *PITCH_RANGE_RAD, *YAW_RANGE_RAD)
        if message_id == mav.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION:
            return mav.MAVLink_gimbal_manager_information_message(boot_ms(now_s), CAPABILITIES, GIMBAL, *ranges)
        if message_id == mav.MAVLINK_MSG_ID_GIMBAL_MANAGER_STATUS:
            return self._status(now_s)
        if message_id == mav.MAVLINK_MSG_ID_GIMBAL_DEVICE_INFORMATION:
            names = (b"R2X", b"Simulated gimbal", b"")
            return mav.MAVLink_gimbal_device_information_message(
                boot_ms(now_s), *names, 1, 1, self._craft.sysid, CAPABILITIES, 0, *ranges
            )
        if message_id == mav.MAVLINK_MSG_ID_GIMBAL_DEVICE_ATTITUDE_STATUS:
            return self._attitude(now_s)
        return None
