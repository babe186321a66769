"""The robots' arms: one hand each, busy for as long as an action takes, and an answer for every command."""

from dataclasses import dataclass

from sim.deeds import Deed
from sim.manipulation import DURATION_S, RULES, Attempt
from sim.physics import Physics
from sim.reaching import Refused, Stance, check_reach, resolve
from sim.scene import Body, Scene, Vec3
from wire.frames import body_to_enu
from wire.messages.driver import GripperCommand, GripperState

HOLD_FLU_M: Vec3 = (0.52, 0.0, 0.74)
"""Where the hand carries things, in the body's frame: in front of the mast, below the camera's usual view."""
REPEAT_S = 0.5


@dataclass(frozen=True)
class _Job:
    command: GripperCommand
    target: int
    ends_s: float


class Arm:
    """One robot's gripper. Reports are due when something changed and twice a second."""

    def __init__(self, robot: str, scene: Scene, physics: Physics) -> None:
        self.id = robot
        self.deeds: list[Deed] = []
        self._scene = scene
        self._physics = physics
        self._held: int | None = None
        self._job: _Job | None = None
        self._last = GripperState(robot=robot, seq=0, stamp_s=0.0, holding=False)
        self._seq = 0
        self._changed = True

    @property
    def held(self) -> Body | None:
        return None if self._held is None else self._scene.bodies[self._held]

    def command(self, command: GripperCommand, now_s: float) -> None:
        """Begin an action, or refuse it at once. A repeated command is answered again, not done again."""
        self._changed = True
        known = {self._last.command_id, self._job.command.command_id if self._job is not None else None}
        if command.command_id in known:
            return
        if self._job is not None:
            self._say(command, busy=True, ok=False, reason="the arm is still busy with the command before")
            return
        try:
            target = resolve(self._scene, command.action, command.point_enu_m, command.expected_type, self._held)
            self._check(command, target)
        except Refused as refused:
            self._say(command, ok=False, reason=str(refused))
            return
        self._job = _Job(command, target.key, now_s + DURATION_S[command.action])
        self._say(command, busy=True)

    def advance(self, now_s: float) -> None:
        """Finish what is due. Everything is checked again: the robot or the thing may have moved meanwhile."""
        job = self._job
        if job is None or now_s < job.ends_s - 1e-9:
            return
        self._job, self._changed = None, True
        target = self._scene.bodies[job.target]
        try:
            attempt = self._check(job.command, target)
        except Refused as refused:
            self._say(job.command, ok=False, reason=str(refused))
            return
        point_m = RULES[job.command.action].effect(attempt)
        self.deeds.append(Deed(job.command.action, job.target, self._held))
        if job.command.action == "pickup":
            self._held = job.target
        elif job.command.action == "put":
            self._held = None
        self._say(job.command, ok=True, point_enu_m=point_m)

    def follow(self) -> None:
        """What is in the hand goes where the robot goes."""
        body = self.held
        if body is None:
            return
        motion = self._physics.robots[self.id].motion()
        x, y, z = body_to_enu(HOLD_FLU_M, (*motion.position_m, 0.0), motion.yaw_rad)
        if (x, y, z, motion.yaw_rad) != (*body.position_m, body.yaw_rad):
            self._physics.carry(body.key, (x, y, z), motion.yaw_rad)

    def report(self, now_s: float) -> GripperState | None:
        """The state, when it is due."""
        if not self._changed and now_s < self._last.stamp_s + REPEAT_S - 1e-9:
            return None
        self._last = self._last.model_copy(update={"seq": self._seq, "stamp_s": now_s})
        self._seq += 1
        self._changed = False
        return self._last

    def _check(self, command: GripperCommand, target: Body) -> Attempt:
        """Raises Refused when the action is not possible as things stand now."""
        rover = self._physics.robots[self.id]
        others = tuple(other.box() for id, other in self._physics.robots.items() if id != self.id)
        stance = Stance(self.id, rover.motion().position_m, rover.eye_m(), others, self._physics.structure)
        if target.held_by is not None or target.gone:
            raise Refused(f"the {target.type} is not there any more")
        check_reach(self._scene, stance, target)
        attempt = Attempt(self._scene, self._physics, stance, target, self.held, command.point_enu_m)
        RULES[command.action].check(attempt)
        return attempt

    def _say(
        self,
        command: GripperCommand,
        busy: bool = False,
        ok: bool | None = None,
        reason: str = "",
        point_enu_m: Vec3 | None = None,
    ) -> None:
        held = self.held
        self._last = GripperState(
            robot=self.id,
            seq=0,
            stamp_s=0.0,
            holding=held is not None,
            holding_type=None if held is None else held.type,
            command_id=command.command_id,
            busy=busy,
            ok=ok,
            reason=reason,
            point_enu_m=point_enu_m,
        )
