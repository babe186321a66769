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
        pitch = self._to[0] if math.isnan(pitch_rad) else pitch_rad
        yaw = self._to[1] if math.isnan(yaw_rad) else yaw_rad
        slack = 1e-3
        for angle, (least, most) in ((pitch, PITCH_RANGE_RAD), (yaw, YAW_RANGE_RAD)):
            if not least - slack <= angle <= most + slack:
                return False
        self._to = (pitch, yaw)
        return True

    def command(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        if command.id == mav.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW:
            pitch_deg, yaw_deg = command.params[:2]
            return Ack.ACCEPTED if self.turn(math.radians(pitch_deg), math.radians(yaw_deg)) else Ack.DENIED
        if command.id == mav.MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE:
            return self._configure(command.params[0], command.params[1], sender)
        return None

    def _configure(self, sysid: float, compid: float, sender: Sender) -> Ack:
        if sysid == SELF:
            self._control = (sender.sysid, sender.compid)
        elif sysid == NOBODY:
            self._control = (0, 0)
        elif sysid != UNCHANGED:
            if not (0 <= sysid <= 255 and 0 <= compid <= 255):
                return Ack.DENIED
            self._control = (int(sysid), int(compid))
        return Ack.ACCEPTED

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
