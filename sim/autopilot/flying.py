"""What the vehicle does in each mode that flies by itself: hover, climb, descend, return, orbit."""

import math
from dataclasses import dataclass, field
from typing import Protocol

from sim.autopilot.situation import LOWEST_FLIGHT_M, Situation
from sim.flight.state import FREE, Off, Setpoint, Trajectory, Vec3

REACHED_M = 0.15
"""A height is reached when this close."""


class Activity(Protocol):
    """What goes on until something else does. `step` gives the setpoint of this moment."""

    def step(self, now: Situation, now_s: float) -> Setpoint: ...

    @property
    def done(self) -> bool:
        """It has come to its end and hovers, or stands on the ground."""
        ...


@dataclass(slots=True)
class Hover:
    """Stay at a place, or where it is when it begins; on the ground, stay there with idle rotors."""

    place_ned_m: Vec3 | None = None
    heading_rad: float | None = None
    speed_mps: float | None = None
    done: bool = True

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if now.vehicle.on_ground:
            return Off()
        if not now.estimate.position_ok:
            return blind(now, 0.0)
        if self.place_ned_m is None:
            self.place_ned_m = braked(now)
        return travel(now, self.place_ned_m, self.heading_rad, self.speed_mps)


@dataclass(slots=True)
class Travel:
    """Go to a place; done once within a radius of it, and then stay."""

    place_ned_m: Vec3
    radius_m: float
    heading_rad: float | None = None
    done: bool = False

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if now.vehicle.on_ground:
            return Off()
        if not now.estimate.position_ok:
            return blind(now, 0.0)
        target = now.below_ceiling(self.place_ned_m)
        self.done = self.done or math.dist(now.here, target) < self.radius_m
        return travel(now, target, self.heading_rad)


@dataclass(slots=True)
class Climb:
    """Take off to a height given as a down coordinate, straight up from where it stands."""

    down_m: float
    heading_rad: float | None = None
    done: bool = False
    _start: Vec3 | None = None

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if self._start is None:
            self._start = now.here
            if self.heading_rad is None:
                self.heading_rad = now.estimate.heading_rad
        place = (self._start[0], self._start[1], self.down_m)
        self.done = self.done or (not now.vehicle.on_ground and now.here[2] < self.down_m + REACHED_M)
        return travel(now, place, self.heading_rad)

    @property
    def place_ned_m(self) -> Vec3 | None:
        return None if self._start is None else (self._start[0], self._start[1], self.down_m)


@dataclass(slots=True)
class Descend:
    """Land at a place, or where it is when it begins."""

    place_ned_m: Vec3 | None = None
    heading_rad: float | None = None
    done: bool = False

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if now.vehicle.on_ground:
            self.done = True
            return Off()
        self.done = False
        down_mps = now.quantity("landing_mps")
        if not now.estimate.position_ok:
            self.place_ned_m = None
            return blind(now, down_mps)
        if self.place_ned_m is None:
            self.place_ned_m = braked(now)
        if self.heading_rad is None:
            self.heading_rad = now.estimate.heading_rad
        north, east, _ = self.place_ned_m
        return Trajectory(
            (north, east, None), (None, None, down_mps), FREE, self.heading_rad, max_speed_mps=now.cruise_mps
        )


@dataclass(slots=True)
class GoHome:
    """Climb to the return height, fly home or to a rally point, wait, land; without a position, land."""

    landing: Descend = field(default_factory=Descend)
    place_ned_m: Vec3 | None = None
    _refuge_ned_m: Vec3 | None = None
    _leg: str = "climb"
    _height_down_m: float | None = None
    _since_s: float = 0.0

    @property
    def done(self) -> bool:
        return self._leg == "land" and self.landing.done

    @property
    def landing_now(self) -> bool:
        return self._leg == "land"

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if now.vehicle.on_ground or not now.estimate.position_ok:
            self._leg = "land"
        if self._leg == "land":
            return self.landing.step(now, now_s)
        home = self._refuge_ned_m = self._refuge_ned_m or now.refuge_ned_m
        if self._height_down_m is None:
            height = max(now.quantity("return_height_m"), LOWEST_FLIGHT_M)
            down = min(now.home[2] - height, now.here[2])
            self._height_down_m = now.lowered((home[0], home[1], down), "Return")[2]
            self.place_ned_m = braked(now)
        start = self.place_ned_m or now.here
        place = (start[0], start[1], self._height_down_m)
        if self._leg != "climb":
            place = (home[0], home[1], self._height_down_m)
        near = math.dist(now.here, place) < max(REACHED_M, now.quantity("acceptance_m"))
        if near and self._leg == "climb":
            self._leg = "home"
        elif near and self._leg == "home":
            self._leg, self._since_s = "wait", now_s
        elif self._leg == "wait" and now_s - self._since_s >= self._wait_s(now):
            self._leg, self.landing = "land", Descend((home[0], home[1], home[2]))
        return travel(now, place, None, self._speed_mps(now))

    @staticmethod
    def _wait_s(now: Situation) -> float:
        if now.row.name == "ardupilot":
            return now.params.get("RTL_LOIT_TIME") / 1000
        delay = now.params.get("RTL_LAND_DELAY")
        return math.inf if delay < 0 else delay

    @staticmethod
    def _speed_mps(now: Situation) -> float | None:
        asked = now.params.get("RTL_SPEED", 0.0) / 100
        return asked or None


@dataclass(slots=True)
class Circle:
    """Fly around a centre at a radius and speed, nose inwards; a negative radius turns left."""

    centre_ned_m: Vec3
    radius_m: float
    speed_mps: float
    turns: float = math.inf
    done: bool = False
    _turned_rad: float = 0.0
    _bearing_rad: float | None = None

    @property
    def place_ned_m(self) -> Vec3:
        return self.centre_ned_m

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if now.vehicle.on_ground:
            return Off()
        if not now.estimate.position_ok:
            return blind(now, 0.0)
        radius, hand = abs(self.radius_m), math.copysign(1.0, self.radius_m)
        north, east = now.here[0] - self.centre_ned_m[0], now.here[1] - self.centre_ned_m[1]
        bearing = math.atan2(east, north)
        on_it = abs(math.hypot(north, east) - radius) < 0.3 + 0.2 * radius
        if self._bearing_rad is not None and on_it:
            change = math.remainder(bearing - self._bearing_rad, math.tau)
            self._turned_rad += hand * change
        self._bearing_rad = bearing
        self.done = self.done or self._turned_rad >= self.turns * math.tau
        out = (math.cos(bearing), math.sin(bearing))
        place = (self.centre_ned_m[0] + radius * out[0], self.centre_ned_m[1] + radius * out[1], self.centre_ned_m[2])
        pace = self.speed_mps * hand if on_it and not self.done else 0.0
        speed = (-out[1] * pace, out[0] * pace, None)
        nose = math.remainder(bearing + math.pi, math.tau)
        return Trajectory(
            place, speed, FREE, nose, None, max(now.cruise_mps, self.speed_mps),
            now.quantity("climb_mps"), now.quantity("descent_mps"),
        )  # fmt: skip


def travel(now: Situation, place_ned_m: Vec3, heading_rad: float | None, speed_mps: float | None = None) -> Trajectory:
    """Towards a place at this firmware's speeds, nose to the region of interest if there is one."""
    nose = now.towards_region()
    return Trajectory(
        now.below_ceiling(place_ned_m),
        heading_rad=heading_rad if nose is None else nose,
        max_speed_mps=now.cruise_mps if speed_mps is None else speed_mps,
        max_climb_mps=now.quantity("climb_mps"),
        max_descent_mps=now.quantity("descent_mps"),
    )


def braked(now: Situation) -> Vec3:
    """Where it comes to rest when it brakes now."""
    vn, ve, vd = now.estimate.velocity_ned_mps
    speed = math.hypot(vn, ve)
    stretch = min(speed, 5.0) / (2 * 1.6)
    north, east, down = now.here
    return now.below_ceiling((north + vn * stretch, east + ve * stretch, min(down + 0.2 * vd, -0.1)))


def blind(now: Situation, down_mps: float) -> Trajectory:
    """Level without a position: what is believed of the velocity across is taken as wished, so that it is not fought."""
    vn, ve, _ = now.estimate.velocity_ned_mps
    return Trajectory(FREE, (vn, ve, down_mps), FREE, now.estimate.heading_rad)
