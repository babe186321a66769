from math import radians

import cv2
import numpy as np
import pytest

from sim.core import SimCore
from sim.render import make_renderer
from sim.scene import Part
from tests.sim.small_home import make_small_home, make_small_site
from wire.bus import Received
from wire.loopback import LoopbackMesh
from wire.messages.driver import CameraFrame, LaserScan, Odometry, VelocityCommand


class Listener:
    """A robot's process that keeps what it hears and says what it was told to say."""

    def __init__(self, robot, script=()):
        self.robot, self.script, self.heard = robot, dict(script), []
        self.tick = 0

    def start(self, node):
        self.node = node
        for topic in ("odometry", "scan", "frame"):
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


@pytest.fixture
def make_mesh():
    meshes = []

    def make(*listeners, renderer=False, recorder=None, **sim):
        scene = make_small_home()
        site = make_small_site(*(x.robot for x in listeners), **sim)
        core = SimCore(site, scene, make_renderer(scene, "auto", _grey_box) if renderer else None)
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
        robot=robot, seq=0, forward_mps=forward_mps, left_mps=0.0, yaw_rate_radps=0.0, timeout_s=timeout_s, **more
    )


def test_a_robot_follows_a_velocity_until_it_times_out(make_mesh):
    dog = Listener("dog-1", {10: go("dog-1", 0.5)})
    mesh, core = make_mesh(dog)
    mesh.run(4.0)
    x, y = core.physics.robots["dog-1"].motion().position_m
    assert x - 2.0 == pytest.approx(0.25, abs=0.06)
    assert y == pytest.approx(2.5, abs=1e-6)
    assert core.physics.robots["dog-1"].motion().speed_mps == pytest.approx(0.0, abs=1e-9)


def test_streams_come_at_their_rates_with_consecutive_numbers(make_mesh):
    dog = Listener("dog-1")
    mesh, _ = make_mesh(dog)
    mesh.run(2.0)
    assert len(dog.of(Odometry)) == 40
    assert len(dog.of(LaserScan)) == 10
    assert [m.seq for m in dog.of(Odometry)] == list(range(40))
    assert not dog.of(CameraFrame)


def test_odometry_errs_a_little_and_smoothly(make_mesh):
    dog = Listener("dog-1")
    mesh, _ = make_mesh(dog)
    mesh.run(60.0)
    errors = np.array([m.position_enu_m[0] - 2.0 for m in dog.of(Odometry)])
    assert abs(errors.mean()) < 0.01
    assert 0.004 < errors.std() < 0.02
    assert np.abs(np.diff(errors)).max() < 0.02
    yaw = np.array([m.yaw_rad for m in dog.of(Odometry)])
    assert radians(0.1) < yaw.std() < radians(0.6)


def test_pictures_are_spread_over_the_ticks_and_carry_pose_and_depth(make_mesh):
    sent = []
    dogs = [Listener("dog-1", {0: go("dog-1", 0.0, camera_tilt_down_rad=0.8, timeout_s=5.0)}), Listener("dog-2")]
    mesh, _ = make_mesh(*dogs, renderer=True, recorder=lambda now_s, key, *_: sent.append((now_s, key)))
    mesh.run(2.0)
    stamps = [now_s for now_s, key in sent if key.endswith("/image")]
    assert len(stamps) == 12
    assert len(set(stamps)) == 12
    last = dogs[0].of(CameraFrame)[-1]
    assert last.tilt_down_rad == pytest.approx(0.8)
    picture = cv2.imdecode(np.frombuffer(last.jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert picture.shape == (240, 320, 3)
    depth_m = np.frombuffer(last.depth_mm, "<u2").reshape(240, 320) / 1000.0
    # The floor straight ahead: 1.3 m below the camera, 0.8 rad below the horizon.
    assert depth_m[120, 160] == pytest.approx(1.3 / np.sin(0.8), abs=0.02)


def test_the_same_commands_give_the_same_bytes(make_mesh):
    def episode():
        sent = []
        dog = Listener("dog-1", {k: go("dog-1", 0.6) for k in range(0, 60, 8)})
        mesh, _ = make_mesh(dog, Listener("dog-2"), recorder=lambda *row: sent.append(row))
        mesh.run(10.0)
        return sent

    assert episode() == episode()
