"""S^R of equation 1: every robot as it reports itself, with what the hub knows it carries."""

from math import hypot, inf

from hub.ability import Ability
from hub.floor import FloorPlan
from wire.frames import yaw_deg
from wire.messages.command import DeviceCard, RobotReport
from wire.messages.plan import SkillCard
from wire.messages.world import RobotState, RobotStatus
from wire.model import Vec2, Vec3

_LOST_S = 3.0
_BODY_M = 0.45
_BODY_HEIGHT_M = 0.55
_FLYER_HALF_M = 0.35
"""Above and below what flies."""
_MEET_S = 4.0
_AGAIN_S = 1.0
"""A robot of which nothing changes is shown again after this."""


class Robot:
    """One robot. `skills` and the body come from its card; the rest from its reports."""

    __slots__ = (
        "action_steps",
        "airborne",
        "announced",
        "battery",
        "card",
        "endurance_s",
        "goal_id",
        "holding",
        "holding_type",
        "home_m",
        "id",
        "inventory",
        "path_heights_m",
        "path_m",
        "position_m",
        "present",
        "shown",
        "stamp_s",
        "status",
        "told",
        "travelled_m",
        "velocity_mps",
        "yaw_rad",
    )

    def __init__(self, id: str) -> None:
        self.id = id
        self.card: DeviceCard | None = None
        self.position_m: Vec3 = (0.0, 0.0, 0.0)
        self.yaw_rad = 0.0
        self.status: RobotStatus = "lost"
        self.present = self.announced = False
        """It reports; it has said what it can, and has not gone since."""
        self.holding = False
        self.holding_type: str | None = None
        self.inventory: str | None = None
        self.goal_id: str | None = None
        self.path_m: tuple[Vec2, ...] = ()
        self.path_heights_m: tuple[float, ...] = ()
        """Of what flies: how high it will be at each point of its path."""
        self.airborne = False
        self.battery: float | None = None
        self.endurance_s: float | None = None
        """How long a full battery lasts, where the robot knows."""
        self.velocity_mps: Vec3 = (0.0, 0.0, 0.0)
        self.home_m: Vec2 | None = None
        """Where what flies last stood on the ground."""
        self.travelled_m = 0.0
        self.action_steps = 0
        self.stamp_s = -1.0
        self.shown: RobotState | None = None
        self.told: tuple[object, ...] | None = None
        """The facts when somebody last looked for changes."""

    @property
    def xy(self) -> Vec2:
        return (self.position_m[0], self.position_m[1])

    @property
    def facts(self) -> tuple[object, ...]:
        """All that a reader is told, apart from when it was said."""
        return (
            self.position_m, self.yaw_rad, self.status, self.inventory, self.goal_id, self.path_m, self.travelled_m,
            self.action_steps, self.card, self.airborne, self.battery,
        )  # fmt: skip

    @property
    def skills(self) -> tuple[str, ...]:
        return tuple(skill.name for skill in self.card.skills) if self.card is not None else ()

    @property
    def ability(self) -> Ability:
        payload_kg = self.card.payload_kg if self.card is not None else 0.0
        parameters = {skill.name: skill.parameters for skill in self.card.skills} if self.card is not None else {}
        return Ability(self.skills, payload_kg if payload_kg > 0.0 else inf, parameters)

    @property
    def flies(self) -> bool:
        return "take_off" in self.skills and "land" in self.skills

    @property
    def full_handed(self) -> bool:
        """Whether it carries something, known or not."""
        return self.holding or self.inventory is not None

    @property
    def speed_mps(self) -> float:
        """As its card says; nought where it does not."""
        return self.card.speed_mps if self.card is not None else 0.0

    @property
    def radius_m(self) -> float:
        return self.card.radius_m if self.card is not None and self.card.radius_m > 0.0 else 0.38


class Fleet:
    """All robots that have been heard of."""

    def __init__(self, floor: FloorPlan) -> None:
        self._floor = floor
        self.robots: dict[str, Robot] = {}

    def robot(self, id: str) -> Robot:
        known = self.robots.get(id)
        if known is None:
            known = self.robots[id] = Robot(id)
        return known

    def take(self, report: RobotReport) -> Robot:
        robot = self.robot(report.robot)
        robot.position_m, robot.yaw_rad = report.position_enu_m, report.yaw_rad
        robot.status, robot.holding, robot.goal_id = report.status, report.holding, report.goal_id
        robot.path_m, robot.holding_type = report.path_m, report.holding_type
        robot.travelled_m, robot.action_steps = report.travelled_m, report.action_steps
        robot.airborne, robot.battery, robot.path_heights_m = report.airborne, report.battery, report.path_heights_m
        robot.endurance_s = report.endurance_s
        robot.velocity_mps = report.velocity_enu_mps or (0.0, 0.0, 0.0)
        robot.home_m = robot.home_m if report.airborne else robot.xy
        robot.stamp_s, robot.present = report.stamp_s, True
        return robot

    def take_card(self, card: DeviceCard) -> None:
        robot = self.robot(card.id)
        robot.card, robot.announced = card, True

    def gone(self, id: str) -> None:
        """Its process went away."""
        if id in self.robots:
            self.robots[id].present = self.robots[id].announced = False
            self.robots[id].status = "lost"

    def check(self, now_s: float) -> list[str]:
        """Robots that have fallen silent since the last look."""
        silent = [r.id for r in self.robots.values() if r.present and now_s - r.stamp_s > _LOST_S]
        for id in silent:
            self.gone(id)
        return silent

    def met(self, waited_s: float) -> bool:
        """Whether every robot has announced itself and heard of the hub; one that never does is not waited for."""
        there = [r for r in self.robots.values() if r.present or r.announced]
        ready = bool(there) and all(r.present and r.card is not None and r.status != "lost" for r in there)
        return ready or waited_s > _MEET_S

    def near(self, point_enu_m: Vec3) -> bool:
        """Whether a robot's body is at this place."""
        return any(_body_at(robot, point_enu_m) for robot in self.here())

    def here(self) -> list[Robot]:
        """Robots that have not gone away."""
        return [r for r in self.robots.values() if r.present]

    def at_work(self) -> bool:
        """Whether a robot has a goal or is on its way."""
        return any(r.goal_id is not None or r.path_m for r in self.here())

    def abilities(self) -> dict[str, Ability]:
        return {r.id: r.ability for r in self.here()}

    def skills(self) -> tuple[SkillCard, ...]:
        """What those who are there have announced, each skill once."""
        there = sorted(self.here(), key=lambda r: r.id)
        return tuple(dict.fromkeys(skill for r in there if r.card is not None for skill in r.card.skills))

    def able(self) -> dict[str, str]:
        """What can be done now, and by whom, for one."""
        there = (robot for robot in self.here() if robot.status not in ("lost", "fault"))
        return {name: robot.id for robot in there for name in robot.skills}

    def states(self) -> tuple[RobotState, ...]:
        return tuple(self._state(robot) for robot in self._ordered())

    def changes(self) -> tuple[RobotState, ...]:
        """Robots that a reader would see differently than at the last call."""
        changed = []
        for robot in self._ordered():
            facts = robot.facts
            if robot.shown is not None and facts == robot.told and robot.stamp_s - robot.shown.stamp_s <= _AGAIN_S:
                continue
            robot.told, state = facts, self._state(robot)
            if robot.shown is None or _differs(robot.shown, state):
                robot.shown = state
                changed.append(state)
        return tuple(changed)

    def _ordered(self) -> list[Robot]:
        return [self.robots[id] for id in sorted(self.robots) if self.robots[id].stamp_s >= 0.0]

    def _state(self, robot: Robot) -> RobotState:
        return RobotState(
            id=robot.id,
            kind=robot.card.kind if robot.card is not None else "robot",
            position_enu_m=robot.position_m,
            yaw_deg=yaw_deg(robot.yaw_rad),
            status=robot.status,
            inventory=robot.inventory,
            skills=robot.skills,
            stamp_s=robot.stamp_s,
            room=self._floor.room_at(*robot.xy),
            path_m=robot.path_m,
            goal_id=robot.goal_id,
            travelled_m=robot.travelled_m,
            action_steps=robot.action_steps,
            airborne=robot.airborne,
            battery=round(robot.battery, 2) if robot.battery is not None else None,
        )


def _body_at(robot: Robot, point_enu_m: Vec3) -> bool:
    """On the floor a body reaches up from it; in the air it is around where the robot is, and the floor is free."""
    x, y, z = point_enu_m
    bx, by, bz = robot.position_m
    tall = abs(z - bz) < _FLYER_HALF_M if robot.airborne else z < _BODY_HEIGHT_M
    return tall and hypot(bx - x, by - y) < _BODY_M


def _differs(a: RobotState, b: RobotState) -> bool:
    return a.model_copy(update={"stamp_s": b.stamp_s}) != b or b.stamp_s - a.stamp_s > _AGAIN_S
