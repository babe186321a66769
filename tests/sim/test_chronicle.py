"""Which room visits came in order: a robot must be there at some time after what comes first."""

import pytest

from sim.chronicle import Chronicle
from wire.messages.goal import Goal, Selector
from wire.messages.world import AreaState, ObjectState, PropertyState, RobotState, WorldState

GOALS = (
    Goal(predicate="off", subject=Selector(type="Television"), text="turn off the TV"),
    Goal(predicate="visited", subject=Selector(room="kitchen"), after=(0,)),
)


def world(stamp_s: float, room: str, been: bool, on: bool) -> WorldState:
    dog = RobotState(
        id="dog-1",
        kind="quadruped",
        position_enu_m=(0.0, 0.0, 0.0),
        yaw_deg=0.0,
        status="idle",
        stamp_s=stamp_s,
        room=room,
    )
    television = ObjectState(
        id="t-1",
        type="Television",
        position_enu_m=(0.0, 0.0, 0.0),
        covariance_m2=(0.0, 0.0, 0.0, 0.0),
        props={"isToggled": PropertyState(value=on, confidence=1.0, source="sim", stamp_s=stamp_s)},
        source="sim",
        stamp_s=stamp_s,
        confidence=1.0,
    )
    kitchen = AreaState(
        id="kitchen", name="Kitchen", kind="Kitchen", seen_fraction=0.0, camera_fraction=0.0, searched=been
    )
    return WorldState(seq=0, stamp_s=stamp_s, robots=(dog,), objects=(television,), areas=(kitchen,))


@pytest.mark.parametrize(
    ("rooms", "switched_off_at", "kept"),
    [
        (["hall", "kitchen", "living", "living"], 3, False),
        (["hall", "kitchen", "living", "kitchen"], 2, True),
        (["hall", "kitchen", "kitchen", "kitchen"], 2, True),
        (["kitchen", "living", "living", "living"], 2, True),
        (["hall", "living", "living", "living"], 2, True),
    ],
)
def test_a_visit_counts_when_a_robot_is_there_afterwards(rooms: list[str], switched_off_at: int, kept: bool) -> None:
    chronicle = Chronicle()
    for second, room in enumerate(rooms):
        chronicle.note(world(float(second), room, "kitchen" in rooms[: second + 1], second < switched_off_at))
    assert (chronicle.disorder(GOALS, 1, 0.0) == "") is kept


def test_only_changes_are_remembered() -> None:
    chronicle = Chronicle()
    for second in range(100):
        chronicle.note(world(float(second), "hall", False, second < 50))
    assert len(chronicle._worlds) == 2
