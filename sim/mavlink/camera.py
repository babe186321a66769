"""The vehicle's camera as a component of its own: what it is, what it holds, and pictures as it is told."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Command
from sim.mavlink import motion
from sim.mavlink.craft import AUTOPILOT, Craft, Sender
from sim.mavlink.gimbal import GIMBAL
from sim.mavlink.pack import boot_ms, boot_us
from sim.mavlink.peer import Message
from sim.mavlink.shutter import Series, Spacing

CAMERA = 100
WIDTH_PX, HEIGHT_PX = 640, 480
FOCAL_MM, SENSOR_MM = 3.0, (3.68, 2.76)
CAPACITY_MIB = 16384.0
PICTURE_MIB = 0.25
LONGEST_S, MOST_PICTURES, FARTHEST_M = 86_400.0, 10_000, 10_000.0
PICTURES, SURVEY = 0.0, 2.0
"""CAMERA_MODE; a survey is pictures as well."""
SHOOT = 1.0
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
        self._series = Series()
        self._spacing = Spacing()
        self._mode = PICTURES
        self._beat_s = -math.inf

    def step(self, now_s: float) -> None:
        """Heartbeat at 1 Hz, and the pictures that are due."""
        if self._craft.camera and now_s - self._beat_s >= 1.0:
            self._beat_s = now_s
            beat = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_CAMERA, mav.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)
            self._craft.broadcast(beat, CAMERA)
        if self._series.due(now_s):
            self._take(now_s)
        if self._spacing.every_m and self._far_enough(now_s):
            self._take(now_s)

    def _far_enough(self, now_s: float) -> bool:
        """PX4 takes what a mission asked for only as long as it flies the mission; ArduCopter goes on."""
        now, row = self._craft.autopilot.telemetry(now_s), self._craft.personality
        if self._spacing.by_mission and row.name == "px4" and row.mode(now.custom_mode) != "mission":
            return False
        return motion.usable(now) and self._spacing.due(now.estimate.position_ned_m)

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

    def wrong(self, command: Command) -> int | None:
        """Which param (1 to 7) makes no sense, 0 when all do; None for what it does not know. NaN is for any."""
        first, second, third, _ = command.params
        match command.id:
            case mav.MAV_CMD_IMAGE_START_CAPTURE:
                if not (math.isnan(second) or 0 <= second <= LONGEST_S):
                    return 2
                return 0 if math.isnan(third) or 0 <= third <= MOST_PICTURES else 3
            case mav.MAV_CMD_SET_CAMERA_MODE:
                return 0 if second in (PICTURES, SURVEY) else 2
            case mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST:
                return 0 if math.isnan(first) or -1 <= first <= FARTHEST_M else 1
            case mav.MAV_CMD_DO_DIGICAM_CONTROL | mav.MAV_CMD_IMAGE_STOP_CAPTURE:
                return 0
        return None

    def order(self, command: Command, who: tuple[int, int], now_s: float) -> Ack | None:
        """Take pictures, stop, say of what kind; the shots of the mission begin at once."""
        wrong = self.wrong(command)
        if wrong is None:
            return None
        if wrong:
            return Ack.DENIED
        first, second, third, _ = command.params
        match command.id:
            case mav.MAV_CMD_IMAGE_START_CAPTURE:
                number = 1 if math.isnan(third) else round(third)
                self._series.start(number, 0.0 if math.isnan(second) else second, now_s)
            case mav.MAV_CMD_IMAGE_STOP_CAPTURE:
                self._series.stop()
            case mav.MAV_CMD_SET_CAMERA_MODE:
                self._mode = second
            case mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST:
                self._spacing.start(0.0 if math.isnan(first) else first, who == (self._craft.sysid, AUTOPILOT))
                if first > 0 and third == 1:
                    self._take(now_s)
            case mav.MAV_CMD_DO_DIGICAM_CONTROL if command.x == SHOOT:
                self._take(now_s)
        return Ack.ACCEPTED

    def command(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        """What it is told, and the older requests that ask for one message each."""
        result = self.order(command, (sender.sysid, sender.compid), now_s)
        asked = OLDER_REQUESTS.get(command.id)
        message = None if asked is None else self.message(asked, sender, now_s)
        if message is None:
            return result
        self._craft.reply(sender, message, CAMERA)
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
            return mav.MAVLink_camera_settings_message(at_ms, int(self._mode), math.nan, math.nan, 0)
        if message_id == mav.MAVLINK_MSG_ID_STORAGE_INFORMATION:
            space = (CAPACITY_MIB, used, free, math.nan, math.nan)
            return mav.MAVLink_storage_information_message(at_ms, 1, 1, 2, *space, 0, b"memory", 0)
        if message_id == mav.MAVLINK_MSG_ID_CAMERA_CAPTURE_STATUS:
            busy, every_s = 3 if self._series.runs else 0, self._series.interval_s
            return mav.MAVLink_camera_capture_status_message(at_ms, busy, 0, every_s, 0, free, self._taken, 0)
        return None


OLDER_REQUESTS = {
    mav.MAV_CMD_REQUEST_CAMERA_INFORMATION: mav.MAVLINK_MSG_ID_CAMERA_INFORMATION,
    mav.MAV_CMD_REQUEST_CAMERA_SETTINGS: mav.MAVLINK_MSG_ID_CAMERA_SETTINGS,
    mav.MAV_CMD_REQUEST_STORAGE_INFORMATION: mav.MAVLINK_MSG_ID_STORAGE_INFORMATION,
    mav.MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS: mav.MAVLINK_MSG_ID_CAMERA_CAPTURE_STATUS,
}
