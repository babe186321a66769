"""The mission protocol: upload, download, clear and set current, of missions, fences and rally points.

One upload at a time and per vehicle:

    idle --COUNT--> receiving: asks for item 0
    receiving --item asked for--> asks for the next, or hands the whole to the autopilot, acknowledges: idle
    receiving --another item--> INVALID_SEQUENCE, goes on waiting;  an item that is no good --> its error: idle
    receiving --0.7 s of nothing--> asks again, five times, then OPERATION_CANCELLED: idle
    receiving --ACK of its sender--> idle;  --COUNT of its sender--> starts over;  --COUNT of another--> DENIED
"""

from dataclasses import dataclass, field
from typing import cast

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.interface import Ack, Command, Item, Plan, Severity
from sim.mavlink import items, status
from sim.mavlink.craft import Craft, Sender
from sim.mavlink.pack import finite, u16
from sim.mavlink.payload import Payload
from sim.mavlink.peer import Message

WHY = {
    mav.MAV_MISSION_UNSUPPORTED_FRAME: "its frame is of no use for it",
    mav.MAV_MISSION_UNSUPPORTED: "this vehicle cannot do that",
    mav.MAV_MISSION_INVALID: "its numbers make no sense",
    **{mav.MAV_MISSION_INVALID_PARAM1 + k: f"its param {k + 1} makes no sense" for k in range(4)},
    mav.MAV_MISSION_INVALID_PARAM5_X: "its latitude or x is nowhere it can be",
    mav.MAV_MISSION_INVALID_PARAM6_Y: "its longitude or y is nowhere it can be",
    mav.MAV_MISSION_INVALID_PARAM7: "its altitude or z makes no sense",
}
"""By MAV_MISSION_RESULT."""
VIDEOS = (mav.MAV_CMD_VIDEO_START_CAPTURE, mav.MAV_CMD_VIDEO_STOP_CAPTURE)
VIDEO = "the camera takes pictures only, no video"
AGAIN_S = 0.7
TRIES = 5
MOST_ITEMS = {0: 700, 1: 250, 2: 50}
NAMES = {0: "Mission", 1: "Fence", 2: "Rally points"}
ALL_KINDS = 255
GO_THERE, CHANGE_ALTITUDE = 2, 3
"""MISSION_ITEM.current of ArduPilot's older clients: not part of a mission but a place to go to now."""


@dataclass(slots=True)
class Upload:
    """What has come of a plan so far."""

    sender: Sender
    kind: Plan
    count: int
    asked_s: float
    tries: int = 0
    items: list[Item] = field(default_factory=list)
    """Where a part of a plan is written, what stands before it is here from the start."""
    rest: list[Item] = field(default_factory=list)
    """What stands behind that part."""


class Missions:
    """One vehicle's plans on the wire."""

    def __init__(self, craft: Craft, payload: Payload) -> None:
        self._craft = craft
        self._payload = payload
        self._upload: Upload | None = None

    def _ack(self, to: Sender, result: int, kind: int) -> None:
        self._craft.reply(to, mav.MAVLink_mission_ack_message(to.sysid, to.compid, result & 0xFF, kind))

    def _known(self, message: Message, sender: Sender) -> Plan | None:
        """The plan a message is of; any other kind is refused."""
        if message.mission_type in NAMES:
            return cast(Plan, message.mission_type)
        self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, message.mission_type)
        return None

    def _ask(self, upload: Upload, now_s: float) -> None:
        upload.asked_s = now_s
        whole = self._craft.personality.mission_request == "int"
        make = mav.MAVLink_mission_request_int_message if whole else mav.MAVLink_mission_request_message
        to = upload.sender
        self._craft.reply(to, make(to.sysid, to.compid, len(upload.items), upload.kind))

    def count(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_COUNT: an upload begins."""
        kind = self._known(message, sender)
        if kind is None:
            return
        if self._upload is not None and self._upload.sender != sender:
            self._ack(sender, mav.MAV_MISSION_DENIED, kind)
            self._craft.complain("Another client is uploading a plan; try again when it is done", now_s)
            return
        self._upload = None
        if message.count > MOST_ITEMS[kind]:
            self._ack(sender, mav.MAV_MISSION_NO_SPACE, kind)
            self._craft.complain(f"{NAMES[kind]}: {message.count} items, {MOST_ITEMS[kind]} at most", now_s)
            return
        upload = Upload(sender, kind, message.count, now_s)
        if upload.count == 0:
            self._finish(upload, now_s)
            return
        self._upload = upload
        self._ask(upload, now_s)

    def part(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_WRITE_PARTIAL_LIST: some items of the plan that there is are written anew. PX4 does not know it."""
        if self._craft.personality.name == "px4":
            return
        kind = self._known(message, sender)
        if kind is None:
            return
        plan, first, last = self._craft.autopilot.plan(kind), message.start_index, message.end_index
        if not 0 <= first <= last < len(plan) or self._upload is not None:
            self._ack(sender, mav.MAV_MISSION_ERROR, kind)
            self._craft.complain(f"{NAMES[kind]}: no items {first} to {last} to be written anew", now_s)
            return
        self._upload = Upload(sender, kind, last + 1, now_s, items=plan[:first], rest=plan[last + 1 :])
        self._ask(self._upload, now_s)

    def _finish(self, upload: Upload, now_s: float) -> None:
        current = self._craft.autopilot.telemetry(now_s).mission_current
        result = self._craft.autopilot.accept_plan(upload.kind, upload.items + upload.rest)
        if upload.rest and upload.kind == 0 and not result:
            self._craft.autopilot.set_current(current)
        self._ack(upload.sender, result, upload.kind)
        if upload.kind == 0 and not result:
            self._craft.last_reached = None
        if result:
            self._craft.say(Severity.WARNING, f"{NAMES[upload.kind]} refused, the old one stays")

    def item(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_ITEM or MISSION_ITEM_INT: the next one of an upload, or a place to go to now."""
        if message.current in (GO_THERE, CHANGE_ALTITUDE):
            self._go(message, sender, now_s)
            return
        kind = self._known(message, sender)
        if kind is None:
            return
        upload = self._upload
        if upload is None or upload.sender != sender or upload.kind != kind:
            self._ack(sender, mav.MAV_MISSION_ERROR, kind)
            return
        if message.seq < len(upload.items):
            return  # the answer to a question asked twice
        if message.seq != len(upload.items):
            self._ack(sender, mav.MAV_MISSION_INVALID_SEQUENCE, kind)
            return
        item = items.read(message)
        result = self._check(kind, item)
        if result:
            self._upload = None
            self._ack(sender, result, kind)
            why = VIDEO if item.command in VIDEOS else WHY.get(result, "refused")
            self._craft.complain(f"{NAMES[kind]} item {item.seq}, command {item.command}: {why}", now_s)
            return
        upload.items.append(item)
        upload.tries = 0
        if len(upload.items) < upload.count:
            self._ask(upload, now_s)
        else:
            self._upload = None
            self._finish(upload, now_s)

    def _check(self, kind: Plan, item: Item) -> int:
        if any(abs(value) == float("inf") for value in (*item.params, item.x, item.y, item.z)):
            return int(mav.MAV_MISSION_INVALID)
        result = self._craft.autopilot.check_item(kind, item)
        return result if result or kind != 0 else self._payload.check(item)

    def _go(self, message: Message, sender: Sender, now_s: float) -> None:
        item = items.read(message)
        if not finite((item.x, item.y, item.z)):
            self._ack(sender, mav.MAV_MISSION_INVALID, 0)
            return
        stay = message.current == CHANGE_ALTITUDE
        nan = float("nan")
        x, y = (nan, nan) if stay else (item.x, item.y)
        goto = Command(mav.MAV_CMD_DO_REPOSITION, (-1.0, 0.0, 0.0, nan), x, y, item.z, item.frame)
        answer = self._craft.autopilot.command(goto, now_s)
        accepted = answer.result in (Ack.ACCEPTED, Ack.IN_PROGRESS)
        self._ack(sender, mav.MAV_MISSION_ACCEPTED if accepted else mav.MAV_MISSION_ERROR, 0)
        if answer.text:
            self._craft.complain(answer.text, now_s)

    def step(self, now_s: float) -> None:
        """Ask again for an item that did not come; give up on a client that is gone."""
        upload = self._upload
        if upload is None or now_s - upload.asked_s < AGAIN_S:
            return
        upload.tries += 1
        if upload.tries <= TRIES:
            self._ask(upload, now_s)
            return
        self._upload = None
        self._ack(upload.sender, mav.MAV_MISSION_OPERATION_CANCELLED, upload.kind)
        self._craft.say(
            Severity.WARNING,
            f"{NAMES[upload.kind]} upload timed out at item {len(upload.items)} of {upload.count}, the old one stays",
        )

    def ack(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_ACK: the end of a download, or the client's own end of an upload."""
        if self._upload is not None and self._upload.sender == sender and message.mission_type == self._upload.kind:
            self._upload = None

    def request_list(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_REQUEST_LIST: a download begins."""
        kind = self._known(message, sender)
        if kind is not None:
            count = u16(len(self._craft.autopilot.plan(kind)))
            self._craft.reply(sender, mav.MAVLink_mission_count_message(sender.sysid, sender.compid, count, kind))

    def request(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_REQUEST or MISSION_REQUEST_INT: one item of a download."""
        kind = self._known(message, sender)
        if kind is None:
            return
        plan = self._craft.autopilot.plan(kind)
        if message.seq >= len(plan):
            self._ack(sender, mav.MAV_MISSION_INVALID_SEQUENCE, kind)
            return
        as_int = message.get_msgId() == mav.MAVLINK_MSG_ID_MISSION_REQUEST_INT
        current = kind == 0 and message.seq == self._craft.autopilot.telemetry(now_s).mission_current
        self._craft.reply(sender, items.write(plan[message.seq], kind, sender, as_int, current))

    def clear(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_CLEAR_ALL, of one kind or of all."""
        if message.mission_type != ALL_KINDS and self._known(message, sender) is None:
            return
        kinds: tuple[Plan, ...] = (0, 1, 2)
        results = [
            self._craft.autopilot.clear_plan(kind) for kind in kinds if message.mission_type in (kind, ALL_KINDS)
        ]
        self._ack(sender, max(results), message.mission_type)

    def set_current(self, message: Message, sender: Sender, now_s: float) -> None:
        """MISSION_SET_CURRENT: answered by MISSION_CURRENT, or by a refusal."""
        if self._craft.autopilot.set_current(message.seq):
            self._craft.broadcast(status.mission(self._craft, self._craft.autopilot.telemetry(now_s)))
        else:
            self._ack(sender, mav.MAV_MISSION_INVALID_SEQUENCE, 0)
            self._craft.complain(f"Mission has no item {message.seq} to go on from", now_s)
