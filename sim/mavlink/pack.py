"""Numbers that fit their fields: whatever the state holds, packing never fails."""

import math
import struct
from collections.abc import Iterable

from sim.flight.state import Quaternion


def whole(value: float, bits: int, signed: bool = True) -> int:
    """`value` rounded into the range of an integer field; what is not a number becomes 0."""
    least, most = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    if not math.isfinite(value):
        return 0 if math.isnan(value) else (most if value > 0 else least)
    return min(max(round(value), least), most)


def i16(value: float) -> int:
    return whole(value, 16)


def u16(value: float) -> int:
    return whole(value, 16, signed=False)


def i32(value: float) -> int:
    return whole(value, 32)


def u8(value: float) -> int:
    return whole(value, 8, signed=False)


def single(value: float) -> float:
    """`value` within what a 32-bit float holds; NaN stays."""
    return value if math.isnan(value) else min(max(value, -3.4e38), 3.4e38)


def boot_ms(now_s: float) -> int:
    """`time_boot_ms`, which wraps."""
    return int(max(now_s, 0.0) * 1000) & 0xFFFF_FFFF


def boot_us(now_s: float) -> int:
    return int(max(now_s, 0.0) * 1e6) & 0xFFFF_FFFF_FFFF_FFFF


def finite(values: Iterable[float]) -> bool:
    return all(map(math.isfinite, values))


def centidegrees(angle_rad: float) -> int:
    """0 to 35999."""
    return round(math.degrees(angle_rad) * 100) % 36000 if math.isfinite(angle_rad) else 0


def int_bits(value: int) -> float:
    """The float whose bits are this INT32's: how PX4 sends whole parameters."""
    return float(struct.unpack("<f", struct.pack("<i", value))[0])


def bits_int(value: float, kind: str = "i") -> int:
    """The whole number in a float's bits; `kind` is struct's letter of a type of 1, 2 or 4 bytes."""
    raw = struct.pack("<f", value)
    return int(struct.unpack("<" + kind, raw[: struct.calcsize(kind)])[0])


def unit(attitude: Iterable[float]) -> Quaternion | None:
    """Normalised; None when it is no rotation."""
    w, x, y, z = attitude
    norm = math.sqrt(w * w + x * x + y * y + z * z) if finite((w, x, y, z)) and max(map(abs, (w, x, y, z))) < 1e6 else 0
    return (w / norm, x / norm, y / norm, z / norm) if norm > 0.1 else None


def heading_rad(attitude: Quaternion) -> float:
    """Clockwise from north, of a body FRD to NED rotation."""
    w, x, y, z = attitude
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
