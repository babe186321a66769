"""What is left out stays where it is; goals of one clause are told apart; things are called by ids of any look."""

import pytest

from planners.scripted.goals import read_goals
from planners.scripted.planner import ScriptedPlanner
from planners.scripted.syntax import Unclear
from tests.planners.executor import run
from tests.planners.test_corpus import WORLD, reading
from tests.planners.test_language import thing
from tests.planners.toy import ROOMS, House, site
from wire.messages.plan import PlanRequest

EVERYWHERE = tuple(id for id, _, _ in ROOMS)


def house_with_mugs() -> House:
    house = House(4, cameras=EVERYWHERE)
    for type, room in (("CounterTop", "kitchen"), ("Sink", "kitchen"), ("Desk", "bedroom-1"), ("Sofa", "living-room")):
        house.add(type, room)
    house.add("Mug", "kitchen", "countertop-1")
    house.add("Mug", "bedroom-1", "desk-1")
    house.add("Mug", "living-room", "sofa-1")
    return house


@pytest.mark.parametrize(
    ("words", "moved"),
    [
        ("put all mugs except the one in the kitchen into the sink", {"mug-2", "mug-3"}),
        ("put all mugs in the sink except the one on the sofa", {"mug-1", "mug-2"}),
    ],
)
def test_what_is_excepted_stays_where_it_is(words: str, moved: set[str]) -> None:
    house = house_with_mugs()
    reply, _, _ = run(house, ScriptedPlanner(site()), words)
    assert reply.plan is not None, reply.refusal
    assert {t.id for t in house.things.values() if t.type == "Mug" and t.parent == "sink-1"} == moved


def test_what_is_carried_past_an_exception_is_still_to_be_moved() -> None:
    """A mug on its way to the sink is in the kitchen too."""
    house = house_with_mugs()
    request = PlanRequest(
        task="t-1",
        epoch=1,
        instruction="put all mugs except the one in the kitchen into the sink",
        world=house.world(),
        now_s=0.0,
    )
    plan = ScriptedPlanner(site()).make_plan(request).plan
    assert plan is not None
    assert {goal.subject.id for goal in plan.goals} == {None, "mug-2", "mug-3"}


def texts(sentence: str) -> list[str]:
    return [goal.text for goal in read_goals(sentence, WORLD)]


def test_every_goal_of_a_clause_has_its_own_text() -> None:
    assert texts("visit every room")[:2] == ["visit every room (Kitchen)", "visit every room (Bedroom 1)"]
    assert texts("turn off the lamps in the bedrooms") == [
        "turn off the lamps in the bedrooms (desk lamp, Bedroom 1)",
        "turn off the lamps in the bedrooms (desk lamp, Bedroom 2)",
        "turn off the lamps in the bedrooms (floor lamp, Bedroom 1)",
        "turn off the lamps in the bedrooms (floor lamp, Bedroom 2)",
    ]
    assert texts("put the mug in the sink and a mug on the coffee table") == [
        "put the mug in the sink and a mug on the coffee table (sink)",
        "put the mug in the sink and a mug on the coffee table (coffee table)",
    ]
    assert texts("turn off the TV, then close the fridge") == ["turn off the TV", "close the fridge"]


def test_ids_with_letters_are_words() -> None:
    world = WORLD.model_copy(update={"objects": (thing("obj-3f2a", "Television", "kitchen"),)})
    assert reading("turn off obj-3f2a", world) == "off(Television[id=obj-3f2a])"


def test_switching_everything_is_about_what_is_known_and_what_homes_have() -> None:
    world = WORLD.model_copy(update={"objects": (thing("candle-1", "Candle", "kitchen"),)})
    assert "off(Candle*)" in reading("turn everything off", world)
    assert "Candle" not in reading("turn off everything in bedroom 1", world)


def test_a_state_tells_which_thing_only_when_there_is_one() -> None:
    """With one of two TVs off already, "at least one is off" would do nothing about the one that is on."""
    one = WORLD.model_copy(update={"objects": (thing("tv-1", "Television", "kitchen"),)})
    two = WORLD.model_copy(update={"objects": (*one.objects, thing("tv-2", "Television", "living-room"))})
    assert reading("turn off the TV that is on", one) == "off(Television)"
    assert reading("turn off the TV that is on", two) == "off(Television*)"


@pytest.mark.parametrize(
    ("sentence", "reason"),
    [
        ("dog-1, put the apple in the fridge", "robots are chosen by the planner: leave out 'dog-1'"),
        ("stop the robots", "./justw stop"),
        ("pause", "./justw pause"),
        ("cancel", "./justw cancel TASK"),
        ("undo that", "say what should be true instead"),
        ("check whether the tv is on", "questions are not answered"),
        ("turn off tv 2", "nothing here is called 'tv 2'"),
        ("wash the mug in the sink", "where 'the mug' is, or where to do it"),
        ("first open the fridge then close it", "which is all that a task is about"),
        ("turn off all but one tv", "which should be left out"),
        ("no tv is on", "only says how things are"),
        ("put exactly two mugs in the sink", "a number means at least so many"),
    ],
)
def test_refusals_say_what_to_do(sentence: str, reason: str) -> None:
    with pytest.raises(Unclear) as refused:
        read_goals(sentence, WORLD)
    assert reason in refused.value.reason


@pytest.mark.parametrize(
    ("words", "moved"),
    [
        ("put all mugs in the kitchen into the sink", {"mug-1"}),
        ("put all mugs except the one on the sofa into the sink and wash all mugs", {"mug-1", "mug-2"}),
    ],
)
def test_a_thing_of_a_list_is_moved_once_and_still_washed(words: str, moved: set[str]) -> None:
    house = house_with_mugs()
    for number in (1, 2, 3):
        house.things[f"mug-{number}"].props["isDirty"] = True
    reply, _, _ = run(house, ScriptedPlanner(site()), words)
    assert reply.plan is not None, reply.refusal
    assert {t.id for t in house.things.values() if t.type == "Mug" and t.parent == "sink-1"} == moved
    assert any(house.things[f"mug-{n}"].props["isDirty"] for n in (1, 2, 3)) is ("wash" not in words)


def test_what_is_where_it_should_be_already_is_still_washed() -> None:
    house = house_with_mugs()
    house.things["mug-1"].props["isDirty"] = True
    del house.things["mug-2"], house.things["mug-3"]
    reply, _, _ = run(house, ScriptedPlanner(site()), "wash the mug and bring it to the kitchen")
    assert reply.plan is not None, reply.refusal
    assert not house.things["mug-1"].props["isDirty"]
