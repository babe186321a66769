"""Messages of the common set that the dialect has lost or not got yet, packed as its own are."""

import struct
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mav

PROTOCOL_VERSION, AVAILABLE_MODES, CURRENT_MODE, MODES_MONITOR = 300, 435, 436, 437


class _Newer(mav.MAVLink_message):  # type: ignore[misc]
    """`number`, `layout` and `crc_extra` as the message's definition gives them; fields in the order of the wire."""

    number: int
    msgname: str
    layout: struct.Struct
    crc_extra: int

    def __init__(self, **fields: Any) -> None:
        super().__init__(self.number, self.msgname)
        self._fieldnames = list(fields)
        self._bytes = self.layout.pack(*fields.values())
        self.__dict__.update(fields)

    def pack(self, codec: mav.MAVLink) -> bytes:
        packed: bytes = self._pack(codec, self.crc_extra, self._bytes)
        return packed


class ProtocolVersion(_Newer):
    """In hundredths: 200 is MAVLink 2."""

    number, msgname, layout, crc_extra = PROTOCOL_VERSION, "PROTOCOL_VERSION", struct.Struct("<HHH8s8s"), 217

    def __init__(self, version: int, least: int, most: int) -> None:
        unknown = bytes(8)
        super().__init__(
            version=version,
            min_version=least,
            max_version=most,
            spec_version_hash=unknown,
            library_version_hash=unknown,
        )


class AvailableModes(_Newer):
    """One of the modes that there are."""

    number, msgname, layout, crc_extra = AVAILABLE_MODES, "AVAILABLE_MODES", struct.Struct("<IIBBB35s"), 134

    def __init__(self, custom_mode: int, properties: int, count: int, index: int, standard: int, name: str) -> None:
        super().__init__(
            custom_mode=custom_mode,
            properties=properties,
            number_modes=count,
            mode_index=index,
            standard_mode=standard,
            mode_name=name.encode("ascii"),
        )


class CurrentMode(_Newer):
    number, msgname, layout, crc_extra = CURRENT_MODE, "CURRENT_MODE", struct.Struct("<IIB"), 193

    def __init__(self, custom_mode: int, intended: int, standard: int) -> None:
        super().__init__(custom_mode=custom_mode, intended_custom_mode=intended, standard_mode=standard)


class ModesMonitor(_Newer):
    """A new number says that the modes are others than they were."""

    number, msgname, layout, crc_extra = MODES_MONITOR, "AVAILABLE_MODES_MONITOR", struct.Struct("<B"), 30

    def __init__(self, seq: int) -> None:
        super().__init__(seq=seq)
