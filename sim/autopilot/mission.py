"""A mission's items: what is accepted, where it stands, and what has been reached."""

import math
from dataclasses import dataclass, field, replace

from sim.autopilot.geo import GLOBAL_FRAMES, place
from sim.autopilot.interface import Item
from sim.autopilot.situation import Situation
from sim.flight.state import Vec3

WAYPOINT, LOITER, LOITER_TURNS, LOITER_TIME, RETURN, LAND, TAKEOFF, DELAY = 16, 17, 18, 19, 20, 21, 22, 93
YAW, JUMP, SPEED, SET_HOME, REGION_AT, REGION_NONE, REGION = 115, 177, 178, 179, 195, 197, 201
LOITER_TO_HEIGHT, SPLINE, LAND_START, GATE = 31, 82, 189, 4501
"""MAV_CMD."""
FLOWN_TO = frozenset({WAYPOINT, LOITER, LOITER_TURNS, LOITER_TIME, LAND, TAKEOFF, LOITER_TO_HEIGHT, SPLINE})
AT_A_PLACE = FLOWN_TO | {REGION_AT, GATE}
PAYLOAD = frozenset({203, 204, 205, 206, 214, 530, 531, 1000, 1001, 2000, 2001, 2003})
"""Digicam, mount configure and control, pictures by distance and by interval, camera mode, zoom, gimbal angles, who
controls it, pictures, their end and the trigger. Handed on to camera and gimbal, who have looked at the numbers when they were uploaded."""
_WITHOUT = frozenset({RETURN, DELAY, YAW, JUMP, SPEED, SET_HOME, REGION_NONE, REGION, LAND_START})
_STOPS = frozenset({RETURN, DELAY, JUMP, TAKEOFF})
ACCEPTED, ERROR, FRAME, UNSUPPORTED, NO_SPACE = 0, 1, 2, 3, 4
PARAM1, PARAM2, X, Y, Z, SEQUENCE = 6, 7, 10, 11, 12, 13
"""MAV_MISSION_RESULT."""
ITEMS_MAX = 700
RALLY_POINT = 5100


def check(item: Item, now: Situation) -> int:
    """MAV_MISSION_RESULT of one mission item."""
    if item.command in PAYLOAD:
        return ACCEPTED
    if item.command not in AT_A_PLACE | _WITHOUT or item.command in now.row.unknown_items:
        return UNSUPPORTED
    first, second = item.params[0], item.params[1]
    wrong_first = (
        (item.command in (DELAY, LOITER_TIME, LOITER_TURNS) and not 0.0 <= first <= 86400.0)
        or (item.command in (WAYPOINT, SPLINE) and not (math.isnan(first) or 0.0 <= first <= 86400.0))
        or (item.command == JUMP and not (0.0 <= first < ITEMS_MAX and first == int(first) and first != item.seq))
        or (item.command == YAW and not abs(first) <= 360.0)
    )
    if wrong_first:
        return PARAM1
    if item.command == SPEED and not (second == -1.0 or 0.0 < second <= 50.0):
        return PARAM2
    if item.command == JUMP and not -1.0 <= second <= 1e6:
        return PARAM2
    return _check_place(item, now) if item.command in AT_A_PLACE else ACCEPTED


def check_rally(item: Item, now: Situation) -> int:
    """MAV_MISSION_RESULT of one rally point; zeros, which elsewhere mean where it is, are nowhere to come back to."""
    if item.command != RALLY_POINT:
        return UNSUPPORTED
    if item.frame in GLOBAL_FRAMES and item.x == 0.0 and item.y == 0.0:
        return X
    return _check_place(item, now)


def spot(item: Item, now: Situation) -> Vec3 | str | None:
    """Local NED of an item; zeros in a global frame, and NaN, stand for where the vehicle is."""
    x, y, z = item.x, item.y, item.z
    if item.frame in GLOBAL_FRAMES and x == 0.0 and y == 0.0:
        x = y = math.nan
    return place(item.frame, x, y, z, now.origin, now.home_ned_m, now.here)


def _check_place(item: Item, now: Situation) -> int:
    if item.command == TAKEOFF and item.frame not in GLOBAL_FRAMES | {1}:
        return FRAME
    here_allowed = item.command not in (WAYPOINT, SPLINE, REGION_AT, GATE, RALLY_POINT)
    if math.isinf(item.x) or (math.isnan(item.x) and not here_allowed):
        return X
    if math.isinf(item.y) or (math.isnan(item.y) and not here_allowed):
        return Y
    if math.isinf(item.z) or (math.isnan(item.z) and not here_allowed):
        return Z
    found = spot(item, now)
    if found is None or (now.origin is None and item.frame in GLOBAL_FRAMES):
        return FRAME
    if not isinstance(found, str):
        return ACCEPTED
    without_height = spot(replace(item, z=math.nan), now)
    if not isinstance(without_height, str):
        return Z
    without_east = spot(replace(item, y=now.origin.longitude_deg if now.origin else 0.0), now)
    return X if isinstance(without_east, str) else Y


@dataclass(slots=True)
class Mission:
    """The items by their number on the wire; where item 0 is home, it stands there unused."""

    first: int
    """The number of the first item that is flown."""
    items: list[Item] = field(default_factory=list)
    current: int = 0
    finished: bool = False
    reached: list[int] = field(default_factory=list)
    jumped: dict[int, int] = field(default_factory=dict)
    edition: int = 0
    """How many uploads there have been."""

    @property
    def empty(self) -> bool:
        return len(self.items) <= self.first

    def take(self, items: list[Item]) -> int:
        """A whole upload; MAV_MISSION_RESULT."""
        if len(items) > ITEMS_MAX:
            return NO_SPACE
        if [item.seq for item in items] != list(range(len(items))):
            return SEQUENCE
        for item in items[self.first :]:
            if item.command == JUMP and not self.first <= item.params[0] < len(items):
                return PARAM1
        self.items = items
        self.edition += 1
        self.restart()
        return ACCEPTED

    def restart(self) -> None:
        self.current, self.finished = 0 if self.empty else self.first, self.empty
        self.jumped.clear()

    def go_to(self, seq: int) -> bool:
        """Make an item the next one; whether there is one."""
        seq = max(seq, self.first) if seq >= 0 else seq
        if not 0 <= seq < len(self.items):
            return False
        self.current, self.finished = seq, False
        return True

    def advance(self) -> None:
        """The current item is done."""
        self.reached.append(self.current)
        if self.current + 1 >= len(self.items):
            self.finished = True
        else:
            self.current += 1

    def following(self) -> Item | None:
        """The item that is flown to after the current one, when nothing in between stops it or leads elsewhere."""
        for item in self.items[self.current + 1 :]:
            if item.command in _STOPS:
                return None
            if item.command in FLOWN_TO:
                return item
        return None

    def jump(self, item: Item) -> None:
        """To the item that it names, as often as it says; then on."""
        times = self.jumped.get(item.seq, 0)
        if item.params[1] != -1 and times >= item.params[1]:
            self.advance()
            return
        self.jumped[item.seq] = times + 1
        self.reached.append(self.current)
        self.current = int(item.params[0])
