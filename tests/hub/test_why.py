"""`why`: every source's word under the thing's line, and the words that tasks take."""

import pytest

from console.operate_commands import why_text
from hub.facts import handle, settle
from hub.why import find, why
from hub.world import World
from tests.hub.scenes import batch, card, flat, report, seen


def _flat() -> World:
    """Two cameras disagree on whether the television is on."""
    world = World(flat())
    world.fleet.take_card(card("dog-1"))
    world.report_robot(report("dog-1", 0.5, 0.5, 0.0))
    for look in range(6):
        stamp_s = 0.5 * look
        stand = seen("TVStand", 6.0, 3.5, 0.3, "stand")
        world.observe(batch("cam-1", stamp_s, seen("Television", 6.0, 3.5, 0.8, "tv", isToggled=0.95), stand))
        world.observe(batch("dog-1", stamp_s, seen("Television", 6.0, 3.5, 0.8, "tv", isToggled=0.02)))
        world.observe(batch("cam-1", stamp_s, seen("Mug", 1.0, 1.0, 0.8, "mug")))
        world.delta(stamp_s)
    return world


@pytest.mark.parametrize("words", ["tv", "every TV", "the telly in the lounge", "televisions", "Television"])
def test_the_words_of_tasks_find_a_thing(words: str) -> None:
    assert [entry.state.type for entry in why(_flat(), words, 3.0).entries] == ["Television"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("tlevision", "is television meant?"),
        ("microwve oven", "is microwave oven meant?"),
        ("xylophone", "nothing known of 'xylophone'; known are mug, television, tv stand"),
        ("fridge", "no fridge is known; known are mug"),
        ("mug in the bathroom", "no mug is known in bath; known are mug"),
    ],
)
def test_what_is_not_found_is_explained(words: str, said: str) -> None:
    reply = why(_flat(), words, 3.0)
    assert not reply.entries
    assert said in reply.text


def test_who_said_so_and_who_contradicts_stands_under_the_thing() -> None:
    lines = why_text(why(_flat(), "tv", 5.0)).splitlines()
    assert lines[0].startswith("Television obj-")
    assert all(line.startswith("  ") for line in lines[1:])
    assert "  cam-1: saw it 6 times, 90 % sure, 2 s ago" in lines
    (against,) = [line for line in lines if "CONTRADICTS" in line]
    assert "isToggled" in against


def test_what_was_so_before_a_robot_changed_it_contradicts_nobody() -> None:
    world = _flat()
    (tv,) = find(world, "tv")
    handle(tv.facts["isToggled"], "dog-1", False, 4.0)
    settle(tv.facts["isToggled"], 5.0, world.trust, frozenset(("dog-1",)))
    text = why_text(why(world, "tv", 5.0))
    assert "CONTRADICTS" not in text
    assert "cam-1: saw isToggled true, before it was changed" in text


def test_many_things_are_counted_and_a_room_is_a_question_too() -> None:
    world = _flat()
    for look in range(3):
        mugs = [seen("Mug", 0.4 + 0.7 * (n % 4), 0.4 + 0.7 * (n // 4), 0.8, f"mug-{n}") for n in range(16)]
        world.observe(batch("cam-2", 4.0 + look, *mugs))
        world.delta(4.0 + look)
    reply = why(world, "mugs", 7.0)
    assert len(reply.entries) == 12
    assert reply.more >= 4
    assert f"and {reply.more} more" in why_text(reply).splitlines()[-1]
    rooms = {entry.state.room for entry in why(world, "the lounge", 7.0).entries}
    assert rooms == {"living"}


def test_a_robot_is_told_from_an_object() -> None:
    assert why(_flat(), "dog-1", 3.0).text.startswith("dog-1 is a robot, at (0.50, 0.50) m")
