"""A quadruped's process without its shell: the device that takes goals, the body that does them."""

from collections.abc import Sequence
from math import hypot

from devices.device import Device
from devices.goals_journal import GoalsJournal
from devices.quadruped import places
from devices.quadruped.body import Body
from devices.quadruped.map import FloorMap
from devices.quadruped.moves import Skilled
from devices.quadruped.robot import Robot
from devices.quadruped.skills import SKILLS
from devices.quadruped.walk import Steps, walk
from devices.worker import Outcome, Pose
from wire.bus import Event, Node, Received
from wire.messages.command import Command, DeviceCard
from wire.model import Vec2
from wire.site import Site

CONTROL_S = 0.05
EARLY_S = 1e-6
RADIUS_M, SPEED_MPS, PAYLOAD_KG = 0.38, 0.8, 3.0
ASIDE_AGAIN_M = 0.3
"""An order to step aside that moves by less than this is the same order."""


class QuadrupedWorker:
    """Runs one skill at a time, a step at a time; a traffic order to step aside comes before it."""

    def __init__(self, robot: Robot, boot_id: str) -> None:
        self._robot, self._body, self._boot_id = robot, robot.body, boot_id
        self._skill: Skilled | None = None
        self._aside: Steps | None = None
        self._aside_m: Vec2 | None = None

    def card(self) -> DeviceCard:
        return DeviceCard(
            id=self._body.id,
            kind="quadruped",
            boot_id=self._boot_id,
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
        self._body.note, self._body.fraction = command.action, 0.0
        self._skill = SKILLS[command.action].run(self._robot, command)

    def work(self, now_s: float) -> Outcome | None:
        if self._step_aside() or self._skill is None:
            return None
        try:
            next(self._skill)
        except StopIteration as end:
            outcome: Outcome = end.value
            return outcome
        return None

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
        self._body.path_m = ()
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
        )

    @property
    def progress(self) -> tuple[float, str]:
        return (self._body.fraction, self._body.note)

    def _step_aside(self) -> bool:
        """Whether this step went into clearing the way for somebody."""
        order = self._body.order
        wanted = order.step_aside_m if order else None
        if wanted is None or self._body.gripping or self._body.odometry is None:
            self._aside = self._aside_m = None
            return False
        if self._aside_m is None or hypot(wanted[0] - self._aside_m[0], wanted[1] - self._aside_m[1]) > ASIDE_AGAIN_M:
            self._aside_m, self._aside = wanted, self._clear_the_way(wanted)
        if self._aside is not None:
            self._aside = self._aside if next(self._aside, _THROUGH) is None else None
        if self._aside is None:
            self._body.stand()
        return True

    def _clear_the_way(self, point_m: Vec2) -> Steps:
        yield from walk(self._body, lambda: places.near_point(self._body.floor, point_m))


_THROUGH = object()


class QuadrupedCore:
    """See wire.bus.Core."""

    def __init__(self, site: Site, id: str, boot_id: str, journal: GoalsJournal) -> None:
        row = next((robot for robot in site.robot if robot.id == id), None)
        if row is None:
            raise ValueError(f"the site has no robot {id}: add a [[robot]] table with this id to the site file")
        self._id = id
        self._hub_ids = [process.id for process in site.process if process.role == "hub"]
        self._body = Body(id, FloorMap(site))
        worker = QuadrupedWorker(Robot(self._body, site), boot_id)
        self._device = Device(id, boot_id, worker, journal, row.lost_hub_s)
        self._journal = journal
        self._control_due_s = 0.0

    def start(self, node: Node) -> None:
        self._node = node
        for topic in ("odometry", "scan", "gripper_state", "traffic"):
            node.subscribe(topic, self._id)
        for hub_id in self._hub_ids:
            node.subscribe("health", hub_id)
        self._device.start(node)

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self._body.now_s = now_s
        for event in events:
            if isinstance(event, Received):
                self._body.hear(event.message)
            self._device.hear(event, now_s)
        if now_s < self._control_due_s - EARLY_S:
            return
        self._control_due_s = now_s + CONTROL_S
        self._device.step(now_s)
        if self._body.odometry is not None:
            self._body.publish(self._node)

    def stop(self) -> None:
        self._body.stand()
        if self._body.odometry is not None:
            self._body.publish(self._node)
        self._journal.close()
