"""One client at the far end of a link: its parser, the sequence numbers towards it, and its signing state."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mav

Message = Any
"""A message of the generated dialect: its classes have no types worth having."""

SIGNING_EPOCH_S = 1_420_070_400
"""2015-01-01, from which signatures count tens of microseconds."""


@dataclass(slots=True)
class Signing:
    """The key that all links share, and the times of signatures seen, so that none is taken twice."""

    key: bytes
    """32 bytes."""
    unix_s: float
    """Wall time at the start: older signatures from unseen senders are refused."""
    seen: dict[tuple[int, int, int], int] = field(default_factory=dict)

    def apply(self, parser: mav.MAVLink, link_id: int) -> None:
        """Sign what `parser` packs and check what it parses; unsigned messages come through, marked as such."""
        parser.signing.secret_key = self.key
        parser.signing.link_id = link_id
        parser.signing.timestamp = int((self.unix_s - SIGNING_EPOCH_S) * 1e5)
        parser.signing.stream_timestamps = self.seen
        parser.signing.allow_unsigned_callback = lambda _parser, _id: True
        parser.signing.sign_outgoing = True


class Codec(mav.MAVLink):  # type: ignore[misc]
    """The dialect's parser, whose record of signatures is written by good ones only.

    It would note the time of a signature before it looks at it: anybody without the key could then stamp a frame with
    the far future, and the owner of the key would be taken for a repeat from there on.
    """

    def check_signature(self, frame: bytearray, sysid: int, compid: int) -> bool:
        sender, seen = (frame[-13], sysid, compid), self.signing.stream_timestamps
        before = seen.get(sender)
        good = bool(super().check_signature(frame, sysid, compid))
        if not good and before is None:
            seen.pop(sender, None)
        elif not good:
            seen[sender] = before
        return good


def badly_signed(message: Message) -> bool:
    """It carries a signature, by another key or of a time that has been."""
    return bool(message.get_header().incompat_flags & mav.MAVLINK_IFLAG_SIGNED) and not message.get_signed()


@dataclass(slots=True)
class Counts:
    """What came and went, for the one line that is logged now and then."""

    received: int = 0
    bad: int = 0
    sent: int = 0
    dropped: int = 0


class Peer:
    """Bytes in, messages out and the other way round; `write` takes a whole frame and says whether it went."""

    def __init__(self, name: str, write: Callable[[bytes, bool], bool], link_id: int, signing: Signing | None) -> None:
        self.name = name
        self.counts = Counts()
        self._write = write
        self._link_id = link_id
        self._signing = signing
        self._parser = self._codec(0, 0)
        self._packers: dict[tuple[int, int], mav.MAVLink] = {}

    @property
    def signs(self) -> bool:
        return self._signing is not None

    def _codec(self, sysid: int, compid: int) -> mav.MAVLink:
        codec = Codec(None, sysid, compid)
        codec.robust_parsing = True
        if self._signing is not None:
            self._signing.apply(codec, self._link_id)
        return codec

    def send(self, message: Message, sysid: int, compid: int, urgent: bool = True) -> None:
        """Pack with this peer's own sequence. What is not urgent is dropped while the peer does not read."""
        packer = self._packers.get((sysid, compid))
        if packer is None:
            packer = self._packers[sysid, compid] = self._codec(sysid, compid)
        frame = message.pack(packer)
        if self._write(frame, urgent):
            packer.seq = (packer.seq + 1) & 0xFF
            self.counts.sent += 1
        else:
            self.counts.dropped += 1

    def datagram(self, data: bytes) -> list[Message]:
        """The messages of one datagram; a frame cut short at its end never eats the next datagram's start."""
        messages = self.stream(data)
        if self._parser.buf_len():
            self._parser = self._codec(0, 0)
            self.counts.bad += 1
        return messages

    def stream(self, data: bytes) -> list[Message]:
        """The whole messages so far; bad checksums, prefixes and unknown ids are counted and left out."""
        good = []
        for message in self._parser.parse_buffer(data) or ():
            if isinstance(message, mav.MAVLink_bad_data | mav.MAVLink_unknown):
                self.counts.bad += 1
            else:
                self.counts.received += 1
                good.append(message)
        return good
