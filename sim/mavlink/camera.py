"""The vehicle's camera as a component of its own: what it is, what it holds, and pictures on command."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Command
from sim.mavlink import motion
from sim.mavlink.craft import Craft, Sender
from sim.mavlink.gimbal import GIMBAL
from sim.mavlink.pack import boot_ms, boot_us
from sim.mavlink.peer import Message

CAMERA = 100
WIDTH_PX, HEIGHT_PX = 640, 480
FOCAL_MM, SENSOR_MM = 3.0, (3.68, 2.76)
CAPACITY_MIB = 16384.0
PICTURE_MIB = 0.25
LEAST_INTERVAL_S = 0.1
FLAGS = 2
"""CAMERA_CAP_FLAGS_CAPTURE_IMAGE."""


def _padded(text: str, length: int) -> bytes:
    return text.encode("ascii")[:length]


class Camera:
    """Component 100: heartbeats, answers, and takes pictures through `Craft.capture`."""

    compid = CAMERA

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self._taken = 0
        self._left = 0
        """Pictures still to be taken; -1 without end."""
        self._interval_s = 0.0
        self._next_s = math.inf
        self._beat_s = -math.inf

    def step(self, now_s: float) -> None:
        """Heartbeat at 1 Hz and the next picture of a series."""
        if now_s - self._beat_s >= 1.0:
            self._beat_s = now_s
            beat = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_CAMERA, mav.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)
            self._craft.broadcast(beat, CAMERA)
        if now_s >= self._next_s:
            self._left -= self._left > 0
            self._next_s = now_s + self._interval_s if self._left else math.inf
            self._take(now_s)

    def _take(self, now_s: float) -> None:
        good = self._craft.capture()
        self._taken += good
        now = self._craft.autopilot.telemetry(now_s)
        sound = motion.usable(now)
        where = motion.place(now.origin, now.estimate.position_ned_m) if now.origin and sound else (0, 0, 0)
        height_mm = round(motion.above_home_m(now) * 1000) if sound else 0
        q = list(now.estimate.attitude) if sound else [1.0, 0.0, 0.0, 0.0]
        times = (boot_ms(now_s), boot_us(self._craft.unix_s + now_s))
        captured = mav.MAVLink_camera_image_captured_message(
            *times, 0, *where, min(max(height_mm, -(2**31)), 2**31 - 1), q, self._taken, 1 if good else 0, b""
        )
        self._craft.broadcast(captured, CAMERA)

    def command(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        """Take pictures, stop, and the older requests that ask for one message each."""
        if command.id == mav.MAV_CMD_IMAGE_START_CAPTURE:
            return self._start(command.params[1], command.params[2], now_s)
        if command.id == mav.MAV_CMD_IMAGE_STOP_CAPTURE:
            self._left, self._next_s = 0, math.inf
            return Ack.ACCEPTED
        if command.id == mav.MAV_CMD_SET_CAMERA_MODE:
            return Ack.ACCEPTED if command.params[1] == 0 else Ack.DENIED
        asked = OLDER_REQUESTS.get(command.id)
        message = None if asked is None else self.message(asked, sender, now_s)
        if message is None:
            return None
        self._craft.reply(sender, message, CAMERA)
        return Ack.ACCEPTED

    def _start(self, interval_s: float, number: float, now_s: float) -> Ack:
        """`number` of pictures, 0 for without end; NaN is what a client sends for what it does not care about."""
        wanted = 1.0 if math.isnan(number) else number
        every_s = 0.0 if math.isnan(interval_s) else interval_s
        if not (0 <= wanted <= 10_000 and 0 <= every_s <= 86_400):
            return Ack.DENIED
        self._left = round(wanted) or -1
        self._interval_s = max(every_s, LEAST_INTERVAL_S)
        self._next_s = now_s
        return Ack.ACCEPTED

    def message(self, message_id: int, sender: Sender, now_s: float) -> Message | None:
        at_ms = boot_ms(now_s)
        used = self._taken * PICTURE_MIB
        free = max(CAPACITY_MIB - used, 0.0)
        if message_id == mav.MAVLINK_MSG_ID_CAMERA_INFORMATION:
            vendor, model = (list(_padded(text, 32).ljust(32, b"\0")) for text in ("R2X", "Simulated camera"))
            size = (*SENSOR_MM, WIDTH_PX, HEIGHT_PX)
            return mav.MAVLink_camera_information_message(
                at_ms, vendor, model, 1, FOCAL_MM, *size, 0, FLAGS, 0, b"", GIMBAL, 0
            )
        if message_id == mav.MAVLINK_MSG_ID_CAMERA_SETTINGS:
            return mav.MAVLink_camera_settings_message(at_ms, 0, math.nan, math.nan, 0)
        if message_id == mav.MAVLINK_MSG_ID_STORAGE_INFORMATION:
            space = (CAPACITY_MIB, used, free, math.nan, math.nan)
            return mav.MAVLink_storage_information_message(at_ms, 1, 1, 2, *space, 0, b"memory", 0)
        if message_id == mav.MAVLINK_MSG_ID_CAMERA_CAPTURE_STATUS:
            busy = 0 if math.isinf(self._next_s) else 3
            return mav.MAVLink_camera_capture_status_message(at_ms, busy, 0, self._interval_s, 0, free, self._taken, 0)
        return None


OLDER_REQUESTS = {
    mav.MAV_CMD_REQUEST_CAMERA_INFORMATION: mav.MAVLINK_MSG_ID_CAMERA_INFORMATION,
    mav.MAV_CMD_REQUEST_CAMERA_SETTINGS: mav.MAVLINK_MSG_ID_CAMERA_SETTINGS,
    mav.MAV_CMD_REQUEST_STORAGE_INFORMATION: mav.MAVLINK_MSG_ID_STORAGE_INFORMATION,
    mav.MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS: mav.MAVLINK_MSG_ID_CAMERA_CAPTURE_STATUS,
}
