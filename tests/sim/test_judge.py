"""The evaluator: what it knows, and a robot that does an errand under its eyes."""

from math import hypot

import pytest

from sim.core import build
from tests.sim.small_home import FRIDGE, make_small_site
from tests.sim.small_mesh import Listener, go, mesh_maker
from wire.codec import decode
from wire.frames import bearing_rad, wrap_rad
from wire.loopback import LoopbackMesh
from wire.messages.driver import (
    GripperCommand,
    GripperState,
    Odometry,
    VelocityCommand,
)
from wire.messages.goal import Goal, Selector
from wire.messages.truth import JudgeRequest, TruthState
from wire.site import Sim


@pytest.fixture
def make_mesh():
    yield from mesh_maker()


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


ORDERED = (
    Goal(predicate="open", subject=Selector(type="Fridge"), text="open the fridge"),
    Goal(predicate="on", subject=Selector(type="Television"), after=(0,), text="turn on the TV"),
)


def act(mesh, core, *changes):
    """Set properties one after another, each a second apart; what the evaluator says in the end."""
    mesh.run(1.0)
    start_s = mesh.now_s
    for kind, prop, value in changes:
        next(b for b in core.scene.bodies.values() if b.type == kind).props[prop] = value
        mesh.run(1.0)
    return mesh.call("judge", JudgeRequest(goals=ORDERED, since_s=start_s), role="evaluator")


@pytest.mark.parametrize(
    ("changes", "kept"),
    [
        ([("Fridge", "isOpen", True), ("Television", "isToggled", True)], True),
        ([("Television", "isToggled", True), ("Fridge", "isOpen", True)], False),
        (
            [
                ("Television", "isToggled", True),
                ("Television", "isToggled", False),
                ("Fridge", "isOpen", True),
                ("Television", "isToggled", True),
            ],
            True,
        ),
        ([("Fridge", "isOpen", True), ("Television", "isToggled", True), ("Fridge", "isOpen", False)], True),
    ],
)
def test_the_order_of_goals_is_judged(make_mesh, changes, kept):
    mesh, core = make_mesh(Listener("dog-1"))
    tv = act(mesh, core, *changes).goals[1]
    assert (tv.holds, tv.note) == (
        kept,
        "" if kept else "it came true before 'open the fridge', which should come first",
    )


def test_what_was_true_when_the_task_was_given_is_not_out_of_order(make_mesh):
    mesh, core = make_mesh(Listener("dog-1"))
    assert not act(mesh, core, ("Television", "isToggled", True)).success
    reply = act(mesh, core, ("Fridge", "isOpen", True))
    assert reply.success
    assert not any(state.note for state in reply.goals)


def test_a_room_is_visited_after_what_comes_first_when_a_robot_is_there_afterwards(make_mesh):
    mesh, core = make_mesh(Listener("dog-1"))
    rooms = [Goal(predicate="visited", subject=Selector(room=room), after=(0,)) for room in ("kitchen", "living")]
    mesh.run(1.0)
    core.scene.bodies[FRIDGE].props["isOpen"] = True
    mesh.run(1.0)
    reply = mesh.call("judge", JudgeRequest(goals=(ORDERED[0], *rooms)), role="evaluator")
    assert [(state.holds, state.note) for state in reply.goals] == [(True, ""), (True, ""), (False, "")]
