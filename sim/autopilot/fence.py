"""The geofence: circles and polygons to stay in or out of, the farthest and highest allowed, and the ceiling."""

import math
from dataclasses import dataclass
from typing import Literal

from sim.autopilot.geo import place
from sim.autopilot.interface import Item, Severity
from sim.autopilot.situation import CLEARANCE_M, Situation
from sim.flight.state import Vec3

RETURN_POINT, POLYGON_IN, POLYGON_OUT, CIRCLE_IN, CIRCLE_OUT = 5000, 5001, 5002, 5003, 5004
"""MAV_CMD_NAV_FENCE_*."""
_ACCEPTED, _ERROR, _FRAME, _UNSUPPORTED, _INVALID, _PARAM1, _X, _Y = 0, 1, 2, 3, 5, 6, 10, 11
"""MAV_MISSION_RESULT."""
_NARROWEST_M = 0.05
"""What is narrower holds nothing: corners on one line, but for what rounding the degrees makes of them."""
_POINTS_MAX = 200


@dataclass(frozen=True, slots=True)
class Circle:
    inside: bool
    north_m: float
    east_m: float
    radius_m: float

    def holds(self, point: Vec3) -> bool:
        return math.hypot(point[0] - self.north_m, point[1] - self.east_m) <= self.radius_m


@dataclass(frozen=True, slots=True)
class Polygon:
    inside: bool
    corners_m: tuple[tuple[float, float], ...]
    """(north, east)."""

    def holds(self, point: Vec3) -> bool:
        """By counting the edges to the east of it."""
        north, east = point[0], point[1]
        odd = False
        for (n1, e1), (n2, e2) in zip(self.corners_m, self.corners_m[1:] + self.corners_m[:1], strict=True):
            if (n1 > north) != (n2 > north) and east < e1 + (north - n1) / (n2 - n1) * (e2 - e1):
                odd = not odd
        return odd


Zone = Circle | Polygon


def check(item: Item, now: Situation) -> int:
    """MAV_MISSION_RESULT of one fence item."""
    if item.command == RETURN_POINT:
        return _ACCEPTED
    if item.command not in (POLYGON_IN, POLYGON_OUT, CIRCLE_IN, CIRCLE_OUT):
        return _UNSUPPORTED
    if item.command in (POLYGON_IN, POLYGON_OUT):
        if not 3 <= item.params[0] <= _POINTS_MAX or item.params[0] != int(item.params[0]):
            return _PARAM1
    elif not _NARROWEST_M <= item.params[0] < 1e5:
        return _PARAM1
    if not math.isfinite(item.x):
        return _X
    if not math.isfinite(item.y):
        return _Y
    found = place(item.frame, item.x, item.y, 0.0, now.origin, now.home_ned_m, now.here)
    if found is None:
        return _FRAME
    if isinstance(found, str):
        if now.origin is None and item.frame != 1:
            return _FRAME
        return _X
    return _ACCEPTED


def zones(items: list[Item], now: Situation) -> list[Zone] | int:
    """The fence that a whole upload describes; MAV_MISSION_RESULT when it describes none."""
    found: list[Zone] = []
    corners: list[tuple[float, float]] = []
    command, size = 0, 0.0
    for item in items:
        if result := check(item, now):
            return result
        if corners and (item.command, item.params[0]) != (command, size):
            return _ERROR
        if item.command == RETURN_POINT:
            continue
        point = place(item.frame, item.x, item.y, 0.0, now.origin, now.home_ned_m, now.here)
        if not isinstance(point, tuple):
            return _X
        if item.command in (CIRCLE_IN, CIRCLE_OUT):
            found.append(Circle(item.command == CIRCLE_IN, point[0], point[1], item.params[0]))
            continue
        command, size = item.command, item.params[0]
        corners.append((point[0], point[1]))
        if len(corners) == int(size):
            if _width_m(corners) < _NARROWEST_M:
                now.say(Severity.WARNING, "Fence: the corners of a polygon lie on one line, it holds nothing")
                return _INVALID
            found.append(Polygon(command == POLYGON_IN, tuple(corners)))
            corners = []
    return _ERROR if corners else found


def _width_m(corners: list[tuple[float, float]]) -> float:
    """How far corners lie from the line through the first and the one farthest from it."""
    north, east = corners[0]
    along = max(((n - north, e - east) for n, e in corners), key=lambda way: math.hypot(*way))
    length = math.hypot(*along)
    return max(abs(along[0] * (e - east) - along[1] * (n - north)) for n, e in corners) / length if length else 0.0


def breach(now: Situation, fence: list[Zone]) -> str:
    """What is crossed, in words; empty while it is where it may be."""
    return "ceiling" if now.here[2] < -(now.ceiling_m - CLEARANCE_M / 2) else beyond(now.here, now, fence)


def beyond(point: Vec3, now: Situation, fence: list[Zone]) -> str:
    """What keeps it from a point, the ceiling aside; empty when it may be there."""
    if now.row.name == "ardupilot":
        if not now.params.get("FENCE_ENABLE"):
            return ""
        kinds = int(now.params.get("FENCE_TYPE"))
        highest = now.params.get("FENCE_ALT_MAX") if kinds & 1 else 0.0
        farthest = now.params.get("FENCE_RADIUS") if kinds & 2 else 0.0
        fence = fence if kinds & 4 else []
    else:
        highest, farthest = now.params.get("GF_MAX_VER_DIST"), now.params.get("GF_MAX_HOR_DIST")
    home = now.home
    if highest and home[2] - point[2] > highest:
        return "maximum altitude"
    if farthest and math.hypot(point[0] - home[0], point[1] - home[1]) > farthest:
        return "maximum distance"
    return _zone(point, fence, now.row.inclusions)


def guards(now: Situation, fence: list[Zone]) -> bool:
    """Whether any fence is watched."""
    if math.isfinite(now.ceiling_m):
        return True
    if now.row.name == "ardupilot":
        return bool(now.params.get("FENCE_ENABLE"))
    return bool(fence or now.params.get("GF_MAX_VER_DIST") or now.params.get("GF_MAX_HOR_DIST"))


def _zone(here: Vec3, fence: list[Zone], inclusions: Literal["all", "any"]) -> str:
    if any(zone.holds(here) for zone in fence if not zone.inside):
        return "exclusion zone"
    inside = [zone.holds(here) for zone in fence if zone.inside]
    kept = all(inside) if inclusions == "all" else any(inside)
    return "" if kept or not inside else "inclusion zone"
