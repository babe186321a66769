"""What was found nowhere is looked for among what most looks took for it."""

from planners.tasks.likeness import as_taken, taken_for
from wire.messages.goal import Goal, Selector
from wire.messages.world import AreaState, ObjectState, WorldState


def thing(id: str, type: str, room: str = "living", **maybe: float) -> ObjectState:
    return ObjectState(
        id=id,
        type=type,
        position_enu_m=(1.0, 1.0, 0.4),
        covariance_m2=(0.01, 0.0, 0.01, 0.01),
        room=room,
        source="cam-1",
        stamp_s=0.0,
        confidence=0.9,
        maybe=maybe,
    )


def world(*objects: ObjectState, searched: bool = True) -> WorldState:
    areas = tuple(
        AreaState(id=id, name=id, kind="LivingRoom", seen_fraction=1.0, camera_fraction=0.5, searched=searched)
        for id in ("living", "bath")
    )
    return WorldState(seq=1, stamp_s=0.0, objects=objects, areas=areas)


def put(item: str, place: str) -> Goal:
    return Goal(predicate="in", subject=Selector(type=item), object=Selector(type=place))


BOOK = thing("obj-0", "Book")


def test_the_likeliest_is_taken_once_everything_was_searched() -> None:
    state = world(BOOK, thing("obj-1", "ArmChair", Sofa=0.48), thing("obj-2", "Bed", Sofa=0.2))
    taken = taken_for([put("Book", "Sofa")], state)
    assert taken == {"obj-1": "Sofa"}
    assert [o.type for o in as_taken(state, taken).objects] == ["Book", "Sofa", "Bed"]


def test_nothing_is_taken_while_rooms_are_unsearched() -> None:
    state = world(BOOK, thing("obj-1", "ArmChair", Sofa=0.48), searched=False)
    assert taken_for([put("Book", "Sofa")], state) == {}


def test_nothing_is_taken_for_what_is_known() -> None:
    state = world(BOOK, thing("obj-1", "ArmChair", Sofa=0.48), thing("obj-2", "Sofa"))
    assert taken_for([put("Book", "Sofa")], state) == {}
    assert as_taken(state, {}) is state


def test_what_is_asked_for_itself_is_not_taken_for_something_else() -> None:
    goals = [put("Book", "Sofa"), put("Book", "ArmChair")]
    assert taken_for(goals, world(BOOK, thing("obj-1", "ArmChair", Sofa=0.48))) == {}


def test_the_room_asked_for_counts() -> None:
    goal = Goal(predicate="off", subject=Selector(type="FloorLamp", room="bath"))
    far, near = thing("obj-1", "DeskLamp", FloorLamp=0.4), thing("obj-2", "DeskLamp", "bath", FloorLamp=0.3)
    assert taken_for([goal], world(far, near)) == {"obj-2": "FloorLamp"}
    assert taken_for([goal], world(far)) == {}
