"""One vehicle's whole side of the wire: which message goes where, and what goes out by itself."""

from collections.abc import Callable

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Telemetry
from sim.flight.state import Vec3
from sim.mavlink import streams, upkeep
from sim.mavlink.commands import Commands
from sim.mavlink.craft import AUTOPILOT, Craft, Sender
from sim.mavlink.gimbal import GIMBAL
from sim.mavlink.missions import Missions
from sim.mavlink.params import Params
from sim.mavlink.payload import Payload
from sim.mavlink.peer import Message, Peer, badly_signed
from sim.mavlink.setpoints import Setpoints
from sim.mavlink.streams import Rates

Handler = Callable[[Message, Sender, float], None]
COMMANDS = (mav.MAVLINK_MSG_ID_COMMAND_LONG, mav.MAVLINK_MSG_ID_COMMAND_INT)
UNSIGNED = "Unsigned command refused: sign it with the key"
BADLY_SIGNED = "Wrong key or repeated signature, ignored: system"


class Node:
    """Handles what is meant for its vehicle and steps its protocols."""

    def __init__(self, craft: Craft) -> None:
        self.craft = craft
        self._rates: dict[Peer, Rates] = {}
        self._home: Vec3 | None = None
        self._payload = Payload(craft)
        self._params, self._missions = Params(craft), Missions(craft, self._payload)
        self._commands = Commands(craft, self.rates, self._payload)
        self._handlers = self._table(Setpoints(craft))

    def _table(self, setpoints: Setpoints) -> dict[int, Handler]:
        missions, params, gimbal = self._missions, self._params, self._payload.gimbal
        return {
            mav.MAVLINK_MSG_ID_HEARTBEAT: self._heartbeat,
            mav.MAVLINK_MSG_ID_COMMAND_LONG: self._commands.handle,
            mav.MAVLINK_MSG_ID_COMMAND_INT: self._commands.handle,
            mav.MAVLINK_MSG_ID_SET_MODE: self._commands.set_mode,
            mav.MAVLINK_MSG_ID_REQUEST_DATA_STREAM: self._data_stream,
            mav.MAVLINK_MSG_ID_PARAM_REQUEST_LIST: params.list,
            mav.MAVLINK_MSG_ID_PARAM_REQUEST_READ: params.read,
            mav.MAVLINK_MSG_ID_PARAM_SET: params.set,
            mav.MAVLINK_MSG_ID_MISSION_COUNT: missions.count,
            mav.MAVLINK_MSG_ID_MISSION_WRITE_PARTIAL_LIST: missions.part,
            mav.MAVLINK_MSG_ID_MISSION_ITEM: missions.item,
            mav.MAVLINK_MSG_ID_MISSION_ITEM_INT: missions.item,
            mav.MAVLINK_MSG_ID_MISSION_ACK: missions.ack,
            mav.MAVLINK_MSG_ID_MISSION_REQUEST_LIST: missions.request_list,
            mav.MAVLINK_MSG_ID_MISSION_REQUEST: missions.request,
            mav.MAVLINK_MSG_ID_MISSION_REQUEST_INT: missions.request,
            mav.MAVLINK_MSG_ID_MISSION_CLEAR_ALL: missions.clear,
            mav.MAVLINK_MSG_ID_MISSION_SET_CURRENT: missions.set_current,
            mav.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED: setpoints.local,
            mav.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT: setpoints.globe,
            mav.MAVLINK_MSG_ID_SET_ATTITUDE_TARGET: setpoints.attitude,
            mav.MAVLINK_MSG_ID_VISION_POSITION_ESTIMATE: setpoints.vision,
            mav.MAVLINK_MSG_ID_ODOMETRY: setpoints.odometry,
            mav.MAVLINK_MSG_ID_ATT_POS_MOCAP: setpoints.mocap,
            mav.MAVLINK_MSG_ID_SET_GPS_GLOBAL_ORIGIN: setpoints.origin,
            mav.MAVLINK_MSG_ID_MANUAL_CONTROL: setpoints.manual,
            mav.MAVLINK_MSG_ID_RC_CHANNELS_OVERRIDE: setpoints.channels,
            mav.MAVLINK_MSG_ID_GIMBAL_MANAGER_SET_ATTITUDE: gimbal.set_attitude,
            mav.MAVLINK_MSG_ID_GIMBAL_MANAGER_SET_PITCHYAW: gimbal.set_pitch_yaw,
            mav.MAVLINK_MSG_ID_GIMBAL_MANAGER_SET_MANUAL_CONTROL: gimbal.set_by_sticks,
            mav.MAVLINK_MSG_ID_TIMESYNC: self._plain(upkeep.timesync),
            mav.MAVLINK_MSG_ID_PING: self._plain(upkeep.ping),
            mav.MAVLINK_MSG_ID_FILE_TRANSFER_PROTOCOL: self._plain(upkeep.refuse_file),
            mav.MAVLINK_MSG_ID_LOG_REQUEST_LIST: self._plain(upkeep.no_logs),
        }

    def handled(self) -> list[int]:
        """The ids of the messages that are not simply let be."""
        return sorted(self._handlers)

    def _plain(self, answer: Callable[[Craft, Message, Sender, float], None]) -> Handler:
        return lambda message, sender, now_s: answer(self.craft, message, sender, now_s)

    def rates(self, peer: Peer) -> Rates:
        """What this peer is sent, and how often."""
        if peer not in self._rates:
            self._rates[peer] = Rates(self.craft)
        return self._rates[peer]

    def _meant(self, message: Message) -> bool:
        """Whether it names this vehicle, or all, or nobody; components other than the autopilot take only commands."""
        target = getattr(message, "target_system", getattr(message, "target", 0))
        part = getattr(message, "target_component", 0)
        own = (0, AUTOPILOT, GIMBAL)
        return target in (0, self.craft.sysid) and (part in own or message.get_msgId() in COMMANDS)

    def handle(self, message: Message, sender: Sender, now_s: float) -> None:
        """Do what a message asks; nothing when it is not for this vehicle or not known."""
        handler = self._handlers.get(message.get_msgId())
        if handler is None or not self._meant(message):
            return
        if sender.peer.signs and not message.get_signed():
            self._unsigned(message, sender, now_s)
            return
        handler(message, sender, now_s)

    def _unsigned(self, message: Message, sender: Sender, now_s: float) -> None:
        """Both firmwares let be what is signed wrongly; that somebody tries it is said."""
        kind = message.get_msgId()
        if kind in (mav.MAVLINK_MSG_ID_HEARTBEAT, mav.MAVLINK_MSG_ID_TIMESYNC, mav.MAVLINK_MSG_ID_PING):
            return
        if badly_signed(message):
            self.craft.complain(f"{BADLY_SIGNED} {sender.sysid}", now_s)
            return
        if kind in COMMANDS:
            ack = (message.command, int(Ack.DENIED), 0, 0, sender.sysid, sender.compid)
            self.craft.reply(sender, mav.MAVLink_command_ack_message(*ack))
        self.craft.complain(UNSIGNED, now_s)

    def _heartbeat(self, message: Message, sender: Sender, now_s: float) -> None:
        if message.type == mav.MAV_TYPE_GCS:
            self.craft.autopilot.heard_station(now_s, sender.sysid)

    def _data_stream(self, message: Message, sender: Sender, now_s: float) -> None:
        self.rates(sender.peer).ask_group(message.req_stream_id, message.req_message_rate, message.start_stop == 1)

    def step(self, now_s: float) -> None:
        """Send what is due, and let every protocol go on."""
        for severity, text in self.craft.autopilot.texts():
            self.craft.say(severity, text)
        for seq in self.craft.autopilot.reached():
            self.craft.last_reached = seq
            self.craft.broadcast(mav.MAVLink_mission_item_reached_message(seq & 0xFFFF))
        self._commands.step(now_s)
        self._params.step(now_s)
        self._missions.step(now_s)
        self._payload.step(now_s)
        self._stream(now_s)

    def _stream(self, now_s: float) -> None:
        peers = self.craft.peers()
        for gone in self._rates.keys() - set(peers):
            del self._rates[gone]
        due = [(peer, ids) for peer in peers if (ids := self.rates(peer).due(now_s))]
        if not due:
            return
        now = self.craft.autopilot.telemetry(now_s)
        built: dict[int, Message | None] = {}
        for peer, ids in due:
            for message_id in ids:
                if message_id not in built:
                    built[message_id] = streams.build(self.craft, message_id, now)
                message = built[message_id]
                if message is not None:
                    peer.send(message, self.craft.sysid, AUTOPILOT, urgent=False)
        self._announce_home(now)

    def _announce_home(self, now: Telemetry) -> None:
        """HOME_POSITION at once when it has moved; the first is left to the streams."""
        if now.home_ned_m != self._home:
            moved = self._home is not None
            self._home = now.home_ned_m
            message = streams.build(self.craft, streams.HOME, now) if moved else None
            if message is not None:
                self.craft.broadcast(message)
