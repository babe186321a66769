"""The simulator on the mesh: its streams, its faults, its judge, and a robot that does an errand."""

from math import hypot, radians

import cv2
import numpy as np
import pytest

from sim.core import SimCore, build
from sim.render import make_renderer
from sim.scene import Part
from tests.sim.small_home import FRIDGE, make_small_home, make_small_site
from wire.bus import Received
from wire.codec import decode
from wire.frames import bearing_rad, wrap_rad
from wire.loopback import LoopbackMesh
from wire.messages.driver import (
    CameraFrame,
    DeviceReport,
    GripperCommand,
    GripperState,
    LaserScan,
    Odometry,
    VelocityCommand,
)
from wire.messages.goal import Goal, Selector
from wire.messages.truth import JudgeRequest, TruthState, TruthTask
from wire.site import Sim, SiteError

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


@pytest.fixture
def make_mesh():
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


class Walker(Listener):
    """Follows a list of floor points by odometry, then reaches to a point."""

    def __init__(self, robot, route, reach):
        super().__init__(robot)
        self.route, self.reach = list(route), reach

    def step(self, now_s, events):
        super().step(now_s, events)
        seen = self.of(Odometry)
        if not seen:
            return
        (x, y, _), yaw_rad = seen[-1].position_enu_m, seen[-1].yaw_rad
        while self.route and hypot(self.route[0][0] - x, self.route[0][1] - y) < 0.08:
            self.route.pop(0)
        forward_mps, turn = 0.0, 0.0
        if self.route:
            off_rad = wrap_rad(bearing_rad((x, y), self.route[0]) - yaw_rad)
            forward_mps, turn = (0.5 if abs(off_rad) < 0.3 else 0.0), max(-1.5, min(1.5, 3.0 * off_rad))
        elif self.reach is not None and seen[-1].speed_mps < 0.01:
            self.node.publish("gripper_command", self.reach, self.robot)
            self.reach = None
        self.node.publish(
            "velocity",
            VelocityCommand(
                robot=self.robot, seq=self.tick, forward_mps=forward_mps, left_mps=0.0, yaw_rate_radps=turn
            ),
            self.robot,
        )


def test_a_robot_drives_through_a_doorway_and_takes_a_mug(make_mesh):
    reach = GripperCommand(
        robot="dog-1", command_id="c-1", action="pickup", point_enu_m=(7.45, 4.0, 0.8), expected_type="Mug"
    )
    dog = Walker("dog-1", [(4.2, 2.5), (5.8, 2.5), (6.4, 3.6)], reach)
    mesh, core = make_mesh(dog)
    mesh.run(20.0)
    last = dog.of(GripperState)[-1]
    assert (last.ok, last.holding, last.holding_type) == (True, True, "Mug")
    assert core.physics.collisions == 0
    holds_mug = Goal(predicate="in", subject=Selector(type="Mug"), object=Selector(type="DiningTable"), negated=True)
    visited = [Goal(predicate="visited", subject=Selector(room=room)) for room in ("kitchen", "living")]
    found = Goal(predicate="found", subject=Selector(type="Mug"))
    spared = Goal(predicate="touched", subject=Selector(type="Laptop"), forbidden=True)
    reply = mesh.call("judge", JudgeRequest(goals=(holds_mug, found, spared, *visited)), role="evaluator")
    assert reply.success
    assert reply.collisions == 0
    forbidden = [
        Goal(predicate="touched", subject=Selector(type="Mug"), forbidden=True),
        Goal(predicate="in", subject=Selector(type="Mug"), forbidden=True),
        Goal(predicate="visited", subject=Selector(room="living"), forbidden=True),
    ]
    reply = mesh.call("judge", JudgeRequest(goals=tuple(forbidden)), role="evaluator")
    assert [state.note for state in reply.goals] == [
        "pickup was done with the Mug",
        "pickup was done with the Mug",
        "a robot has been in living",
    ]
    assert not any(state.holds for state in reply.goals)


def test_the_judge_knows_the_scenes_own_task_and_what_is_true(make_mesh):
    mesh, core = make_mesh(Listener("dog-1"))
    mesh.run(0.5)
    reply = mesh.call("judge", JudgeRequest(), role="evaluator")
    assert reply.task.instruction == "switch the television on"
    assert not reply.success
    next(b for b in core.scene.bodies.values() if b.type == "Television").props["isToggled"] = True
    assert mesh.call("judge", JudgeRequest(), role="evaluator").success


def test_things_in_a_closed_fridge_or_another_room_are_not_found(make_mesh):
    mesh, core = make_mesh(Listener("dog-1"))
    goals = tuple(Goal(predicate="found", subject=Selector(type=kind)) for kind in ("Apple", "Mug", "Fridge"))

    def found():
        return [state.holds for state in mesh.call("judge", JudgeRequest(goals=goals), role="evaluator").goals]

    mesh.run(1.0)
    assert found() == [False, False, False]
    core._legs["dog-1"].obey(go("dog-1", yaw_rate_radps=1.2, timeout_s=1.7)[1], mesh.now_s)
    mesh.run(2.0)
    assert found() == [False, False, True]
    core.scene.bodies[FRIDGE].props["isOpen"] = True
    mesh.run(1.0)
    assert found() == [True, False, True]


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


def test_smart_appliances_report_and_a_fault_turns_the_report_round(make_mesh):
    def reports(**sim):
        sent = []
        mesh, core = make_mesh(Listener("dog-1"), recorder=lambda *row: sent.append(row), smart_appliances=True, **sim)
        mesh.run(1.0)
        next(b for b in core.scene.bodies.values() if b.type == "Television").props["isToggled"] = True
        mesh.run(1.0)
        rows = [
            decode(DeviceReport, payload) for _, key, _, _, payload in sent if key == "appliance/television-1/report"
        ]
        return [row.props["isToggled"] for row in rows]

    assert reports() == [0.0, 1.0]
    wrong = [{"device": "television-1", "kind": "wrong_state", "prop": "isToggled"}]
    assert reports(fault=wrong) == [1.0, 0.0]


def test_lost_and_late_pictures(make_mesh):
    def stamps(**sim):
        dog = Listener("dog-1")
        mesh, _ = make_mesh(dog, renderer=True, **sim)
        heard = []
        for tick in range(120):
            before = len(dog.heard)
            mesh.tick()
            heard += [(tick * 0.05, m.stamp_s) for m in dog.heard[before:] if isinstance(m, CameraFrame)]
        return heard

    healthy = stamps()
    assert len(healthy) == 12
    lost = stamps(fault=[{"device": "dog-1", "kind": "frame_loss", "probability": 0.5}])
    assert 2 <= len(lost) <= 10
    assert lost == stamps(fault=[{"device": "dog-1", "kind": "frame_loss", "probability": 0.5}])
    late = stamps(fault=[{"device": "dog-1", "kind": "delay", "delay_s": 0.3}])
    assert all(at_s - stamp_s == pytest.approx(0.3, abs=0.051) for at_s, stamp_s in late)
    assert all(at_s - stamp_s == pytest.approx(0.0, abs=1e-6) for at_s, stamp_s in healthy)


def test_a_step_that_is_no_multiple_of_the_physics_step_is_refused():
    site = make_small_site("dog-1")
    odd = site.model_copy(update={"clock": site.clock.model_copy(update={"step_s": 0.03})})
    with pytest.raises(SiteError, match="is no multiple of 1/240 s"):
        SimCore(odd, make_small_home(), TruthTask(instruction="x", goals=()), None)


def test_truth_is_published_twice_a_second(make_mesh):
    sent = []
    mesh, core = make_mesh(Listener("dog-1"), recorder=lambda *row: sent.append(row))
    mesh.run(2.0)
    states = [decode(TruthState, payload) for _, key, _, _, payload in sent if key == "gt/state"]
    assert len(states) == 4
    assert len(states[-1].world.objects) == len(core.scene.bodies)
    assert states[-1].world.robots[0].room == "kitchen"


def test_a_site_builds_its_own_home_with_a_task_that_is_not_done_yet():
    site = make_small_site().model_copy(update={"sim": Sim(seed=5)})
    core = build(site, "sim")
    mesh = LoopbackMesh()
    mesh.add(core, "sim", "sim", owner=True)
    reply = mesh.call("judge", JudgeRequest(), role="evaluator")
    mesh.close()
    assert reply.task.instruction
    assert reply.goals
    assert not reply.success


def test_a_site_without_a_simulated_building_is_refused():
    with pytest.raises(SiteError, match="needs a"):
        build(make_small_site().model_copy(update={"sim": None}), "sim")
