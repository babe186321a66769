"""Parts of a mission that take two steps, or end before what they fly to."""

from dataclasses import dataclass

from sim.autopilot.flying import Descend, Travel
from sim.autopilot.situation import Situation
from sim.flight.state import Setpoint, Vec3


@dataclass(slots=True)
class Gate:
    """Fly on to the next place; done across the line through the gate, at right angles to the way from it to there."""

    gate_ned_m: Vec3
    way: Travel
    done: bool = False

    @property
    def place_ned_m(self) -> Vec3:
        return self.way.place_ned_m

    def step(self, now: Situation, now_s: float) -> Setpoint:
        north, east, _ = self.gate_ned_m
        onward = (self.way.place_ned_m[0] - north, self.way.place_ned_m[1] - east)
        passed = (now.here[0] - north) * onward[0] + (now.here[1] - east) * onward[1]
        self.done = self.done or (now.estimate.position_ok and passed >= 0.0)
        return self.way.step(now, now_s)


@dataclass(slots=True)
class ThenHeight:
    """Go above or below a place as high as it is, then straight to the place's height."""

    way: Travel
    rise: Travel

    @property
    def done(self) -> bool:
        return self.rise.done

    @property
    def place_ned_m(self) -> Vec3:
        return self.rise.place_ned_m

    def step(self, now: Situation, now_s: float) -> Setpoint:
        return (self.rise if self.way.done else self.way).step(now, now_s)


@dataclass(slots=True)
class Landing:
    """Go above a place, then land there."""

    way: Travel
    landing: Descend

    @property
    def done(self) -> bool:
        return self.landing.done

    @property
    def place_ned_m(self) -> Vec3:
        return self.way.place_ned_m

    def step(self, now: Situation, now_s: float) -> Setpoint:
        if not self.way.done and not now.vehicle.on_ground and now.estimate.position_ok:
            setpoint = self.way.step(now, now_s)
            if self.way.done:
                self.landing.place_ned_m = self.way.place_ned_m
            return setpoint
        return self.landing.step(now, now_s)
