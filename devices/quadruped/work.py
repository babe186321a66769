"""One goal at a time, a step at a time; an order of the traffic to step aside comes before it."""

from collections.abc import Generator
from math import hypot
from typing import Generic, TypeVar

from devices.quadruped import places
from devices.quadruped.body import Body
from devices.quadruped.robot import Robot
from devices.quadruped.skills import SKILLS
from devices.quadruped.walk import Steps, walk
from devices.worker import Outcome, Pose
from wire.frames import distance_m
from wire.messages.command import Command, DeviceCard
from wire.model import Vec2

RADIUS_M, SPEED_MPS, PAYLOAD_KG = 0.38, 0.8, 3.0
ASIDE_AGAIN_M = 0.3
"""An order to step aside that moves by less than this is the same order."""
ASIDE_REACHED_M = 0.4
LONGEST_STEP_S = 0.2
"""More than this between two steps was a pause, which does not count on a skill's clock."""

End = TypeVar("End")


class Pace(Generic[End]):
    """Steps through a generator on a clock that stands while it is not stepped."""

    def __init__(self, body: Body, steps: Generator[None, None, End]) -> None:
        self._body, self._steps = body, steps
        self._clock_s, self._stepped_s = 0.0, body.now_s
        self.ended = False
        self.outcome: End | None = None

    def step(self) -> None:
        """One step; after the last the robot stands."""
        body = self._body
        self._clock_s += min(body.now_s - self._stepped_s, LONGEST_STEP_S)
        self._stepped_s = body.now_s
        body.clock_s = self._clock_s
        if self.ended:
            return
        try:
            next(self._steps)
        except StopIteration as end:
            self.ended, self.outcome = True, end.value
            body.stand()

    def close(self) -> None:
        self._steps.close()


class QuadrupedWorker:
    """Runs one skill at a time, a step at a time; a traffic order to step aside comes before it."""

    def __init__(self, robot: Robot) -> None:
        self._robot, self._body = robot, robot.body
        self._skill: Pace[Outcome] | None = None
        self._aside: Pace[None] | None = None
        self._aside_m: Vec2 | None = None

    def card(self, boot_id: str) -> DeviceCard:
        return DeviceCard(
            id=self._body.id,
            kind="quadruped",
            boot_id=boot_id,
            skills=tuple(skill.card() for skill in SKILLS.values()),
            payload_kg=PAYLOAD_KG,
            radius_m=RADIUS_M,
            speed_mps=SPEED_MPS,
        )

    def fault_of(self, command: Command) -> str:
        skill = SKILLS.get(command.action)
        if skill is None:
            return f"{self._body.id} cannot {command.action}; it can {', '.join(SKILLS)}"
        if command.room is not None and self._robot.room(command.room) is None:
            return f"there is no room {command.room} on the site"
        return skill.fault_of(command)

    def begin(self, command: Command) -> None:
        self._body.goal_id, self._body.note, self._body.fraction = command.goal_id, command.action, 0.0
        self._skill = Pace(self._body, SKILLS[command.action].run(self._robot, command))

    def work(self, now_s: float) -> Outcome | None:
        if self._step_aside() or self._skill is None:
            return None
        self._skill.step()
        return self._skill.outcome

    def idle(self, now_s: float) -> None:
        if not self._step_aside():
            self._body.stand()

    def halt(self) -> None:
        self._body.stand()

    def drop(self) -> None:
        if self._skill is not None:
            self._skill.close()
        self._skill = None
        self._body.stop_waiting()
        self._body.path_m, self._body.behind_other = (), False
        self._body.stand()

    @property
    def committed(self) -> bool:
        return self._body.gripping

    @property
    def pose(self) -> Pose | None:
        body = self._body
        if body.odometry is None:
            return None
        return Pose(
            position_enu_m=body.odometry.position_enu_m,
            yaw_rad=body.odometry.yaw_rad,
            path_m=body.path_m,
            travelled_m=body.travelled_m,
            action_steps=body.action_steps,
            holding=body.holding,
            standing_by_order=not body.may_move,
            held_up=not body.may_move or self._aside_m is not None or body.behind_other,
            holding_type=body.holding_type,
        )

    @property
    def progress(self) -> tuple[float, str]:
        return (self._body.fraction, self._body.note)

    def _step_aside(self) -> bool:
        """Whether this step went into clearing the way for somebody."""
        order = self._body.order
        wanted = order.step_aside_m if order else None
        if wanted is None or self._body.gripping or self._body.odometry is None:
            if self._aside_m is not None:
                # The way aside is over; told of any longer, it would be kept clear for nobody.
                self._aside = self._aside_m = None
                self._body.path_m = ()
                self._body.stand()
            return False
        if self._aside_m is None or hypot(wanted[0] - self._aside_m[0], wanted[1] - self._aside_m[1]) > ASIDE_AGAIN_M:
            self._aside_m, self._aside = wanted, Pace(self._body, self._clear_the_way(wanted))
        if self._aside is not None:
            self._aside.step()
        return True

    def _clear_the_way(self, point_m: Vec2) -> Steps:
        """To the point, or when something unknown to the traffic stands there, somewhere else out of the way."""
        body = self._body
        yield from walk(body, lambda: places.near_point(body.floor, point_m), around=True)
        if distance_m(body.position_m, point_m) > ASIDE_REACHED_M:
            yield from walk(body, lambda: places.away_from(body.floor, body.others_m), around=True)
