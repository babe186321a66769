"""What steers without an acknowledgement: setpoints, sticks, and poses from outside. Validated here, or dropped."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.geo import GLOBAL_FRAMES
from sim.autopilot.interface import AttitudeSetpoint, PositionTarget
from sim.flight.state import Vec3
from sim.mavlink import streams
from sim.mavlink.craft import Craft, Sender
from sim.mavlink.pack import finite, heading_rad, unit
from sim.mavlink.peer import Message

POSITION, VELOCITY, ACCELERATION, YAW, YAW_RATE = 0x7, 0x38, 0x1C0, 0x400, 0x800
"""POSITION_TARGET_TYPEMASK: a triple with any of its bits set is ignored."""
NO_ATTITUDE = 0x80
ABSURD = 1e7
NOWHERE: Vec3 = (0.0, 0.0, 0.0)
STICK_UNUSED = 0x7FFF
CHANNEL_UNUSED = (0, 0xFFFF)
FARTHEST_POSE_M = 1e5


def _kept(mask: int, bits: int, values: Vec3) -> Vec3 | None:
    """Zeros when masked out; None when they are no sensible numbers."""
    if mask & bits:
        return NOWHERE
    return values if finite(values) and max(map(abs, values)) < ABSURD else None


class Setpoints:
    """One vehicle's inputs of this kind."""

    def __init__(self, craft: Craft) -> None:
        self._craft = craft

    def local(self, message: Message, sender: Sender, now_s: float) -> None:
        """SET_POSITION_TARGET_LOCAL_NED."""
        self._position(message, (message.x, message.y, message.z), now_s)

    def globe(self, message: Message, sender: Sender, now_s: float) -> None:
        """SET_POSITION_TARGET_GLOBAL_INT."""
        self._position(message, (message.lat_int / 1e7, message.lon_int / 1e7, message.alt), now_s)

    def _position(self, message: Message, where: Vec3, now_s: float) -> None:
        mask, frame = message.type_mask, message.coordinate_frame
        is_global = message.get_msgId() == mav.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT
        if is_global != (frame in GLOBAL_FRAMES):
            self._craft.complain(f"Setpoint refused: frame {frame} is of another message", now_s)
            return
        position = _kept(mask, POSITION, where)
        velocity = _kept(mask, VELOCITY, (message.vx, message.vy, message.vz))
        acceleration = _kept(mask, ACCELERATION, (message.afx, message.afy, message.afz))
        turn = _kept(0, 0, (0.0 if mask & YAW else message.yaw, 0.0 if mask & YAW_RATE else message.yaw_rate, 0.0))
        if position is None or velocity is None or acceleration is None or turn is None:
            self._craft.complain("Setpoint refused: a number in it is not finite or absurd", now_s)
            return
        target = PositionTarget(frame, mask, position, velocity, acceleration, turn[0], turn[1])
        self._craft.autopilot.position_target(target, now_s)

    def attitude(self, message: Message, sender: Sender, now_s: float) -> None:
        """SET_ATTITUDE_TARGET."""
        mask = message.type_mask
        turned = (1.0, 0.0, 0.0, 0.0) if mask & NO_ATTITUDE else unit(message.q)
        asked = (message.body_roll_rate, message.body_pitch_rate, message.body_yaw_rate)
        rates = [0.0 if mask & 1 << bit else rate for bit, rate in enumerate(asked)]
        if turned is None or not finite((*rates, message.thrust)) or max(map(abs, rates)) > ABSURD:
            self._craft.complain("Attitude refused: not finite, or no rotation", now_s)
            return
        target = AttitudeSetpoint(mask, turned, (rates[0], rates[1], rates[2]), message.thrust)
        self._craft.autopilot.attitude_target(target, now_s)

    def _pose(self, where: Vec3, heading: float | None, now_s: float) -> None:
        if not finite(where) or max(map(abs, where)) > FARTHEST_POSE_M:
            self._craft.complain("External pose refused: a number is not finite or absurd", now_s)
            return
        known = heading is not None and math.isfinite(heading) and abs(heading) < ABSURD
        self._craft.autopilot.external_pose(where, heading if known else None, now_s)

    def vision(self, message: Message, sender: Sender, now_s: float) -> None:
        """VISION_POSITION_ESTIMATE, in local NED."""
        self._pose((message.x, message.y, message.z), message.yaw, now_s)

    def mocap(self, message: Message, sender: Sender, now_s: float) -> None:
        """ATT_POS_MOCAP, in local NED."""
        turned = unit(message.q)
        self._pose((message.x, message.y, message.z), None if turned is None else heading_rad(turned), now_s)

    def odometry(self, message: Message, sender: Sender, now_s: float) -> None:
        """ODOMETRY in one of the local frames; its velocity is left to the estimator."""
        x, y, z = message.x, message.y, message.z
        turned = unit(message.q)
        heading = None if turned is None else heading_rad(turned)
        if message.frame_id == mav.MAV_FRAME_LOCAL_FLU:
            y, z = -y, -z
            heading = None if heading is None else -heading
        elif message.frame_id == mav.MAV_FRAME_LOCAL_ENU:
            x, y, z = y, x, -z
            heading = None if heading is None else math.pi / 2 - heading
        elif message.frame_id not in (mav.MAV_FRAME_LOCAL_NED, mav.MAV_FRAME_LOCAL_FRD):
            self._craft.complain(f"Odometry refused: frame {message.frame_id} is not a local one", now_s)
            return
        self._pose((x, y, z), heading, now_s)

    def origin(self, message: Message, sender: Sender, now_s: float) -> None:
        """SET_GPS_GLOBAL_ORIGIN: answered by what the origin now is, and where home lies in it."""
        degrees = (message.latitude / 1e7, message.longitude / 1e7)
        if not (abs(degrees[0]) <= 90 and abs(degrees[1]) <= 180):
            self._craft.complain("Origin refused: no such place on Earth", now_s)
            return
        if not self._craft.autopilot.set_origin(*degrees, message.altitude / 1000):
            self._craft.complain("Origin refused", now_s)
        self._craft.home_asked = True
        now = self._craft.autopilot.telemetry(now_s)
        for message_id in (mav.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN, streams.HOME):
            answer = streams.build(self._craft, message_id, now)
            if answer is not None:
                self._craft.broadcast(answer)

    def manual(self, message: Message, sender: Sender, now_s: float) -> None:
        """MANUAL_CONTROL: thousandths; an axis that is not there stands in the middle."""
        axes = (message.y, message.x, message.z, message.r)
        roll, pitch, throttle, yaw = (0.0 if axis == STICK_UNUSED else axis / 1000 for axis in axes)
        if message.z == STICK_UNUSED:
            throttle = 0.5
        self._sticks(roll, pitch, throttle, yaw, now_s, sender.sysid)

    def channels(self, message: Message, sender: Sender, now_s: float) -> None:
        """RC_CHANNELS_OVERRIDE: microseconds of roll, pitch, throttle and yaw; none of them given means released."""
        pulses = (message.chan1_raw, message.chan2_raw, message.chan3_raw, message.chan4_raw)
        if all(pulse in CHANNEL_UNUSED for pulse in pulses):
            self._craft.pulses_s = -math.inf
            return
        roll, pitch, throttle, yaw = (0.0 if pulse in CHANNEL_UNUSED else (pulse - 1500) / 500 for pulse in pulses)
        if self._sticks(roll, -pitch, (throttle + 1) / 2, yaw, now_s, sender.sysid):
            given = zip(pulses, self._craft.sticks_us(now_s), strict=True)
            one, two, three, four = (kept if pulse in CHANNEL_UNUSED else pulse for pulse, kept in given)
            self._craft.pulses_us, self._craft.pulses_s = (one, two, three, four), now_s

    def _sticks(self, roll: float, pitch: float, throttle: float, yaw: float, now_s: float, sysid: int) -> bool:
        roll, pitch, yaw = (min(max(axis, -1.0), 1.0) for axis in (roll, pitch, yaw))
        return self._craft.autopilot.manual(roll, pitch, min(max(throttle, 0.0), 1.0), yaw, now_s, sysid)
