"""The language as a whole: combinations read as their parts do, and one strange word refuses everything."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.scripted.goals import read_goals
from planners.scripted.parse import grammar
from planners.scripted.syntax import Unclear
from tests.planners.test_corpus import WORLD, reading
from wire.messages.goal import Goal, Selector
from wire.messages.world import ObjectState

ITEMS = {"apple": "Apple", "mug": "Mug", "book": "Book", "remote control": "RemoteControl", "plate": "Plate"}
HOLDERS = {"dining table": "DiningTable", "sofa": "Sofa", "desk": "Desk", "counter": "CounterTop"}
SWITCHES = {"TV": "Television", "floor lamp": "FloorLamp", "microwave": "Microwave"}
STRANGE = ("zorblax", "xylophone", "quickly", "sideways", "dragon", "moonwards", "пылесос")


def moved(verb: str, item: str, holder: str) -> tuple[str, Goal]:
    goal = Goal(predicate="in", subject=Selector(type=ITEMS[item]), object=Selector(type=HOLDERS[holder]))
    return f"{verb} the {item} on the {holder}", goal


def switched(state: str, every: bool, name: str) -> tuple[str, Goal]:
    subject = Selector(type=SWITCHES[name], count=None if every else 1)
    return f"turn {state} {'every' if every else 'the'} {name}", Goal(predicate=state, subject=subject)  # type: ignore[arg-type]


clauses = st.one_of(
    st.builds(
        moved, st.sampled_from(("put", "place")), st.sampled_from(sorted(ITEMS)), st.sampled_from(sorted(HOLDERS))
    ),
    st.builds(switched, st.just("off"), st.booleans(), st.sampled_from(sorted(SWITCHES))),
)
distinct = st.lists(clauses, min_size=1, max_size=4, unique_by=lambda clause: clause[1].subject.type)


@settings(max_examples=80, deadline=None)
@given(parts=distinct, joint=st.sampled_from((" and ", ", ", "; ", ", and ")), polite=st.booleans())
def test_parts_read_alone_as_together(parts: list[tuple[str, Goal]], joint: str, polite: bool) -> None:
    sentence = joint.join(text for text, _ in parts)
    goals = read_goals(f"could you please {sentence}?" if polite else sentence, WORLD)
    assert [g.model_copy(update={"text": ""}) for g in goals] == [goal for _, goal in parts]


@settings(max_examples=40, deadline=None)
@given(parts=distinct)
def test_then_orders(parts: list[tuple[str, Goal]]) -> None:
    goals = read_goals(", then ".join(text for text, _ in parts), WORLD)
    assert [goal.after for goal in goals] == [(i - 1,) if i else () for i in range(len(parts))]


@settings(max_examples=80, deadline=None)
@given(parts=distinct, word=st.sampled_from(STRANGE), place=st.integers(0, 40))
def test_one_strange_word_refuses_everything(parts: list[tuple[str, Goal]], word: str, place: int) -> None:
    words = " and ".join(text for text, _ in parts).split()
    words.insert(place % (len(words) + 1), word)
    with pytest.raises(Unclear) as refused:
        read_goals(" ".join(words), WORLD)
    assert word in refused.value.reason


@settings(max_examples=100, deadline=None)
@given(text=st.text(max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    assert reading(text)


KNOWN = "put the on in and then it all from to off turn open not except one there of two apple kitchen ,".split()  # noqa: SIM905


@settings(max_examples=120, deadline=None)
@given(words=st.lists(st.sampled_from(KNOWN), max_size=12))
def test_any_order_of_known_words_is_read_or_refused(words: list[str]) -> None:
    assert reading(" ".join(words))


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("aple", "Apple"),
        ("appel", "Apple"),
        ("cofee table", "CoffeeTable"),
        ("teddybear", "TeddyBear"),
        ("laptp", "Laptop"),
    ],
)
def test_slips_are_corrected(typed: str, meant: str) -> None:
    assert read_goals(f"find the {typed}", WORLD)[0].subject.type == meant


@pytest.mark.parametrize("typed", ["cable", "tablet", "chain", "lamq", "cake"])
def test_other_words_are_not_bent_to_fit(typed: str) -> None:
    with pytest.raises(Unclear):
        read_goals(f"find the {typed}", WORLD)


def thing(id: str, type: str, room: str) -> ObjectState:
    return ObjectState(
        id=id,
        type=type,
        position_enu_m=(0.0, 0.0, 0.0),
        covariance_m2=(0.1, 0.0, 0.1, 0.1),
        room=room,
        source="cam-1",
        stamp_s=0.0,
        confidence=0.9,
    )


def test_the_world_settles_which_kind_is_meant() -> None:
    world = WORLD.model_copy(update={"objects": (thing("coffeetable-1", "CoffeeTable", "living-room"),)})
    assert reading("put the mug on the table") == "? the table"
    assert reading("put the mug on the table", world) == "in(Mug,CoffeeTable)"


def test_things_can_be_called_by_id() -> None:
    world = WORLD.model_copy(update={"objects": (thing("mug-2", "Mug", "kitchen"),)})
    assert reading("put mug-2 on the sofa", world) == "in(Mug[id=mug-2],Sofa)"
    assert reading("put mug-3 on the sofa", world) == "! mug-3"


def test_what_no_camera_knows_is_known_once_it_is_in_the_world() -> None:
    world = WORLD.model_copy(update={"objects": (thing("drawer-1", "Drawer", "kitchen"),)})
    assert reading("open the drawer") == "! the drawer"
    assert reading("open the drawer", world) == "open(Drawer)"


def test_the_grammar_has_one_reading() -> None:
    assert grammar().options.strict, "lark then refuses a grammar with conflicts"
