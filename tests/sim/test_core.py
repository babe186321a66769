"""The simulator on the mesh: its streams, their rates, and the same bytes for the same commands."""

from math import radians

import cv2
import numpy as np
import pytest

from sim.core import SimCore, build
from tests.sim.small_home import make_small_home, make_small_site
from tests.sim.small_mesh import Listener, go, mesh_maker
from wire.messages.driver import (
    CameraFrame,
    LaserScan,
    Odometry,
)
from wire.messages.truth import TruthTask
from wire.site import SiteError


@pytest.fixture
def make_mesh():
    yield from mesh_maker()


def test_a_robot_follows_a_velocity_until_it_times_out(make_mesh):
    dog = Listener("dog-1", {10: go("dog-1", 0.5)})
    mesh, core = make_mesh(dog)
    mesh.run(4.0)
    x, y = core.physics.robots["dog-1"].motion().position_m
    assert x - 2.0 == pytest.approx(0.25, abs=0.06)
    assert y == pytest.approx(2.5, abs=1e-6)
    assert core.physics.robots["dog-1"].motion().speed_mps == pytest.approx(0.0, abs=1e-9)


def test_only_quadrupeds_get_a_body():
    scene = make_small_home()
    site = make_small_site("dog-1")
    lift = site.robot[0].model_copy(update={"id": "lift-1", "kind": "lift"})
    site = site.model_copy(update={"robot": (*site.robot, lift)})
    core = SimCore(site, scene, TruthTask(instruction="", goals=()), None)
    assert list(core.physics.robots) == ["dog-1"]
    core.stop()


def test_streams_come_at_their_rates_with_consecutive_numbers(make_mesh):
    dog = Listener("dog-1", {20: go("dog-1", 0.2)})
    mesh, _ = make_mesh(dog)
    mesh.run(2.0)
    stamps = [round(m.stamp_s, 6) for m in dog.of(Odometry)]
    assert [s for s in stamps if s < 1.0] == [0.0, 0.25, 0.5, 0.75], "of a robot that stands, four a second"
    assert [s for s in stamps if 1.1 < s < 1.5] == [1.15, 1.2, 1.25, 1.3, 1.35, 1.4, 1.45], "of one that goes, all"
    swept = [round(m.stamp_s, 6) for m in dog.of(LaserScan)]
    assert [s for s in swept if s < 1.0] == [0.0], "what stays the same is told once a second"
    assert [s for s in swept if 1.05 < s < 1.5] == [1.2, 1.4]
    assert [m.seq for m in dog.of(Odometry)] == list(range(len(stamps)))
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
    assert picture.shape == (360, 480, 3)
    depth_m = np.frombuffer(last.depth_mm, "<u2").reshape(360, 480) / 1000.0
    # The floor straight ahead: 1.3 m below the camera, 0.8 rad below the horizon.
    assert depth_m[180, 240] == pytest.approx(1.3 / np.sin(0.8), abs=0.02)


def test_the_same_commands_give_the_same_bytes(make_mesh):
    def episode():
        sent = []
        dog = Listener("dog-1", {k: go("dog-1", 0.6) for k in range(0, 60, 8)})
        mesh, _ = make_mesh(dog, Listener("dog-2"), recorder=lambda *row: sent.append(row))
        mesh.run(10.0)
        return sent

    assert episode() == episode()


def test_ground_truth_stays_on_its_own_key(make_mesh):
    sent = []
    mesh, _ = make_mesh(
        Listener("dog-1"),
        renderer=True,
        smart_appliances=True,
        recorder=lambda _, key, *row: sent.append((key, row[2])),
    )
    mesh.run(1.0)
    assert any(key == "gt/state" for key, _ in sent)
    for key, payload in sent:
        if key != "gt/state":
            assert b"t-1" not in payload.replace(b"cat-1", b"")


def test_a_step_that_is_no_multiple_of_the_physics_step_is_refused():
    site = make_small_site("dog-1")
    odd = site.model_copy(update={"clock": site.clock.model_copy(update={"step_s": 0.03})})
    with pytest.raises(SiteError, match="is no multiple of 1/240 s"):
        SimCore(odd, make_small_home(), TruthTask(instruction="x", goals=()), None)


def test_a_site_without_a_simulated_building_is_refused():
    with pytest.raises(SiteError, match="needs a"):
        build(make_small_site().model_copy(update={"sim": None}), "sim")
