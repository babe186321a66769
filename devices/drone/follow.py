"""Along a course at the pace at which the drone gets on: where to be now, and how fast."""

from math import dist

from devices.drone.course import Course
from wire.frames import wrap_rad
from wire.model import Vec3

RAMP_S = 1.0
"""From full speed to a stand and back, when it has to wait."""
LATE_M = 1.0
"""Further than this from where it should be, time on the course stands."""
LONGEST_STEP_S = 0.2
ARRIVED_M = 0.2
TURN_RADPS = 0.9


class Follower:
    """`clock_s` is the time on the course: it runs slower, and stands, while the drone may not move or is late."""

    def __init__(self, course: Course, now_s: float) -> None:
        self.course = course
        self.clock_s, self._rate, self._stepped_s = 0.0, 0.0, now_s
        self.late_s = 0.0
        """How long it has been too far from where it should be, or beside the end."""

    def step(self, now_s: float, position_m: Vec3, go: bool) -> tuple[Vec3, Vec3]:
        """(position_enu_m, velocity_enu_mps) to be sent now."""
        passed_s = min(max(0.0, now_s - self._stepped_s), LONGEST_STEP_S)
        self._stepped_s = now_s
        late = dist(position_m, self.course.at(self.clock_s)[0]) > LATE_M
        beside = self.ended and not self.arrived(position_m)
        self.late_s = self.late_s + passed_s if late or beside else 0.0
        wanted = 1.0 if go and not late else 0.0
        most = passed_s / RAMP_S
        rate = self._rate + max(-most, min(most, wanted - self._rate))
        self.clock_s = min(self.course.duration_s, self.clock_s + passed_s * (self._rate + rate) / 2.0)
        self._rate = rate
        position, velocity = self.course.at(self.clock_s)
        return position, (velocity[0] * rate, velocity[1] * rate, velocity[2] * rate)

    def stand(self, now_s: float) -> None:
        """It has come to a stand at `stop_m` meanwhile, and goes on from there."""
        self.clock_s, self._rate, self._stepped_s = self._stop_s, 0.0, now_s
        self.late_s = 0.0

    @property
    def stop_m(self) -> Vec3:
        """Where it would come to a stand on the course."""
        return self.course.at(self._stop_s)[0]

    @property
    def ended(self) -> bool:
        return self.clock_s >= self.course.duration_s

    def arrived(self, position_m: Vec3) -> bool:
        return self.ended and dist(position_m, self.course.end_m) < ARRIVED_M

    @property
    def fraction(self) -> float:
        return 1.0 if self.course.duration_s <= 0.0 else self.clock_s / self.course.duration_s

    @property
    def _stop_s(self) -> float:
        return min(self.course.duration_s, self.clock_s + self._rate**2 * RAMP_S / 2.0)


def turned(yaw_rad: float, wanted_rad: float, passed_s: float) -> float:
    """A yaw after turning towards another for a while, the shorter way round."""
    most = TURN_RADPS * passed_s
    return wrap_rad(yaw_rad + max(-most, min(most, wrap_rad(wanted_rad - yaw_rad))))
