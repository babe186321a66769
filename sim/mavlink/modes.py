"""The standard modes protocol: which modes there are, which one it is in; and which versions of MAVLink it speaks."""

from sim.autopilot.interface import Telemetry
from sim.autopilot.personality import Listed
from sim.mavlink.craft import Craft
from sim.mavlink.newer import AvailableModes, CurrentMode, ModesMonitor, ProtocolVersion
from sim.mavlink.peer import Message

ADVANCED = 1
"""MAV_MODE_PROPERTY_ADVANCED."""
ALL = 0


def version(craft: Craft, now: Telemetry) -> Message:
    """It hears both and speaks the second."""
    return ProtocolVersion(200, 100, 200)


def current(craft: Craft, now: Telemetry) -> Message | None:
    """What was asked for last and what it flies are the same from one heartbeat to the next."""
    if not craft.personality.listed:
        return None
    standard = next((row.standard for row in craft.personality.listed if row.custom_mode == now.custom_mode), 0)
    return CurrentMode(now.custom_mode, now.custom_mode, standard)


def monitor(craft: Craft, now: Telemetry) -> Message | None:
    """Its modes stay the same."""
    return ModesMonitor(0) if craft.personality.listed else None


def available(craft: Craft, index: int) -> list[Message]:
    """The mode of this number, counted from 1, or all of them; none where there is no such number."""
    rows = craft.personality.listed
    return [_mode(rows, k) for k in range(1, len(rows) + 1) if index in (ALL, k)]


def _mode(rows: tuple[Listed, ...], index: int) -> Message:
    """Standard modes go without a name."""
    row = rows[index - 1]
    name = "" if row.standard else row.name
    return AvailableModes(row.custom_mode, ADVANCED if row.advanced else 0, len(rows), index, row.standard, name)
