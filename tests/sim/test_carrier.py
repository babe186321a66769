"""The gripper: every precondition, every effect, and what it tells of the world."""

import pytest

from sim.boxes import body_box, boxes_overlap
from sim.carrier import Arm
from sim.manipulation import DURATION_S, RULES
from sim.physics import Physics, RobotStart
from sim.reaching import REACH_M
from tests.sim.small_home import (
    APPLE,
    BALL,
    BOX,
    BREAD,
    FRIDGE,
    KNIFE,
    LAPTOP,
    MICROWAVE,
    MUG,
    PLATE,
    TABLE,
    TELEVISION,
    make_small_home,
)
from wire.messages.driver import GripperCommand

AT_TABLE, AT_FRIDGE, AT_MICROWAVE = ((6.6, 4.2), 0.0), ((1.0, 3.4), 1.5708), ((3.5, 4.0), 1.5708)
AT_TELEVISION, AT_BALL, AT_BOX, FAR_OFF = ((8.6, 2.5), 0.0), ((2.8, 1.0), 0.0), ((8.4, 0.8), 0.0), ((2.5, 2.5), 0.0)


class Bench:
    """One robot with its arm in the small home; times pass only when told to."""

    def __init__(self, stands, other=None):
        starts = [RobotStart("dog-1", *stands)] + ([RobotStart("dog-2", *other)] if other else [])
        self.scene = make_small_home()
        self.physics = Physics(self.scene, starts)
        self.arm = Arm("dog-1", self.scene, self.physics)
        self.now_s, self.count = 0.0, 0

    def body(self, key):
        return self.scene.bodies[key]

    def do(self, action, key, expected=True, point=None):
        """The final state of an action on a thing."""
        self.count += 1
        body = self.body(key)
        self.arm.command(
            GripperCommand(
                robot="dog-1",
                command_id=f"c-{self.count}",
                action=action,
                point_enu_m=point or body_box(body).centre_m,
                expected_type=body.type if expected else None,
            ),
            self.now_s,
        )
        state = self.arm.report(self.now_s)
        if state.busy:
            self.now_s += DURATION_S[action]
            self.arm.advance(self.now_s)
            state = self.arm.report(self.now_s)
        assert state.command_id == f"c-{self.count}"
        return state


@pytest.fixture
def make_bench():
    made = []

    def make(*args):
        made.append(Bench(*args))
        return made[-1]

    yield make
    for bench in made:
        bench.physics.close()


REFUSALS = [
    # where, done before, action, on what, words of the reason
    (AT_TABLE, [("pickup", KNIFE)], "pickup", MUG, "hand is full: it holds a Knife"),
    (AT_TABLE, [("pickup", KNIFE), ("slice", BREAD), ("put", TABLE)], "pickup", BREAD, "sliced"),
    (AT_TABLE, [], "pickup", TABLE, "a DiningTable cannot be picked up"),
    (AT_TABLE, [], "put", TABLE, "hand is empty"),
    (AT_TABLE, [], "put", LAPTOP, "a Laptop cannot hold anything"),
    (AT_TABLE, [], "toggle_on", LAPTOP, "the Laptop is closed"),
    (AT_TABLE, [("open", LAPTOP)], "open", LAPTOP, "already open"),
    (AT_TABLE, [], "close", LAPTOP, "already closed"),
    (AT_TABLE, [], "open", MUG, "a Mug cannot be opened"),
    (AT_TABLE, [], "toggle_on", MUG, "a Mug cannot be switched on"),
    (AT_TABLE, [], "slice", BREAD, "needs a knife"),
    (AT_TABLE, [("pickup", KNIFE), ("slice", BREAD)], "slice", BREAD, "already sliced"),
    (AT_TABLE, [], "slice", MUG, "a Mug cannot be sliced"),
    (AT_TABLE, [("clean", MUG)], "clean", MUG, "already clean"),
    (AT_TABLE, [], "clean", BREAD, "a Bread cannot be cleaned"),
    (AT_TELEVISION, [("toggle_on", TELEVISION)], "toggle_on", TELEVISION, "already on"),
    (AT_TELEVISION, [], "toggle_off", TELEVISION, "already off"),
    (AT_FRIDGE, [], "pickup", APPLE, "the Fridge is closed and in the way"),
    (AT_FRIDGE, [], "close", FRIDGE, "already closed"),
    (AT_MICROWAVE, [("toggle_on", MICROWAVE)], "open", MICROWAVE, "running"),
    (AT_MICROWAVE, [("open", MICROWAVE)], "toggle_on", MICROWAVE, "open; close it"),
    (FAR_OFF, [], "pickup", BALL, "out of reach"),
]


@pytest.mark.parametrize(("where", "before", "action", "key", "words"), REFUSALS)
def test_what_cannot_be_done_is_refused_with_the_reason_and_changes_nothing(
    make_bench, where, before, action, key, words
):
    bench = make_bench(where)
    for earlier in before:
        assert bench.do(*earlier).ok, earlier
    was = {k: (b.parent, b.held_by, dict(b.props)) for k, b in bench.scene.bodies.items()}
    state = bench.do(action, key)
    assert state.ok is False
    assert words in state.reason
    assert {k: (b.parent, b.held_by, dict(b.props)) for k, b in bench.scene.bodies.items()} == was


def _is_on(bench, key):
    return bench.body(key).props["isToggled"]


EFFECTS = [
    (AT_TABLE, [], "pickup", MUG, lambda b: b.body(MUG).held_by == "dog-1" and b.body(MUG).parent is None),
    (AT_TABLE, [("pickup", MUG)], "put", TABLE, lambda b: b.body(MUG).parent == TABLE and b.body(MUG).held_by is None),
    (AT_TABLE, [], "open", LAPTOP, lambda b: b.body(LAPTOP).props["isOpen"]),
    (AT_TABLE, [("open", LAPTOP)], "toggle_on", LAPTOP, lambda b: b.body(LAPTOP).props["isToggled"]),
    (AT_TABLE, [("open", LAPTOP)], "close", LAPTOP, lambda b: not b.body(LAPTOP).props["isOpen"]),
    (AT_TABLE, [("pickup", KNIFE)], "slice", BREAD, lambda b: b.body(BREAD).props["isSliced"]),
    (AT_TABLE, [], "clean", MUG, lambda b: not b.body(MUG).props["isDirty"]),
    (AT_TELEVISION, [], "toggle_on", TELEVISION, lambda b: _is_on(b, TELEVISION)),
    (
        AT_TELEVISION,
        [("toggle_on", TELEVISION)],
        "toggle_off",
        TELEVISION,
        lambda b: not b.body(TELEVISION).props["isToggled"],
    ),
    (AT_FRIDGE, [], "open", FRIDGE, lambda b: b.body(FRIDGE).props["isOpen"]),
    (AT_FRIDGE, [("open", FRIDGE)], "pickup", APPLE, lambda b: b.body(APPLE).held_by == "dog-1"),
    (AT_FRIDGE, [("open", FRIDGE), ("pickup", APPLE)], "put", FRIDGE, lambda b: b.body(APPLE).parent == FRIDGE),
    (AT_BALL, [], "pickup", BALL, lambda b: b.body(BALL).held_by == "dog-1"),
    (AT_BOX, [], "open", BOX, lambda b: b.body(BOX).props["isOpen"]),
]


@pytest.mark.parametrize(("where", "before", "action", "key", "holds"), EFFECTS)
def test_what_can_be_done_is_done(make_bench, where, before, action, key, holds):
    bench = make_bench(where)
    for earlier in before:
        assert bench.do(*earlier).ok, earlier
    assert not holds(bench)
    state = bench.do(action, key)
    assert state.ok, state.reason
    assert state.reason == ""
    assert holds(bench)


def test_every_action_is_tried_above():
    assert {row[2] for row in EFFECTS} == set(RULES)
    assert {row[2] for row in REFUSALS} == set(RULES)


def test_an_action_takes_its_time_and_the_hand_is_busy_until_then(make_bench):
    bench = make_bench(AT_TABLE)
    command = GripperCommand(robot="dog-1", command_id="a", action="pickup", point_enu_m=(7.4, 3.95, 0.8))
    bench.arm.command(command, 0.0)
    assert bench.arm.report(0.0).busy
    bench.arm.advance(1.95)
    assert bench.arm.report(1.95).busy
    bench.arm.command(command.model_copy(update={"command_id": "b"}), 1.95)
    refused = bench.arm.report(1.95)
    assert (refused.command_id, refused.ok, refused.busy) == ("b", False, True)
    assert "still busy" in refused.reason
    bench.arm.advance(2.0)
    done = bench.arm.report(2.0)
    assert (done.command_id, done.ok, done.busy, done.holding, done.holding_type) == ("a", True, False, True, "Mug")


def test_a_repeated_command_is_answered_and_not_done_again(make_bench):
    bench = make_bench(AT_TABLE)
    assert bench.do("toggle_on", MUG).ok is False
    assert bench.do("open", LAPTOP).ok
    bench.count -= 1
    assert bench.do("open", LAPTOP).ok


def test_the_thing_is_checked_again_when_the_hand_closes(make_bench):
    bench = make_bench(AT_TABLE)
    bench.arm.command(GripperCommand(robot="dog-1", command_id="a", action="pickup", point_enu_m=(7.4, 3.95, 0.8)), 0.0)
    bench.body(MUG).held_by = "dog-2"
    bench.arm.advance(2.0)
    assert bench.arm.report(2.0).reason == "the Mug is not there any more"


def test_the_point_decides_and_the_expected_type_goes_first(make_bench):
    bench = make_bench(AT_TABLE)
    mug, knife = body_box(bench.body(MUG)).centre_m, body_box(bench.body(KNIFE)).centre_m
    nothing = bench.do("pickup", MUG, point=(6.2, 3.0, 0.9))
    assert nothing.reason == "there is nothing within 0.3 m of the point"
    assert "no Mug at the point" in bench.do("pickup", MUG, point=(7.5, 4.8, 0.85)).reason
    assert bench.do("pickup", MUG, point=knife).holding_type == "Mug"
    assert bench.do("put", TABLE, point=mug).ok
    assert bench.do("pickup", TABLE, expected=False, point=knife).holding_type == "Knife"


def test_a_closed_thing_does_not_tell_what_is_in_it(make_bench):
    bench = make_bench(AT_FRIDGE)
    with_apple = bench.do("pickup", APPLE, point=(1.0, 4.4, 0.75)).reason
    bench.body(APPLE).parent, bench.body(APPLE).position_m = None, (9.0, 4.0, 0.0)
    assert bench.do("pickup", APPLE, point=(1.0, 4.4, 0.75)).reason == with_apple


def test_a_wall_blocks_the_view(make_bench):
    bench = make_bench(((4.4, 4.2), 0.0))
    bench.body(MUG).parent, bench.body(MUG).position_m = None, (5.3, 4.2, 0.0)
    assert "out of sight" in bench.do("pickup", MUG).reason


def test_another_robot_in_front_of_the_door_makes_it_roll_back(make_bench):
    bench = make_bench(((1.7, 3.5), 1.5708), ((0.9, 3.75), 0.0))
    state = bench.do("open", FRIDGE)
    assert state.reason == "the door of the Fridge is blocked by a robot and rolled back"
    assert not bench.body(FRIDGE).props["isOpen"]


def test_contents_travel_with_a_carried_receptacle(make_bench):
    bench = make_bench(((1.5, 0.7), 3.14159))
    apple, plate = bench.body(APPLE), bench.body(PLATE)
    apple.parent, apple.position_m = PLATE, (0.7, 0.7, 0.02)
    assert bench.do("pickup", PLATE).ok
    bench.arm.follow()
    assert plate.position_m == pytest.approx((1.5 - 0.52, 0.7, 0.74), abs=1e-3)
    assert apple.position_m == pytest.approx((1.5 - 0.52, 0.7, 0.76), abs=1e-3)
    assert apple.parent == PLATE


def test_things_put_down_do_not_overlap_until_no_room_is_left(make_bench):
    bench = make_bench(AT_TABLE)
    put = []
    for key in range(100, 140):
        box = type(bench.body(BOX))(key, "Box", (0, 0, 0), 0.0, (0.2, 0.2, 0.2), 0, {}, None, "dog-1")
        bench.scene.bodies[key] = box
        bench.arm._held = key
        state = bench.do("put", TABLE, point=(7.3, 4.2, 0.75))
        if not state.ok:
            assert "no free spot within reach" in state.reason
            break
        put.append(box)
    assert 4 <= len(put) < 40
    on_table = [body_box(b) for b in bench.scene.bodies.values() if b.parent == TABLE]
    for index, first in enumerate(on_table):
        assert all(not boxes_overlap(first, second) for second in on_table[index + 1 :])
        assert first.floor_gap_m((6.6, 4.2)) <= REACH_M


def test_what_stands_on_the_floor_can_be_pushed_again_after_it_was_put_down(make_bench):
    bench = make_bench(AT_BALL)
    assert bench.do("pickup", BALL).ok
    assert BALL not in bench.physics._loose
    bench.body(BALL).held_by, bench.body(BALL).position_m = None, (3.5, 1.0, 0.0)
    bench.physics.place(BALL)
    assert BALL in bench.physics._loose
