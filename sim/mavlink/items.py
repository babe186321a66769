"""Mission items between their two wire forms and the autopilot's own."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mav

from sim.autopilot.geo import GLOBAL_FRAMES, LOCAL_FRAMES
from sim.autopilot.interface import Item
from sim.mavlink.craft import Sender
from sim.mavlink.pack import i32, single, u8, u16
from sim.mavlink.peer import Message

LOCAL_FRAME_SCALE = 1e4
GLOBAL_FRAME_SCALE = 1e7

POSITIONED = frozenset(
    {
        16,
        17,
        18,
        19,
        21,
        22,
        31,
        34,
        80,
        82,
        84,
        85,
        179,
        189,
        192,
        195,
        201,
        3000,
        4501,
        5000,
        5001,
        5002,
        5003,
        5004,
        5100,
    }
)
"""MAV_CMD whose params 5 and 6 are a place; of others they are plain numbers."""


def scale(command: int, frame: int) -> float:
    """What the integers x and y of a MISSION_ITEM_INT or COMMAND_INT are divided by."""
    if command not in POSITIONED:
        return 1.0
    if frame in GLOBAL_FRAMES:
        return GLOBAL_FRAME_SCALE
    return LOCAL_FRAME_SCALE if frame in LOCAL_FRAMES else 1.0


def read(message: Message) -> Item:
    """MISSION_ITEM or MISSION_ITEM_INT."""
    whole = message.get_msgId() == mav.MAVLINK_MSG_ID_MISSION_ITEM_INT
    divide = scale(message.command, message.frame) if whole else 1.0
    return Item(
        seq=message.seq,
        frame=message.frame,
        command=message.command,
        current=message.current == 1,
        autocontinue=bool(message.autocontinue),
        params=(message.param1, message.param2, message.param3, message.param4),
        x=message.x / divide,
        y=message.y / divide,
        z=message.z,
    )


def write(item: Item, kind: int, to: Sender, as_int: bool, current: bool) -> Message:
    """The item in the form that was asked for."""
    head = (to.sysid, to.compid, u16(item.seq), u8(item.frame), u16(item.command), int(current))
    params = (int(item.autocontinue), *(single(value) for value in item.params))
    if as_int:
        times = scale(item.command, item.frame)
        x, y = (0.0 if math.isnan(value) else value for value in (item.x, item.y))
        return mav.MAVLink_mission_item_int_message(
            *head, *params, i32(x * times), i32(y * times), single(item.z), kind
        )
    return mav.MAVLink_mission_item_message(*head, *params, single(item.x), single(item.y), single(item.z), kind)
