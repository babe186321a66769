"""The three stores that ground stations upload to and download from: mission, fence, rally points."""

from sim.autopilot import fence, mission
from sim.autopilot.interface import Item, Plan, Severity
from sim.autopilot.mission import Mission
from sim.autopilot.situation import Situation

_WAYPOINT, _GLOBAL_INT, _LOCAL = 16, 5, 1


class Plans:
    """By MAV_MISSION_TYPE; results are MAV_MISSION_RESULT."""

    def __init__(self, now: Situation) -> None:
        self._now = now
        self.mission = Mission(1 if now.row.home_is_item_0 else 0)
        self.fence: list[fence.Zone] = []
        self._fence: list[Item] = []
        self._rally: list[Item] = []

    def items(self, kind: Plan) -> list[Item]:
        if kind == 1:
            return list(self._fence)
        if kind == 2:
            return list(self._rally)
        return [self._home(), *self.mission.items[1:]] if self.mission.first else list(self.mission.items)

    def check(self, kind: Plan, item: Item) -> int:
        if kind == 1:
            return fence.check(item, self._now)
        if kind == 2:
            return mission.check_rally(item, self._now)
        if item.seq < self.mission.first:
            return mission.ACCEPTED  # home, which is not taken from an upload
        return mission.check(item, self._now)

    def accept(self, kind: Plan, items: list[Item]) -> int:
        for item in items:
            if result := self.check(kind, item):
                return result
        if kind == 0:
            result = self.mission.take(list(items))
            if result == mission.ACCEPTED:
                self._warn_of_ceiling()
            return result
        if [item.seq for item in items] != list(range(len(items))):
            return mission.SEQUENCE
        if kind == 2:
            self._rally = list(items)
            spots = [mission.spot(item, self._now) for item in items]
            self._now.rally_ned_m = tuple(spot for spot in spots if isinstance(spot, tuple))
            return mission.ACCEPTED
        zones = fence.zones(items, self._now)
        if isinstance(zones, int):
            return zones
        self.fence, self._fence = zones, list(items)
        if self._now.row.name == "ardupilot":
            self._now.params.put("FENCE_TOTAL", min(len(items), 1000))
        return mission.ACCEPTED

    def _home(self) -> Item:
        now, home = self._now, self._now.home
        if now.origin is None:
            return Item(0, _LOCAL, _WAYPOINT, False, True, (0.0, 0.0, 0.0, 0.0), *home)
        latitude, longitude = now.origin.globe(home[0], home[1])
        altitude = now.origin.altitude_m - home[2]
        return Item(0, _GLOBAL_INT, _WAYPOINT, False, True, (0.0, 0.0, 0.0, 0.0), latitude, longitude, altitude)

    def _warn_of_ceiling(self) -> None:
        now = self._now
        for item in self.mission.items[self.mission.first :]:
            if item.command in mission.FLOWN_TO:
                found = mission.spot(item, now)
                if isinstance(found, tuple) and found[2] < now.top_down_m:
                    now.say(Severity.WARNING, f"Mission: item {item.seq} is flown lower, below the ceiling")
                    return
