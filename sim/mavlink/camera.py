"""The vehicle's camera as a component of its own: what it is, what it holds, pictures and zoom as it is told."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Command
from sim.mavlink import motion
from sim.mavlink.craft import AUTOPILOT, Craft, Sender
from sim.mavlink.gimbal import GIMBAL
from sim.mavlink.pack import boot_ms, boot_us
from sim.mavlink.peer import Message
from sim.mavlink.shutter import Series, Spacing
from sim.mavlink.zoom import SENSOR_MM, WIDEST_MM, ZOOM_KINDS, Zoom

CAMERA = 100
WIDTH_PX, HEIGHT_PX = 640, 480
CAPACITY_MIB = 16384.0
PICTURE_MIB = 0.25
LONGEST_S, MOST_PICTURES, FARTHEST_M = 86_400.0, 10_000, 10_000.0
PICTURES, SURVEY = 0.0, 2.0
"""CAMERA_MODE; a survey is pictures as well."""
SHOOT = 1.0
FLAGS = 0x2 | 0x4 | 0x20 | 0x40
"""CAMERA_CAP_FLAGS: takes images, has modes, one of them for surveys, has a zoom."""
NOWHERE = 2**31 - 1


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
        self._cycle = Series()
        """The trigger, at its interval."""
        self._cycle_s, self._triggers, self._by_mission = 0.0, True, False
        self._mode = PICTURES
        self.zoom = Zoom()
        self._last_s = 0.0
        self._beat_s = -math.inf

    def step(self, now_s: float) -> None:
        """Heartbeat at 1 Hz, and the pictures that are due."""
        if self._craft.camera and now_s - self._beat_s >= 1.0:
            self._beat_s = now_s
            beat = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_CAMERA, mav.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)
            self._craft.broadcast(beat, CAMERA)
        span_s, self._last_s = min(max(now_s - self._last_s, 0.0), 0.5), now_s
        if self.zoom.step(span_s) and self._craft.camera:
            self._craft.broadcast(self._settings(now_s), CAMERA)
        if self._series.due(now_s):
            self._take(now_s)
        if self._cycle.due(now_s) and self._goes_on(self._by_mission, now_s):
            self._take(now_s)
        if self._spacing.every_m and self._far_enough(now_s):
            self._take(now_s)

    def _goes_on(self, by_mission: bool, now_s: float) -> bool:
        """PX4 takes what a mission asked for only as long as it flies the mission; ArduCopter goes on."""
        row = self._craft.personality
        if not by_mission or row.name != "px4":
            return True
        return row.mode(self._craft.autopilot.telemetry(now_s).custom_mode) == "mission"

    def _far_enough(self, now_s: float) -> bool:
        now = self._craft.autopilot.telemetry(now_s)
        fine = motion.usable(now) and self._goes_on(self._spacing.by_mission, now_s)
        return fine and self._spacing.due(now.estimate.position_ned_m)

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
            case mav.MAV_CMD_DO_SET_CAM_TRIGG_INTERVAL:
                return 0 if math.isnan(first) or first == -1 or 0 <= first <= 1000 * LONGEST_S else 1
            case mav.MAV_CMD_DO_TRIGGER_CONTROL:
                return 0 if first in (-1, 0, 1) or math.isnan(first) else 1
            case mav.MAV_CMD_SET_CAMERA_ZOOM:
                known = first in ZOOM_KINDS
                return (2 if known else 1) if self.zoom.target(first, second) is None else 0
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
            case mav.MAV_CMD_DO_SET_CAM_TRIGG_INTERVAL:
                self._set_cycle(first, who == (self._craft.sysid, AUTOPILOT), now_s)
            case mav.MAV_CMD_DO_TRIGGER_CONTROL if first >= 0:
                self._triggers = first == 1
                self._run_cycle(now_s)
            case mav.MAV_CMD_SET_CAMERA_ZOOM:
                level = self.zoom.target(first, second)
                assert level is not None
                self.zoom.go(level)
            case mav.MAV_CMD_DO_DIGICAM_CONTROL if command.x == SHOOT:
                self._take(now_s)
        return Ack.ACCEPTED

    def _set_cycle(self, every_ms: float, by_mission: bool, now_s: float) -> None:
        """From one trigger to the next; 0 for none, negative or NaN for as it is."""
        if every_ms >= 0:
            self._cycle_s, self._by_mission = every_ms / 1000, by_mission
            self._run_cycle(now_s)

    def _run_cycle(self, now_s: float) -> None:
        if self._triggers and self._cycle_s:
            self._cycle.start(0, self._cycle_s, now_s)
        else:
            self._cycle.stop()

    def command(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        """What it is told, and the older requests that ask for one message each."""
        result = self.order(command, (sender.sysid, sender.compid), now_s)
        asked = OLDER_REQUESTS.get(command.id)
        message = None if asked is None else self.message(asked, sender, now_s)
        if message is None:
            return result
        self._craft.reply(sender, message, CAMERA)
        return Ack.ACCEPTED

    def _settings(self, now_s: float) -> Message:
        return mav.MAVLink_camera_settings_message(boot_ms(now_s), int(self._mode), self.zoom.level, math.nan, 0)

    def _view(self, now_s: float) -> Message:
        """What the picture spans; where it lies on the ground is not told."""
        now = self._craft.autopilot.telemetry(now_s)
        nowhere = (NOWHERE,) * 3
        there = motion.place(now.origin, now.estimate.position_ned_m) if now.origin and motion.usable(now) else nowhere
        turned = [math.nan] * 4
        return mav.MAVLink_camera_fov_status_message(boot_ms(now_s), *there, *nowhere, turned, *self.zoom.view_deg)

    def message(self, message_id: int, sender: Sender, now_s: float) -> Message | None:
        at_ms = boot_ms(now_s)
        used = self._taken * PICTURE_MIB
        free = max(CAPACITY_MIB - used, 0.0)
        if message_id == mav.MAVLINK_MSG_ID_CAMERA_INFORMATION:
            vendor, model = (list(_padded(text, 32).ljust(32, b"\0")) for text in ("R2X", "Simulated camera"))
            size = (*SENSOR_MM, WIDTH_PX, HEIGHT_PX)
            return mav.MAVLink_camera_information_message(
                at_ms, vendor, model, 1, WIDEST_MM, *size, 0, FLAGS, 0, b"", GIMBAL, 0
            )
        if message_id == mav.MAVLINK_MSG_ID_CAMERA_SETTINGS:
            return self._settings(now_s)
        if message_id == mav.MAVLINK_MSG_ID_CAMERA_FOV_STATUS:
            return self._view(now_s)
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
