"""What the hub answers to plans that cannot be carried out."""

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hub.ability import Ability
from hub.checks import faults
from hub.floor import FloorPlan
from tests.hub.scenes import ACTIONS, flat
from wire.messages.plan import Plan, PlanNode
from wire.messages.world import ObjectState, PropertyState, RobotState, WorldState

SKILLS = {"dog-1": ACTIONS, "dog-2": ACTIONS}


def _object(id: str, type: str, room: str = "kitchen", receptacle: str | None = None, **props: bool) -> ObjectState:
    return ObjectState(
        id=id,
        type=type,
        position_enu_m=(2.0, 2.0, 0.8),
        covariance_m2=(0.01, 0.0, 0.01, 0.01),
        receptacle=receptacle,
        props={n: PropertyState(value=v, confidence=0.9, source="cam-1", stamp_s=0.0) for n, v in props.items()},
        room=room,
        source="cam-1",
        stamp_s=0.0,
        confidence=0.9,
    )


def _world(**robot: object) -> WorldState:
    dog = {"id": "dog-1", "kind": "quadruped", "position_enu_m": (1.0, 1.0, 0.3), "yaw_deg": 0.0, "status": "idle"}
    return WorldState(
        seq=1,
        stamp_s=0.0,
        robots=(RobotState.model_validate(dog | {"stamp_s": 0.0, "room": "kitchen"} | robot),),
        objects=(
            _object("apple", "Apple"),
            _object("egg", "Potato", receptacle="fridge"),
            _object("fridge", "Fridge", isOpen=False),
            _object("table", "DiningTable"),
            _object("tv", "Television", room="living", isToggled=True),
            _object("mug", "Mug"),
            _object("knife", "Knife"),
            _object("tomato", "Tomato", isSliced=True),
            _object("oven", "Microwave", isOpen=False, isToggled=True),
            _object("grill", "Microwave", isOpen=True, isToggled=False),
            _object("laptop", "Laptop", isOpen=False, isToggled=False),
        ),
    )


def _faults(
    *nodes: PlanNode,
    world: WorldState | None = None,
    skills: dict[str, tuple[str, ...]] = SKILLS,
    payload_kg: float = 3.0,
) -> list[str]:
    plan = Plan(id="p-1", task="t-1", planner="toy", goals=(), nodes=nodes)
    abilities = {robot: Ability(has, payload_kg) for robot, has in skills.items()}
    return faults(plan, world or _world(), abilities, FloorPlan(flat()))


OPEN = PlanNode(id="open", action="open", object="fridge")
TAKE = PlanNode(id="take", action="pickup", object="apple")
PUT = PlanNode(id="put", action="put", object="fridge", item="apple", same_robot_as="take", after=("take", "open"))


def test_a_good_plan_has_no_faults() -> None:
    assert _faults(OPEN, TAKE, PUT, PlanNode(id="off", action="toggle_off", object="tv")) == []


@pytest.mark.parametrize(
    ("nodes", "words"),
    [
        ((TAKE, TAKE), "appears 2 times"),
        ((PlanNode(id="a", action="pickup", object="apple", after=("b",)),), "not in the plan"),
        ((PlanNode(id="a", action="pickup", object="pear"),), "there is no object pear"),
        ((PlanNode(id="a", action="explore", room="attic"),), "there is no room attic"),
        ((PlanNode(id="a", action="explore"),), "names no room"),
        ((PlanNode(id="a", action="pickup"),), "names no object"),
        ((PlanNode(id="a", action="put", object="table"),), "which item"),
        ((PlanNode(id="a", action="toggle_on", object="apple"),), "not toggleable"),
        ((PlanNode(id="a", action="pickup", object="fridge"),), "not pickupable"),
        ((PlanNode(id="a", action="goto"),), "names no place"),
        ((PlanNode(id="a", action="goto", room="bath", goal=3),), "serves goal 3"),
        ((PlanNode(id="a", action="put", object="table", item="apple"),), "pick it up first"),
        ((OPEN, TAKE, PUT.model_copy(update={"after": ("take",)})), "fridge is closed"),
        ((OPEN, TAKE, PUT.model_copy(update={"after": ("open",)})), "nobody has apple in hand|must wait for take"),
        ((PlanNode(id="a", action="pickup", object="egg"),), "egg is in fridge, which is closed"),
        ((TAKE, PlanNode(id="again", action="pickup", object="apple", after=("take",))), "already in a hand"),
        ((PlanNode(id="a", action="goto", room="bath", req_skills=("fly",)),), "no robot can fly"),
    ],
)
def test_each_fault_is_named(nodes: tuple[PlanNode, ...], words: str) -> None:
    found = _faults(*nodes)
    assert found
    assert any(word in text for text in found for word in words.split("|")), found


def test_skills_are_of_robots_that_are_there() -> None:
    assert _faults(TAKE, skills={}) == ["no robot is there"]
    assert "no robot can pickup" in _faults(TAKE, skills={"dog-1": ("goto",)})[0]
    wanted = TAKE.model_copy(update={"preferred_robot": "dog-1"})
    assert "prefers dog-1" in _faults(wanted, skills={"dog-1": ("goto",), "dog-2": ACTIONS})[0]


def test_what_is_held_already_may_be_put() -> None:
    world = _world(inventory="apple")
    assert _faults(PlanNode(id="a", action="put", object="table", item="apple"), world=world) == []


def test_an_open_fridge_needs_no_opening() -> None:
    world = _world()
    fridge = _object("fridge", "Fridge", isOpen=True)
    world = world.model_copy(update={"objects": tuple(fridge if o.id == "fridge" else o for o in world.objects)})
    assert _faults(PlanNode(id="a", action="pickup", object="egg"), world=world) == []


def node(id: str, action: str, object: str, *after: str, **more: object) -> PlanNode:
    return PlanNode.model_validate({"id": id, "action": action, "object": object, "after": after} | more)


A, B = node("a", "pickup", "apple"), node("b", "pickup", "mug", "a", same_robot_as="a")
ON_TABLE = node("p", "put", "table", "a", item="apple", same_robot_as="a")
WISHED = tuple(n.model_copy(update={"preferred_robot": "dog-1"}) for n in (A, node("b", "pickup", "mug", "a")))
BLADE = node("k", "pickup", "knife")
CUT = node("s", "slice", "apple", "k", item="knife", same_robot_as="k")


@pytest.mark.parametrize(
    ("nodes", "words"),
    [
        ((A, B), "node b (pickup): double grasp: the robot of a still has apple in its hand from node a"),
        ((A, B.model_copy(update={"after": ()})), "double grasp"),
        ((A, B, ON_TABLE.model_copy(update={"after": ("a", "b")})), "double grasp"),
        (WISHED, "node b (pickup): double grasp: dog-1 still has apple in its hand from node a"),
        ((A, node("b", "pickup", "mug"), node("c", "pickup", "knife")), "apple, knife, mug would be in hands at once"),
        ((A, node("c", "clean", "mug", "a", same_robot_as="a")), "cleaning needs an empty hand"),
        ((PlanNode(id="a", action="goto", room="bath", preferred_robot="dog-99"),), "robots are dog-1, dog-2"),
        ((PlanNode(id="a", action="explore", room="bath", looking_for=("Unicorn",)),), "Unicorn is no type of object"),
        ((PlanNode(id="a", action="explore", room="bath", looking_for=("Mugg",)),), "named like Mug"),
        ((PlanNode(id="a", action="goto", point_m=(50.0, 2.0)),), "(50, 2) lies outside of every room; the rooms lie"),
        ((node("a", "pickup", "mugg"),), "there is no object mugg; the world has mug (Mug)"),
        ((A, node("s", "slice", "apple", "a", same_robot_as="a")), "apple is in a hand (a)"),
        ((node("s", "slice", "apple"),), "slicing needs a Knife or ButterKnife in the robot's hand"),
        ((CUT.model_copy(update={"after": (), "same_robot_as": None}),), "nobody has knife in hand"),
        ((BLADE, CUT.model_copy(update={"after": ()})), "nobody has knife in hand|must wait for k"),
        (
            (B.model_copy(update={"after": (), "same_robot_as": None}), node("s", "slice", "apple", "b", item="mug")),
            "is a Mug",
        ),
        ((node("a", "pickup", "tomato"),), "tomato has been sliced"),
        ((BLADE, CUT, A.model_copy(update={"after": ("s",)})), "apple may be sliced by s before"),
        ((BLADE, CUT, A), "apple may be sliced by s before"),
        ((node("o", "open", "oven"),), "oven runs: switch it off in a node that this one waits for"),
        ((node("x", "toggle_off", "oven"), node("o", "open", "oven")), "oven runs"),
        ((node("t", "toggle_on", "grill"),), "grill is open: close it"),
        ((node("t", "toggle_on", "laptop"),), "laptop is closed: open it"),
    ],
)
def test_what_would_fail_on_the_way_is_named(nodes: tuple[PlanNode, ...], words: str) -> None:
    found = _faults(*nodes)
    assert any(word in text for text in found for word in words.split("|")), found


@pytest.mark.parametrize(
    "nodes",
    [
        (A, ON_TABLE, B.model_copy(update={"after": ("p",)})),
        (A, ON_TABLE, B),  # whoever does a and b puts the apple down in between, whatever b waits for
        (A, node("b", "pickup", "mug", "a")),  # two robots, a hand each
        (*WISHED[:1], ON_TABLE, WISHED[1].model_copy(update={"after": ("p",)})),
        (BLADE, CUT, node("p", "put", "table", "s", item="knife", same_robot_as="k")),
        (BLADE, CUT.model_copy(update={"item": None})),
        (A, ON_TABLE, BLADE, CUT.model_copy(update={"after": ("k", "p")})),
        (node("x", "toggle_off", "oven"), node("o", "open", "oven", "x")),
        (node("c", "close", "grill"), node("t", "toggle_on", "grill", "c")),
        (node("o", "open", "laptop"), node("t", "toggle_on", "laptop", "o")),
        (PlanNode(id="a", action="explore", room="bath", looking_for=("Mug",), preferred_robot="dog-2"),),
        (PlanNode(id="a", action="goto", point_m=(4.0, 0.5)),),  # within a wall between two rooms
    ],
)
def test_what_can_be_carried_out_is_not_blamed(nodes: tuple[PlanNode, ...]) -> None:
    assert _faults(*nodes) == []


def test_one_robot_with_a_full_hand_takes_nothing_more() -> None:
    world, alone = _world(inventory="mug"), {"dog-1": ACTIONS}
    assert _faults(A, world=world, skills=alone) == [
        "node a (pickup): apple, mug would be in hands at once, but 1 robot has a hand: put something down before"
    ]
    down = node("p", "put", "table", item="mug")
    assert _faults(down, A.model_copy(update={"after": ("p",)}), world=world, skills=alone) == []
    assert _faults(A, world=world, skills=SKILLS) == []


def test_a_robot_that_is_away_is_no_fault() -> None:
    wished = PlanNode(id="a", action="goto", room="bath", preferred_robot="dog-1")
    assert _faults(wished, skills={"dog-2": ACTIONS}) == [], "the wish falls away"


@given(seed=st.integers(0, 100_000), size=st.integers(2, 12))
@settings(max_examples=60, deadline=None)
def test_circles_are_found_and_graphs_without_are_not_blamed(seed: int, size: int) -> None:
    rng = random.Random(seed)
    names = [f"n-{i}" for i in range(size)]
    after = {n: tuple(sorted(rng.sample(names[:i], rng.randint(0, min(i, 3))))) for i, n in enumerate(names)}
    shuffled = rng.sample(names, size)
    nodes = [PlanNode(id=n, action="goto", room="bath", after=after[n]) for n in shuffled]
    assert _faults(*nodes) == []
    first, last = sorted(rng.sample(range(size), 2))
    chain = {names[k]: (*after[names[k]], names[k - 1]) for k in range(first + 1, last + 1)}
    chain[names[first]] = (*after[names[first]], names[last])
    circular = [n.model_copy(update={"after": tuple(dict.fromkeys(chain.get(n.id, n.after)))}) for n in nodes]
    assert "in a circle" in _faults(*circular)[0]


def test_what_is_too_heavy_for_every_robot_is_refused() -> None:
    world = _world().model_copy(update={"objects": (*_world().objects, _object("weight", "Dumbbell"))})
    lift = PlanNode(id="lift", action="pickup", object="weight")
    assert _faults(lift, world=world) == [
        "node lift (pickup): a Dumbbell weighs about 5 kg, and no robot lifts more than 3 kg"
    ]
    assert _faults(lift, world=world, payload_kg=6.0) == []
