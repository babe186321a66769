"""The reading of goals, predicate by predicate."""

import pytest
from hypothesis import given

from tests.wire.messages import messages
from wire.goals import holds, select
from wire.messages.goal import Goal, Predicate, Selector
from wire.messages.world import AreaState, ObjectState, PropertyState, RobotState, WorldState


def thing(id: str, type: str, *, room: str = "kitchen", inside: str | None = None, **props: bool) -> ObjectState:
    states = {
        name: PropertyState(value=value, confidence=0.9, source="cam-1", stamp_s=0.0) for name, value in props.items()
    }
    return ObjectState(
        id=id, type=type, position_enu_m=(0.0, 0.0, 0.0), covariance_m2=(0.1, 0.0, 0.1, 0.1), receptacle=inside,
        props=states, room=room, source="cam-1", stamp_s=0.0, confidence=0.9, verified=id == "mug-1",
    )  # fmt: skip


DOG = RobotState(id="dog-1", kind="quadruped", position_enu_m=(0.0, 0.0, 0.0), yaw_deg=0.0, status="idle", stamp_s=0.0)
WORLD = WorldState(
    seq=1,
    stamp_s=0.0,
    robots=(DOG,),
    objects=(
        thing("fridge-1", "Fridge", isOpen=True),
        thing("mug-1", "Mug", inside="fridge-1", isDirty=False),
        thing("mug-2", "Mug", room="bedroom", isDirty=True),
        thing("mug-3", "Mug", inside="dog-1"),
        thing("tv-1", "Television", room="bedroom", isToggled=False),
    ),
    areas=(AreaState(id="kitchen", name="K", kind="Kitchen", seen_fraction=1.0, camera_fraction=0.5, searched=True),),
)
MUG = Selector(type="Mug")
ALL_MUGS = Selector(type="Mug", count=None)
FRIDGE = Selector(type="Fridge")


@pytest.mark.parametrize(
    ("predicate", "subject", "place", "expected"),
    [
        ("in", MUG, FRIDGE, True),
        ("in", ALL_MUGS, FRIDGE, False),
        ("in", Selector(type="Mug", count=2), FRIDGE, False),
        ("in", Selector(id="mug-2"), FRIDGE, False),
        ("at", Selector(id="mug-2"), Selector(room="bedroom"), True),
        ("at", Selector(id="mug-3"), Selector(room="kitchen"), False),  # a robot still carries it
        ("open", FRIDGE, None, True),
        ("closed", FRIDGE, None, False),
        ("off", Selector(type="Television"), None, True),
        ("on", Selector(type="Television"), None, False),
        ("clean", Selector(id="mug-1"), None, True),
        ("clean", ALL_MUGS, None, False),
        ("clean", Selector(type="Mug", room="bedroom"), None, False),
        ("sliced", MUG, None, False),
        ("found", Selector(id="mug-1"), None, True),
        ("found", Selector(id="mug-2"), None, False),
        ("visited", Selector(room="kitchen"), None, True),
        ("visited", Selector(room="bedroom"), None, False),
        ("off", Selector(type="Lamp", count=None), None, True),  # none there is none left on
        ("off", Selector(type="Lamp"), None, False),
    ],
)
def test_predicate(predicate: Predicate, subject: Selector, place: Selector | None, expected: bool) -> None:
    assert holds(Goal(predicate=predicate, subject=subject, object=place), WORLD) is expected


def test_selectors() -> None:
    def ids(selector: Selector) -> list[str]:
        return [obj.id for obj in select(selector, WORLD)]

    assert ids(ALL_MUGS) == ["mug-1", "mug-2", "mug-3"]
    assert ids(Selector(type="Mug", room="bedroom")) == ["mug-2"]
    assert ids(Selector(type="Mug", inside="Fridge")) == ["mug-1"]
    assert ids(Selector(type="Mug", exclude=(Selector(id="mug-1"), Selector(room="bedroom")))) == ["mug-3"]
    assert ids(Selector(type="Sofa")) == []


@given(messages(Goal), messages(WorldState))
def test_negation_turns_every_goal_around(goal: Goal, world: WorldState) -> None:
    asked = goal.model_copy(update={"forbidden": False, "negated": False})
    denied = asked.model_copy(update={"negated": True})
    assert holds(asked, world) != holds(denied, world)
    assert holds(goal.model_copy(update={"forbidden": True}), world)
