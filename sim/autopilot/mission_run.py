"""Flying a mission item by item."""

import math
from dataclasses import dataclass

from sim.autopilot.flying import REACHED_M, Activity, Circle, Climb, Descend, GoHome, Hover, Travel
from sim.autopilot.interface import Command, Item, Severity
from sim.autopilot.legs import Gate, Landing, ThenHeight
from sim.autopilot.mission import (
    DELAY,
    GATE,
    JUMP,
    LAND,
    LAND_START,
    LOITER,
    LOITER_TIME,
    LOITER_TO_HEIGHT,
    LOITER_TURNS,
    PAYLOAD,
    REGION,
    REGION_AT,
    REGION_NONE,
    RETURN,
    SET_HOME,
    SPEED,
    SPLINE,
    TAKEOFF,
    YAW,
    Mission,
    spot,
)
from sim.autopilot.situation import LOWEST_FLIGHT_M, Situation
from sim.autopilot.spline import Curve, leaving
from sim.flight.state import Setpoint, Vec3

_LOITER_RADIUS_M = 1.0
_ON_GROUND = frozenset({TAKEOFF, LAND, RETURN, DELAY})


@dataclass(slots=True)
class MissionRun:
    """From the mission's current item on. Takes off first when the items do not say so; hovers when all are done."""

    mission: Mission
    leg: Activity | None = None
    _rest: Activity | None = None
    _begun: tuple[int, int] = (-1, -1)
    """Edition of the mission and number of the item that the leg belongs to."""
    _lifting: bool = False
    _stay_s: float = 0.0
    _done_s: float | None = None
    _nose_rad: float | None = None
    paused: bool = False

    @property
    def done(self) -> bool:
        return self.mission.finished

    @property
    def place_ned_m(self) -> Vec3 | None:
        leg = self.leg or self._rest
        return getattr(leg, "place_ned_m", None)

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if self.paused:
            self.leg = None
            return self._hover(now, now_s)
        mission = self.mission
        if self.leg is not None and self._begun != (mission.edition, mission.current):
            self.leg = self._rest = None  # another item was made the current one
        if mission.finished and self.leg is None:
            return self._hover(now, now_s)
        for _ in range(len(mission.items) + 1):
            if self.leg is not None or mission.finished:
                break
            self._begin(mission.items[mission.current], now)
        if self.leg is None:
            if not mission.finished:
                now.say(Severity.WARNING, "Mission: no item of it flies anywhere")
                mission.finished = True
            return self._hover(now, now_s)
        setpoint = self.leg.step(now, now_s)
        self._rest = None
        if not self.leg.done:
            self._done_s = None
        elif self._done_s is None:
            self._done_s = now_s
        if self._done_s is not None and now_s - self._done_s >= self._stay_s:
            self._end()
        return setpoint

    def _end(self) -> None:
        self._rest, self.leg, self._done_s = self.leg, None, None
        if isinstance(self._rest, Circle | GoHome):
            self._rest = None
        if self._lifting:
            self._lifting = False
        else:
            self.mission.advance()

    def _hover(self, now: Situation, now_s: float) -> Setpoint:
        self._rest = self._rest or Hover()
        return self._rest.step(now, now_s)

    def _begin(self, item: Item, now: Situation) -> None:
        self._begun = (self.mission.edition, self.mission.current)
        self._stay_s, self._done_s = 0.0, None
        if item.command == JUMP:
            self.mission.jump(item)
        elif item.command in PAYLOAD:
            now.payload.append(Command(item.command, item.params, item.x, item.y, item.z, item.frame))
            self.mission.advance()
        elif item.command == LAND_START or (item.command == GATE and self._onward(now, now.here[2]) is None):
            # The one says where the landing begins to those who read the mission; the other leads nowhere.
            self.mission.advance()
        elif item.command in (YAW, SPEED, SET_HOME, REGION_AT, REGION_NONE, REGION):
            self._set(item, now)
            self.mission.advance()
        elif now.vehicle.on_ground and item.command not in _ON_GROUND:
            height = now.params.get("MIS_TAKEOFF_ALT", 1.0)
            self._lifting, self.leg = True, Climb(now.below_ceiling((0.0, 0.0, now.above_start(height)))[2])
        else:
            self.leg = self._activity(item, now)

    def _activity(self, item: Item, now: Situation) -> Activity:
        if item.command == RETURN:
            return GoHome()
        if item.command == DELAY:
            self._stay_s = item.params[0]
            return Hover()
        found = spot(item, now)
        target = found if isinstance(found, tuple) else now.here
        if item.command == LAND:
            return Landing(Travel((target[0], target[1], now.here[2]), now.quantity("acceptance_m")), Descend())
        if item.command == TAKEOFF:
            lowest = now.above_start(LOWEST_FLIGHT_M) if now.vehicle.on_ground else now.home[2] - LOWEST_FLIGHT_M
            down = min(target[2], lowest)
            return Climb(now.below_ceiling((0.0, 0.0, down))[2])
        if item.command == GATE:
            onward = self._onward(now, now.here[2]) or now.here
            return Gate(target, Travel(onward, now.quantity("acceptance_m"), self._nose(item, onward, now)))
        target = now.below_ceiling(now.above_floor(target))
        if item.command == LOITER_TO_HEIGHT:
            radius = now.quantity("acceptance_m")
            return ThenHeight(Travel((target[0], target[1], now.here[2]), radius), Travel(target, REACHED_M))
        if item.command == LOITER_TURNS:
            radius = item.params[2] if math.isfinite(item.params[2]) and item.params[2] else _LOITER_RADIUS_M
            return Circle(target, max(-50.0, min(50.0, radius)), min(1.0, now.cruise_mps), item.params[0])
        if item.command == LOITER:
            self._stay_s = math.inf
        elif math.isfinite(item.params[0]):
            self._stay_s = item.params[0]
        radius = now.quantity("acceptance_m")
        if item.command == SPLINE:
            return Curve(target, radius, self._leaving(target, now), self._nose_rad)
        if item.command != LOITER_TIME and 0.0 < item.params[1] < 50.0:
            radius = max(0.05, item.params[1])
        return Travel(target, radius, self._nose(item, target, now))

    def _onward(self, now: Situation, down_m: float) -> Vec3 | None:
        """Where it will fly to after the current item, if nothing stops it before; to a landing at this height."""
        item = self.mission.following()
        found = None if item is None else spot(item, now)
        if item is None or not isinstance(found, tuple):
            return None
        return now.below_ceiling(now.above_floor((found[0], found[1], down_m if item.command == LAND else found[2])))

    def _leaving(self, target: Vec3, now: Situation) -> Vec3:
        """The slope of a spline at its end."""
        item = self.mission.following()
        onward = None if self._stay_s > 0.0 else self._onward(now, target[2])
        return leaving(now.here, target, onward, item is not None and item.command == SPLINE)

    def _nose(self, item: Item, target: Vec3, now: Situation) -> float | None:
        """PX4's waypoints may say a heading; else CONDITION_YAW's, else along the way."""
        if now.row.name == "px4" and abs(item.params[3]) <= 360.0:
            return math.remainder(math.radians(item.params[3]), math.tau)
        if self._nose_rad is not None:
            return self._nose_rad
        north, east = target[0] - now.here[0], target[1] - now.here[1]
        return math.atan2(east, north) if math.hypot(north, east) > 0.5 else None

    def _set(self, item: Item, now: Situation) -> None:
        if item.command == SPEED:
            now.speed_mps = item.params[1] if item.params[1] > 0 else None
        elif item.command == YAW:
            offset = now.estimate.heading_rad if item.params[3] == 1 else 0.0
            hand = -1.0 if item.params[3] == 1 and item.params[2] == -1 else 1.0
            self._nose_rad = math.remainder(offset + hand * math.radians(item.params[0]), math.tau)
        elif item.command == SET_HOME and item.params[0] != 1:
            found = spot(item, now)
            now.home_ned_m, now.home_kept = (
                (found, True) if isinstance(found, tuple) else (now.home_ned_m, now.home_kept)
            )
        elif item.command == SET_HOME:
            now.home_ned_m, now.home_kept = now.here, True
        else:
            found = None if item.command == REGION_NONE else spot(item, now)
            now.region_ned_m = found if isinstance(found, tuple) else None
