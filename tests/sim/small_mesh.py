"""The small home on a mesh in memory, with robots that say what they were told and keep what they hear."""

from sim.core import SimCore
from sim.render import make_renderer
from sim.scene import Part
from tests.sim.small_home import make_small_home, make_small_site
from wire.bus import Received
from wire.loopback import LoopbackMesh
from wire.messages.driver import (
    VelocityCommand,
)
from wire.messages.goal import Goal, Selector
from wire.messages.truth import TruthTask

TV_ON = Goal(predicate="on", subject=Selector(type="Television"))


class Listener:
    """A robot's process that keeps what it hears and says what it was told to say."""

    def __init__(self, robot, script=()):
        self.robot, self.script, self.heard = robot, dict(script), []
        self.tick = 0

    def start(self, node):
        self.node = node
        for topic in ("odometry", "scan", "frame", "gripper_state"):
            node.subscribe(topic, self.robot)

    def step(self, now_s, events):
        self.heard += [e.message for e in events if isinstance(e, Received)]
        if self.tick in self.script:
            topic, message = self.script[self.tick]
            self.node.publish(topic, message, self.robot)
        self.tick += 1

    def stop(self):
        pass

    def of(self, kind):
        return [m for m in self.heard if isinstance(m, kind)]


def mesh_maker():
    meshes = []

    def make(*listeners, renderer=False, recorder=None, **sim):
        scene = make_small_home()
        site = make_small_site(*(x.robot for x in listeners), **sim)
        task = TruthTask(instruction="switch the television on", goals=(TV_ON,))
        core = SimCore(site, scene, task, make_renderer(scene, "auto", _grey_box) if renderer else None)
        mesh = LoopbackMesh(recorder=recorder)
        meshes.append(mesh)
        mesh.add(core, "sim", "sim", owner=True)
        for listener in listeners:
            mesh.add(listener, listener.robot, "robot")
        return mesh, core

    yield make
    for mesh in meshes:
        mesh.close()


def _grey_box(body):
    return [Part("box", (0.0, 0.0, body.size_m[2] / 2), body.size_m, (0.5, 0.5, 0.5))]


def go(robot, forward_mps=0.0, timeout_s=0.5, **more):
    return "velocity", VelocityCommand(
        robot=robot,
        seq=0,
        timeout_s=timeout_s,
        forward_mps=forward_mps,
        left_mps=0.0,
        **{"yaw_rate_radps": 0.0, **more},
    )
