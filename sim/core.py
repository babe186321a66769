"""The simulated building behind the drivers: owns the time, moves the world, publishes what sensors notice."""

from collections.abc import Sequence
from math import radians
from typing import TYPE_CHECKING

from sim.aerials import drone_starts
from sim.appliances import Appliances
from sim.bullet import STEP_S
from sim.cameras import Cameras
from sim.carrier import Arm
from sim.faults import Faults
from sim.generator import make_home
from sim.judge import Judge
from sim.locomotion import Locomotion
from sim.models import parts
from sim.physics import Physics, RobotStart
from sim.render import Renderer, make_renderer
from sim.render.picture import RenderError
from sim.scene import Scene
from sim.task import make_task
from wire.bus import CannotRun, Event, Node, Received, Request
from wire.messages.driver import GripperCommand, VelocityCommand
from wire.messages.truth import JudgeRequest, TruthState, TruthTask
from wire.site import Site, SiteError

if TYPE_CHECKING:
    from sim.hangar import Hangar

JUDGE_HZ = 2.0
MOST_TICKS_AT_ONCE = 10
"""A simulator that has fallen behind the wall clock by more lets the time go."""


class SimCore:
    """Without a renderer there are no pictures; everything else is the same."""

    def __init__(self, site: Site, scene: Scene, task: TruthTask, renderer: Renderer | None) -> None:
        if site.sim is None:
            raise SiteError(f"{site.name}: there is no [sim] table; add one with a seed, or start no sim process")
        self.scene = scene
        walkers = [robot for robot in site.robot if robot.kind == "quadruped"]  # what else there is brings its own body
        starts = [RobotStart(r.id, r.start_m, radians(r.start_yaw_deg)) for r in walkers]
        self.physics = Physics(scene, starts, site.sim.legs, drone_starts(site), site.sim.seed)
        self._hangar = _open_hangar(site, self.physics)
        self._renderer = renderer
        self._step_s = site.clock.step_s
        self._substeps = _substeps(site)
        self._legs = {r.id: Locomotion(r.id, self.physics, site.sim.seed, self._step_s) for r in walkers}
        self._arms = {r.id: Arm(r.id, scene, self.physics) for r in walkers}
        self._cameras = Cameras(site, self.physics, self._legs)
        self._appliances = Appliances(scene) if site.sim.smart_appliances else None
        _check_faulty_appliances(site, self._appliances.ids if self._appliances is not None else [])
        self._faults = Faults(site.sim.fault, site.sim.seed)
        self._judge = Judge(scene, self.physics, self._arms, task)
        self._judge_every = max(1, round(1.0 / (JUDGE_HZ * self._step_s)))
        self._began_s: float | None = None
        self._tick = -1

    def start(self, node: Node) -> None:
        self._node = node
        node.subscribe("velocity")
        node.subscribe("gripper_command")
        node.serve("judge")

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        if self._began_s is None:
            self._began_s = now_s
        for event in events:
            self._handle(event, now_s)
        due = round((now_s - self._began_s) / self._step_s)
        self._tick = max(self._tick, due - MOST_TICKS_AT_ONCE)
        while self._tick < due:
            self._tick += 1
            self._advance(self._began_s + self._tick * self._step_s)

    def stop(self) -> None:
        if self._renderer is not None:
            self._renderer.close()
        if self._hangar is not None:
            self._hangar.close()
        self.physics.close()

    def _handle(self, event: Event, now_s: float) -> None:
        match event:
            case Received(message=VelocityCommand() as command) if command.robot in self._legs:
                self._legs[command.robot].obey(command, now_s)
            case Received(message=GripperCommand() as command) if command.robot in self._arms:
                self._arms[command.robot].command(command, now_s)
            case Request(message=JudgeRequest() as request):
                event.reply(self._judge.verdict(request, now_s, now_s - (self._began_s or 0.0)))

    def _advance(self, now_s: float) -> None:
        """One tick: physics first, then what the sensors notice of it."""
        for legs in self._legs.values():
            legs.watch(now_s)
        if self._hangar is not None:
            self._hangar.listen()
        if self._tick > 0:
            self.physics.advance(self._substeps)
        if self._hangar is not None:
            self._hangar.tell()
        for robot, legs in self._legs.items():
            legs.publish(self._node, self._tick, now_s)
            self._publish_arm(robot, now_s)
        if self._renderer is not None and self._cameras.due(self._tick):
            self._take_pictures(self._renderer, now_s)
        for frame in self._faults.due_frames(now_s):
            self._node.publish("frame", frame, frame.camera)
        for report in self._appliances.reports(now_s) if self._appliances is not None else ():
            self._node.publish("device_report", self._faults.distort(report), report.device)
        if self._tick % self._judge_every == 0:
            self._node.publish("truth", TruthState(stamp_s=now_s, world=self._judge.watch(now_s)))

    def _publish_arm(self, robot: str, now_s: float) -> None:
        arm = self._arms[robot]
        arm.follow()
        arm.advance(now_s)
        state = arm.report(now_s)
        if state is not None:
            self._node.publish("gripper_state", state, robot)

    def _take_pictures(self, renderer: Renderer, now_s: float) -> None:
        for key in sorted(self.physics.moved):
            renderer.update(self.scene.bodies[key])
        self.physics.moved.clear()
        for robot, rover in self.physics.robots.items():
            motion = rover.motion()
            holding = self._arms[robot].held is not None
            renderer.set_robot(robot, (*motion.position_m, 0.0), motion.yaw_rad, holding)
        for id, drone in self.physics.drones.items():
            renderer.set_robot(id, *drone.true_pose(), flies=True)
        for frame in self._cameras.shoot(renderer, self._tick, now_s):
            self._faults.pass_frame(frame, now_s)


def build(site: Site, process_id: str) -> SimCore:
    """The simulator of a site: its home drawn from the seed, its cameras if pictures can be drawn at all."""
    if site.sim is None:
        raise SiteError(f"{site.name}: {process_id} needs a [sim] table; add one with a seed")
    scene = make_home(site.sim.seed)
    try:
        renderer = None if site.sim.renderer == "none" else make_renderer(scene, site.sim.renderer, parts)
    except RenderError as error:
        raise CannotRun(str(error)) from error
    return SimCore(site, scene, make_task(scene, site.sim.seed), renderer)


def _open_hangar(site: Site, physics: Physics) -> "Hangar | None":
    if not physics.drones:
        return None
    from sim.hangar import Hangar  # with MAVLink behind it: a building without drones does without

    return Hangar(site, physics)


def _check_faulty_appliances(site: Site, there: list[str]) -> None:
    """Only the scene knows how many appliances of a type there are."""
    for fault in site.sim.fault if site.sim is not None else ():
        if fault.kind == "wrong_state" and fault.device not in there:
            raise SiteError(f"{site.name}: sim.fault: this home has no {fault.device}; it has {', '.join(there)}")


def _substeps(site: Site) -> int:
    steps = round(site.clock.step_s / STEP_S)
    if steps < 1 or abs(steps * STEP_S - site.clock.step_s) > 1e-9:
        raise SiteError(f"{site.name}: clock.step_s = {site.clock.step_s:g} is no multiple of 1/240 s; use 0.05")
    return steps
