"""The simulated building behind the drivers: owns the time, moves the world, publishes what sensors notice."""

from collections.abc import Sequence
from math import radians

from sim.bullet import STEP_S
from sim.cameras import Cameras
from sim.carrier import Arm
from sim.locomotion import Locomotion
from sim.physics import Physics, RobotStart
from sim.render import Renderer
from sim.scene import Scene
from wire.bus import Event, Node, Received
from wire.messages.driver import GripperCommand, VelocityCommand
from wire.site import Site, SiteError

MOST_TICKS_AT_ONCE = 10
"""A simulator that has fallen behind the wall clock by more lets the time go."""


class SimCore:
    """Without a renderer there are no pictures; everything else is the same."""

    def __init__(self, site: Site, scene: Scene, renderer: Renderer | None) -> None:
        if site.sim is None:
            raise SiteError(f"{site.name}: there is no [sim] table; add one with a seed, or start no sim process")
        self.scene = scene
        starts = [RobotStart(r.id, r.start_m, radians(r.start_yaw_deg)) for r in site.robot]
        self.physics = Physics(scene, starts)
        self._renderer = renderer
        self._step_s = site.clock.step_s
        self._substeps = _substeps(site)
        self._legs = {r.id: Locomotion(r.id, self.physics, site.sim.seed, self._step_s) for r in site.robot}
        self._arms = {r.id: Arm(r.id, scene, self.physics) for r in site.robot}
        self._cameras = Cameras(site, self.physics, self._legs)
        self._began_s: float | None = None
        self._tick = -1

    def start(self, node: Node) -> None:
        self._node = node
        node.subscribe("velocity")
        node.subscribe("gripper_command")

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
        self.physics.close()

    def _handle(self, event: Event, now_s: float) -> None:
        match event:
            case Received(message=VelocityCommand() as command) if command.robot in self._legs:
                self._legs[command.robot].obey(command, now_s)
            case Received(message=GripperCommand() as command) if command.robot in self._arms:
                self._arms[command.robot].command(command, now_s)

    def _advance(self, now_s: float) -> None:
        """One tick: physics first, then what the sensors notice of it."""
        for legs in self._legs.values():
            legs.watch(now_s)
        if self._tick > 0:
            self.physics.advance(self._substeps)
        for legs in self._legs.values():
            legs.publish(self._node, self._tick, now_s)
        for robot, arm in self._arms.items():
            arm.follow()
            arm.advance(now_s)
            state = arm.report(now_s)
            if state is not None:
                self._node.publish("gripper_state", state, robot)
        if self._renderer is not None and self._cameras.due(self._tick):
            self._publish_frames(self._renderer, now_s)

    def _publish_frames(self, renderer: Renderer, now_s: float) -> None:
        for key in sorted(self.physics.moved):
            renderer.update(self.scene.bodies[key])
        self.physics.moved.clear()
        for robot, rover in self.physics.robots.items():
            motion = rover.motion()
            renderer.set_robot(
                robot, (*motion.position_m, 0.0), motion.yaw_rad, holding=self._arms[robot].held is not None
            )
        for frame in self._cameras.shoot(renderer, self._tick, now_s):
            self._node.publish("frame", frame, frame.camera)


def _substeps(site: Site) -> int:
    steps = round(site.clock.step_s / STEP_S)
    if steps < 1 or abs(steps * STEP_S - site.clock.step_s) > 1e-9:
        raise SiteError(f"{site.name}: clock.step_s = {site.clock.step_s:g} is no multiple of 1/240 s; use 0.05")
    return steps
