"""The camera's gimbal as a component that is its own manager: angles, rates, regions of interest, and who is in control."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Command, Telemetry
from sim.flight.state import Vec3
from sim.mavlink import motion
from sim.mavlink.aim import FASTEST_RADPS, PITCH_RANGE_RAD, YAW_RANGE_RAD, Aim, reaches
from sim.mavlink.craft import AUTOPILOT, Craft, Sender
from sim.mavlink.pack import boot_ms, single
from sim.mavlink.peer import Message

GIMBAL = 154
"""MAV_COMP_ID_GIMBAL."""
REPORT_S, LOOK_S = 0.2, 0.05
NEUTRAL_THERE, ROLL_LOCK, PITCH_AXIS, PITCH_LOCK = 0x2, 0x10, 0x20, 0x80
YAW_AXIS, YAW_FOLLOW, YAW_LOCK, INFINITE_YAW, FROM_NORTH, TO_PLACES = 0x100, 0x200, 0x400, 0x800, 0x1000, 0x20000
CAPABILITIES = NEUTRAL_THERE | ROLL_LOCK | PITCH_AXIS | PITCH_LOCK | YAW_AXIS | YAW_FOLLOW | YAW_LOCK | INFINITE_YAW
CAPABILITIES |= FROM_NORTH
"""GIMBAL_DEVICE_CAP_FLAGS; the manager's have one more, for regions of interest."""
SELF, NOBODY, UNCHANGED = -2.0, -3.0, -1.0
"""How CONFIGURE names who is to be in control."""
ANY, WHOLE = (0.0, float(GIMBAL), 1.0), 0x3FF
"""The ids of gimbals by which it may be meant, and all GIMBAL_MANAGER_FLAGS."""
REGIONS = frozenset({mav.MAV_CMD_DO_SET_ROI_LOCATION, mav.MAV_CMD_DO_SET_ROI_NONE, mav.MAV_CMD_DO_SET_ROI})

RETRACTED, NEUTRAL, ANGLES = 0.0, 1.0, 2.0
"""MAV_MOUNT_MODE; it has no place to retract to and looks ahead then."""
LEVEL_DEG = 0.1
NAN = math.nan


class Gimbal:
    """Component 154; does what it was told last."""

    compid = GIMBAL

    def __init__(self, craft: Craft) -> None:
        self._craft = craft
        self.aim = Aim()
        self._turn_radps: float | None = None
        """The vehicle's own, where it is known."""
        self._control = (0, 0)
        self._points = False
        """It follows a region of interest."""
        self._last_s = 0.0
        self._beat_s = self._report_s = self._look_s = -math.inf

    def step(self, now_s: float) -> None:
        """Turn; heartbeat at 1 Hz and attitude at 5 Hz."""
        if now_s - self._look_s >= LOOK_S:
            self._look_s = now_s
            self._look(self._craft.autopilot.telemetry(now_s))
        span_s, self._last_s = min(max(now_s - self._last_s, 0.0), 0.5), now_s
        self.aim.step(span_s)
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

    def _look(self, now: Telemetry) -> None:
        """How the vehicle stands, and where the region of interest lies; without one any more it looks ahead."""
        known = motion.usable(now)
        self._turn_radps = now.estimate.rates_frd_radps[2] if known else None
        if known:
            self.aim.heading_rad = now.estimate.heading_rad
        if now.region_ned_m is not None and known:
            self._points = True
            self._point(now.estimate.position_ned_m, now.region_ned_m)
        elif now.region_ned_m is None and self._points:
            self._points = False
            self._ahead()

    def _point(self, here: Vec3, there: Vec3) -> None:
        north, east, down = (to - at for to, at in zip(there, here, strict=True))
        across = math.hypot(north, east)
        yaw = math.atan2(east, north) if across > 0.2 else NAN
        self.aim.turn(-math.atan2(down, across), yaw, (NAN, NAN), locked=True, from_north=True)

    def _ahead(self) -> None:
        self.aim.turn(0.0, 0.0, (NAN, NAN), locked=False, from_north=False)

    @property
    def flags(self) -> int:
        """GIMBAL_DEVICE_FLAGS: level by itself, and what its yaw is counted from."""
        level = mav.GIMBAL_DEVICE_FLAGS_ROLL_LOCK | mav.GIMBAL_DEVICE_FLAGS_PITCH_LOCK
        if self.aim.locked:
            return int(level | mav.GIMBAL_DEVICE_FLAGS_YAW_LOCK | mav.GIMBAL_DEVICE_FLAGS_YAW_IN_EARTH_FRAME)
        return int(level | mav.GIMBAL_DEVICE_FLAGS_YAW_IN_VEHICLE_FRAME)

    def _attitude(self, now_s: float) -> Message:
        known = self._turn_radps is not None
        vehicle = (single(self.aim.heading_rad), single(self._turn_radps or 0.0)) if known else (NAN, NAN)
        return mav.MAVLink_gimbal_device_attitude_status_message(
            0, 0, boot_ms(now_s), self.flags, list(self.aim.attitude), NAN, NAN, NAN, 0, *vehicle, 0
        )

    def _status(self, now_s: float) -> Message:
        return mav.MAVLink_gimbal_manager_status_message(boot_ms(now_s), self.flags, GIMBAL, *self._control, 0, 0)

    def turn(self, flags: int, angles_rad: tuple[float, float], rates_radps: tuple[float, float]) -> bool:
        """Pitch and yaw as GIMBAL_MANAGER_FLAGS say, NaN for as it is; False for what is out of reach or no number."""
        if not (reaches(angles_rad[0], PITCH_RANGE_RAD) and reaches(angles_rad[1], YAW_RANGE_RAD)):
            return False
        if any(map(math.isinf, rates_radps)):
            return False
        if self._points:  # who turns it himself has done with the region of interest
            self._points = False
            region = Command(mav.MAV_CMD_DO_SET_ROI_NONE, (0.0, 0.0, 0.0, 0.0), 0.0, 0.0, 0.0, None)
            self._craft.autopilot.command(region, self._last_s)
        if flags & (mav.GIMBAL_MANAGER_FLAGS_NEUTRAL | mav.GIMBAL_MANAGER_FLAGS_RETRACT):
            self._ahead()
            return True
        locked = bool(flags & mav.GIMBAL_MANAGER_FLAGS_YAW_LOCK)
        said = flags & (mav.GIMBAL_MANAGER_FLAGS_YAW_IN_VEHICLE_FRAME | mav.GIMBAL_MANAGER_FLAGS_YAW_IN_EARTH_FRAME)
        from_north = bool(flags & mav.GIMBAL_MANAGER_FLAGS_YAW_IN_EARTH_FRAME) if said else locked
        self.aim.turn(*angles_rad, rates_radps, locked, from_north)
        return True

    def wrong(self, command: Command) -> int | None:
        """Which param (1 to 7) makes no sense, 0 when all do; None for what it does not know."""
        first, second, third, fourth = command.params
        match command.id:
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW:
                fine = (
                    reaches(math.radians(first), PITCH_RANGE_RAD),
                    reaches(math.radians(second), YAW_RANGE_RAD),
                    not math.isinf(third),
                    not math.isinf(fourth),
                    math.isnan(command.x) or 0 <= command.x <= WHOLE,
                    True,
                    math.isnan(command.z) or command.z in ANY,
                )
                return fine.index(False) + 1 if False in fine else 0
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE:
                if first in (SELF, NOBODY, UNCHANGED):
                    return 0
                return (0 if 0 <= second <= 255 else 2) if 0 <= first <= 255 else 1
            case mav.MAV_CMD_DO_MOUNT_CONFIGURE:
                return 0 if first in (RETRACTED, NEUTRAL, ANGLES) else 1
            case mav.MAV_CMD_DO_MOUNT_CONTROL:
                return self._wrong_mount(command)
        return None

    def _wrong_mount(self, command: Command) -> int:
        first, second, third, _ = command.params
        if not self._by_angles(command):
            return 0 if command.z in (RETRACTED, NEUTRAL) else 7
        if not reaches(math.radians(first), PITCH_RANGE_RAD):
            return 1
        if abs(second) > LEVEL_DEG:  # it keeps level by itself and cannot be leant
            return 2
        return 3 if math.isinf(third) else 0

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
        first, second, third, fourth = command.params
        match command.id:
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW:
                if not self._obeys(who):
                    return Ack.DENIED
                flags = 0 if math.isnan(command.x) else int(command.x)
                self.turn(
                    flags, (math.radians(first), math.radians(second)), (math.radians(third), math.radians(fourth))
                )
            case mav.MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE:
                self._configure(first, second, who)
            case mav.MAV_CMD_DO_MOUNT_CONTROL if self._by_angles(command):
                self.turn(0, (math.radians(first), math.remainder(math.radians(third), math.tau)), (NAN, NAN))
            case mav.MAV_CMD_DO_MOUNT_CONTROL:
                self.turn(mav.GIMBAL_MANAGER_FLAGS_NEUTRAL, (0.0, 0.0), (NAN, NAN))
            case mav.MAV_CMD_DO_MOUNT_CONFIGURE if first != ANGLES:
                self.turn(mav.GIMBAL_MANAGER_FLAGS_NEUTRAL, (0.0, 0.0), (NAN, NAN))
        return Ack.ACCEPTED

    def command(self, command: Command, sender: Sender, now_s: float) -> Ack | None:
        """Regions of interest are the autopilot's to know, and come back from it."""
        if command.id in REGIONS:
            answer = self._craft.autopilot.command(command, now_s)
            if answer.text:
                self._craft.complain(answer.text, now_s)
            return answer.result
        return self.order(command, (sender.sysid, sender.compid), now_s)

    def _obeys(self, who: tuple[int, int]) -> bool:
        """PX4 turns it for nobody but who is in control; while nobody is, and with ArduCopter, anybody may."""
        own = (self._craft.sysid, AUTOPILOT)
        return self._craft.personality.name == "ardupilot" or self._control == (0, 0) or who in (self._control, own)

    def _configure(self, sysid: float, compid: float, who: tuple[int, int]) -> None:
        if sysid == SELF:
            self._control = who
        elif sysid == NOBODY:
            self._control = (0, 0)
        elif sysid != UNCHANGED:
            self._control = (int(sysid), int(compid))

    def _told(
        self, message: Message, sender: Sender, angles_rad: tuple[float, float], rates_radps: tuple[float, float]
    ) -> None:
        """By a message, which has no acknowledgement."""
        if message.gimbal_device_id in ANY and self._obeys((sender.sysid, sender.compid)):
            self.turn(message.flags, angles_rad, rates_radps)

    def set_attitude(self, message: Message, sender: Sender, now_s: float) -> None:
        """GIMBAL_MANAGER_SET_ATTITUDE: a quaternion, or NaN and rates alone."""
        rates = (message.angular_velocity_y, message.angular_velocity_z)
        w, x, y, z = message.q
        sine = 2 * (w * y - z * x)
        if any(map(math.isnan, message.q)):
            self._told(message, sender, (NAN, NAN), rates)
        elif -1.001 <= sine <= 1.001:
            yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
            self._told(message, sender, (math.asin(min(max(sine, -1.0), 1.0)), yaw), rates)

    def set_pitch_yaw(self, message: Message, sender: Sender, now_s: float) -> None:
        """GIMBAL_MANAGER_SET_PITCHYAW."""
        self._told(message, sender, (message.pitch, message.yaw), (message.pitch_rate, message.yaw_rate))

    def set_by_sticks(self, message: Message, sender: Sender, now_s: float) -> None:
        """GIMBAL_MANAGER_SET_MANUAL_CONTROL: parts of what it reaches, and of how fast it turns; up is positive."""
        sticks = (message.pitch, message.yaw, message.pitch_rate, message.yaw_rate)
        if any(abs(stick) > 1.0 for stick in sticks):
            return
        pitch = message.pitch * (PITCH_RANGE_RAD[1] if message.pitch > 0 else -PITCH_RANGE_RAD[0])
        rates = (message.pitch_rate * FASTEST_RADPS, message.yaw_rate * FASTEST_RADPS)
        self._told(message, sender, (pitch, message.yaw * YAW_RANGE_RAD[1]), rates)

    def message(self, message_id: int, sender: Sender, now_s: float) -> Message | None:
        ranges = (0.0, 0.0, *PITCH_RANGE_RAD, *YAW_RANGE_RAD)
        if message_id == mav.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION:
            every = CAPABILITIES | TO_PLACES
            return mav.MAVLink_gimbal_manager_information_message(boot_ms(now_s), every, GIMBAL, *ranges)
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
