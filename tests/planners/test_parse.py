"""Replies of models to steps: what may stand around the JSON, what may not be in it, and the sentence for each fault."""

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planners.parse import Cannot, Faulty, entries, is_more, object_with, read_steps
from planners.prompt import Names
from planners.writing.offered import Offered, offer
from tests.planners.test_tasks import furnished
from tests.planners.toy import ROOMS
from wire.messages.plan import PlanRequest, SkillCard

TAKE_OFF = SkillCard(name="take_off", doc="Up.", parameters='{"properties": {"height_m": {"type": "number"}}}')


def offered() -> Offered:
    world = furnished(1, tuple(id for id, _, _ in ROOMS)).world()
    robots = tuple(r.model_copy(update={"skills": (*r.skills, "take_off")}) for r in world.robots)
    world = world.model_copy(update={"robots": robots})
    return offer(PlanRequest(task="t", epoch=1, instruction="", world=world, skills=(TAKE_OFF,), now_s=1.0), Names())


OFFERED = offered()
GOOD = {"id": "s1", "do": "pickup", "object": "apple1", "robot": "dog-1", "after": []}


def faults_of(*steps: dict[str, Any]) -> list[str]:
    return faults_in(json.dumps({"steps": list(steps)}))


def faults_in(text: str) -> list[str]:
    """Of a reply; none where its steps can be used."""
    try:
        read_steps(entries(object_with(text, "steps"), "steps"), OFFERED)
    except Faulty as faulty:
        return list(faulty.faults)
    return []


@pytest.mark.parametrize(
    "text",
    [
        '{"steps": [], "more": false}',
        'Sure! Here is the plan:\n```json\n{"steps": []}\n```\nGood luck.',
        '{"thought": "first {look}"} and then {"steps": []}',
        '<think>{not json}</think>{"steps": [], "note": {"a": [1]}}',
    ],
)
def test_what_stands_around_the_object_does_not_matter(text: str) -> None:
    document = object_with(text, "steps")
    assert entries(document, "steps") == []
    assert not is_more(document)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no whole JSON object"),
        ('{"steps": [{"id": "s1", ', "no whole JSON object"),
        ('[{"id": "s1"}]', "no whole JSON object"),
        ('{"steps": {"id": "s1"}}', "must be a list"),
        ('{"steps": ["s1"]}', "must be an object"),
        ('{"steps": [], "more": true}', "list what finds out"),
        (json.dumps({"steps": [{}] * 97}), "at most 96"),
    ],
)
def test_what_is_no_list_of_steps_is_said(text: str, words: str) -> None:
    with pytest.raises(Faulty, match=words):
        object_with(text, "steps")


def test_the_models_own_word_that_it_cannot_be_done_is_heard() -> None:
    with pytest.raises(Cannot, match="nobody can fly"):
        object_with('{"steps": [], "cannot": "nobody can fly"}', "steps")
    assert object_with('{"steps": [], "cannot": ""}', "steps")["steps"] == []


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"object": "apple99"}, 'step s1: there is no thing "apple99"; there are apple1'),
        ({"object": "apple-1"}, 'there is no thing "apple-1"'),  # a hub's id was not offered
        ({"item": "mugs"}, 'there is no thing "mugs"'),
        ({"do": "explore", "object": None, "room": "attic"}, 'there is no room "attic"; there are'),
        ({"do": "fly"}, 'there is no skill "fly"'),
        ({"do": None}, '"do" is missing|no skill'),
        ({"robot": "dog-9"}, 'there is no robot "dog-9"; there are dog-1'),
        ({"do": "explore", "object": None, "room": "kitchen", "looking_for": ["Unicorn"]}, '"Unicorn" is not among'),
        ({"do": "open", "room": "kitchen"}, "open takes object, not room"),
        ({"after": ["s7"]}, "waits for s7, which is no step"),
        ({"after": "s7"}, "waits for s7, which is no step"),
        ({"id": {"a": 1}}, "an id must be a short word"),
        ({"colour": "red"}, "colour is no part of a step"),
        ({"params": {"height_m": 1.0}}, "height_m is no parameter of pickup"),
        ({"params": [1]}, "params must be an object"),
        ({"do": "take_off", "object": None, "params": {"height": 1.0}}, "height is no parameter of take_off; height_m"),
        ({"point_m": "here"}, "point_m must be"),
    ],
)
def test_each_fault_is_one_sentence_that_names_it(change: dict[str, Any], words: str) -> None:
    found = faults_of({k: v for k, v in {**GOOD, **change}.items() if v is not None})
    assert any(word in text for text in found for word in words.split("|")), found
    assert all("\n" not in text for text in found)


def test_a_robot_is_not_given_what_it_cannot_do() -> None:
    world = furnished(1, tuple(id for id, _, _ in ROOMS)).world()
    dog = world.robots[0]
    robots = (dog.model_copy(update={"skills": ("goto",)}), dog.model_copy(update={"id": "dog-2"}))
    world = world.model_copy(update={"robots": robots})
    asked = offer(PlanRequest(task="t", epoch=1, instruction="", world=world, now_s=1.0), Names())
    with pytest.raises(Faulty, match="step s1: dog-1 cannot pickup; dog-2"):
        read_steps([GOOD], asked)
    assert read_steps([{**GOOD, "robot": "dog-2"}], asked)[0].robot == "dog-2"


def test_two_steps_with_one_id_are_told_apart_by_nobody() -> None:
    assert faults_of(GOOD, GOOD) == ["two steps have the id s1: give each its own"]


def test_short_names_become_the_hubs_ids_and_what_can_be_meant_is_taken() -> None:
    raw = [
        {"id": 1, "do": "pickup", "object": "apple1"},
        {"id": "S2", "do": "explore", "room": "kitchen", "looking_for": "tv stand", "after": 1},
        {"id": "s3", "do": "take_off", "params": {"height_m": 1.5}, "object": "", "robot": None},
    ]
    first, second, third = read_steps(raw, OFFERED)
    assert (first.id, first.object) == ("1", "apple-1")
    assert (second.id, second.looking_for, second.after) == ("s2", ("TVStand",), ("1",))
    assert (third.params, third.object, third.robot) == ({"height_m": 1.5}, None, None)


leaves = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=8)
values = st.recursive(
    leaves, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3)
)
KEYS = ["id", "do", "object", "item", "room", "looking_for", "point_m", "params", "robot", "after", "x"]
raw_steps = st.dictionaries(
    st.sampled_from(KEYS), values | st.sampled_from(["pickup", "apple1", "s1", "kitchen"]), max_size=11
)


@given(steps=st.lists(raw_steps, max_size=4), before=st.text(max_size=20), after=st.text(max_size=20))
def test_whatever_is_replied_is_read_or_refused_with_sentences(steps: list[Any], before: str, after: str) -> None:
    text = before + json.dumps({"steps": steps}) + after
    assert 0 <= len(faults_in(text)) <= 8
    assert all(fault.strip() and "\n" not in fault for fault in faults_in(text))


@given(text=st.text(max_size=60))
def test_no_text_is_too_odd(text: str) -> None:
    with pytest.raises((Faulty, Cannot)):
        object_with(text, "steps")
