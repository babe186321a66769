"""What keeps a client content: clocks compared, pings answered, file transfer and logs refused as the protocol says."""

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.mavlink.craft import Craft, Sender
from sim.mavlink.peer import Message

FTP_NAK = 129
FTP_NOT_FOUND = 10
FTP_BYTES = 251
MOST_NS = 2**63 - 1


def timesync(craft: Craft, message: Message, sender: Sender, now_s: float) -> None:
    """TIMESYNC: a question (tc1 = 0) is answered with our time; an answer is let be."""
    if message.tc1 == 0:
        now_ns = min(int(max(now_s, 0.0) * 1e9), MOST_NS)
        craft.reply(sender, mav.MAVLink_timesync_message(now_ns or 1, message.ts1))


def ping(craft: Craft, message: Message, sender: Sender, now_s: float) -> None:
    """PING: a question names nobody, the answer names who asked."""
    if message.target_system == 0 and message.target_component == 0:
        craft.reply(sender, mav.MAVLink_ping_message(message.time_usec, message.seq, sender.sysid, sender.compid))


def refuse_file(craft: Craft, message: Message, sender: Sender, now_s: float) -> None:
    """FILE_TRANSFER_PROTOCOL: there are no files; a refusal at once spares the client its timeouts."""
    asked = bytes(message.payload[:12]).ljust(12, b"\0")
    if asked[3] in (128, FTP_NAK):
        return
    number = (int.from_bytes(asked[:2], "little") + 1) & 0xFFFF
    answer = number.to_bytes(2, "little") + bytes([asked[2], FTP_NAK, 1, asked[3], 0, 0]) + asked[8:12]
    payload = list((answer + bytes([FTP_NOT_FOUND])).ljust(FTP_BYTES, b"\0"))
    craft.reply(sender, mav.MAVLink_file_transfer_protocol_message(0, sender.sysid, sender.compid, payload))


def no_logs(craft: Craft, message: Message, sender: Sender, now_s: float) -> None:
    """LOG_REQUEST_LIST: none are kept."""
    craft.reply(sender, mav.MAVLink_log_entry_message(0, 0, 0, 0, 0))
