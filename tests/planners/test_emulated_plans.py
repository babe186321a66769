"""The emulated planner for plans: it knows the prompt alone, and it makes the errors that its dials say, as often."""

import ast
import json
from pathlib import Path

import pytest

from planners.asking import Question
from planners.single_shot import SingleShot
from tests.ollama_double.brains import plans
from tests.ollama_double.dials import Dials
from tests.ollama_double.planning.prompt_text import read_known, sections
from tests.ollama_double.planning.speech import read_wishes
from tests.planners.emulated_model import EmulatedModel, seen
from tests.planners.test_tasks import SENTENCES, furnished
from tests.planners.toy import ROOMS, site
from wire.messages.plan import PlanRequest

FOLDER = Path(plans.__file__).parents[1]
WORLD = """\
skills:
open(object)
robots can:
dog-1 dog-2 (quadruped): goto open
drone-1 (drone): take_off
types to look for: Apple Mug
world:
kitchen: countertop1[apple1 box1(open)[mug1(dirty ?cam-1)]] fridge1(~12m)[egg1] thing1("Odd (thing")
hall "The hall" (searched): television1(on)
somewhere: mug2
robots: dog-1(quadruped, kitchen, holds book1) dog-2(quadruped, hall) drone-1(drone, kitchen, battery 20%)
closed unless (open): box1 fridge1
task: "open the fridge"
"""


def test_a_world_is_read_out_of_its_text() -> None:
    known = read_known(sections(WORLD))
    assert (known.rooms, known.searched, known.called["hall"]) == (["kitchen", "hall"], {"hall"}, "the hall")
    assert known.things["mug1"].flags[0] == "dirty"
    assert [holder.name for holder in known.things["mug1"].holders()] == ["box1", "countertop1"]
    assert (known.things["television1"].room, known.things["mug2"].room) == ("hall", "")
    assert known.things["egg1"].holder is known.things["fridge1"]
    assert (known.shut("fridge1"), known.shut("box1")) == (True, False)
    assert (known.robots["dog-1"].holds, known.robots["dog-2"].room) == ("book1", "hall")
    assert known.robots["drone-1"].skills == {"take_off"}


@pytest.mark.parametrize(
    ("words", "verbs", "banned"),
    [
        ("put the mug and the apple in the box, then close it", ["move", "move", "close"], []),
        ("turn the TV off but do not open the fridge", ["toggle_off"], ["open"]),
        ("wash every mug without touching the vase", ["clean"], ["touch"]),
        ("go to the kitchen and find the apple", ["visit", "find"], []),
        ("sing a song", [], []),
    ],
)
def test_instructions_are_understood_by_their_words(words: str, verbs: list[str], banned: list[str]) -> None:
    wishes = read_wishes(words, read_known(sections(WORLD)))
    assert [wish.verb for wish in wishes.wanted] == verbs
    assert [wish.verb for wish in wishes.banned] == banned


def test_nothing_of_it_can_look_behind_the_prompt() -> None:
    for path in (*(FOLDER / "planning").glob("*.py"), FOLDER / "brains" / "plans.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            module = node.module if isinstance(node, ast.ImportFrom) else ""
            assert module is None or not module.startswith(
                ("planners", "hub", "sim", "wire.messages", "tests.planners")
            )


def test_another_thing_is_taken_after_a_failure_and_none_is_tried_for_ever() -> None:
    world = furnished(1, tuple(id for id, _, _ in ROOMS)).world()

    def taken(*failures: str) -> set[str | None]:
        request = PlanRequest(
            task="t", epoch=1, instruction="put the mug in the sink", world=world, failures=failures, now_s=1.0
        )
        plan = SingleShot(site(), EmulatedModel()).make_plan(request).plan
        assert plan is not None
        return {node.object for node in plan.nodes if node.action == "pickup"}

    (first,) = taken()
    (second,) = taken(f"dog-1 could not pickup {first}: there is no way to it")
    assert second != first
    assert taken(*[f"dog-1 could not pickup {id}: no way" for id in (first, second)] * 3) == set()


def question(seed: int) -> Question:
    """A whole prompt of the planner of the first paper."""
    model = EmulatedModel()
    world = furnished(seed, tuple(id for id, _, _ in ROOMS)).world()
    request = PlanRequest(task="t", epoch=1, instruction=SENTENCES[seed % len(SENTENCES)], world=world, now_s=1.0)
    SingleShot(site(), model).make_plan(request)
    return model.said[0][0]


QUESTIONS = [question(seed) for seed in range(60)]


def replies(dials: Dials) -> list[str]:
    brain = plans.make(dials)
    return [brain.reply(seen(question)) for question in QUESTIONS]


@pytest.mark.parametrize("dial", ["invented_id", "missing_dependency", "wrong_skill"])
def test_each_dial_spoils_as_many_replies_as_it_says_and_always_the_same(dial: str) -> None:
    good = replies(Dials())
    assert good == replies(Dials(seed=5))
    always, half = replies(Dials(**{dial: 1.0})), replies(Dials(**{dial: 0.5}))
    assert half == replies(Dials(**{dial: 0.5})) != replies(Dials(seed=1, **{dial: 0.5}))
    able = sum(a != b for a, b in zip(always, good, strict=True))
    assert able > 30, "few replies have nothing that could be spoiled"
    assert 0.3 * able < sum(a != b for a, b in zip(half, good, strict=True)) < 0.7 * able
    for spoiled, whole in zip(always, good, strict=True):
        steps = zip(json.loads(spoiled)["steps"], json.loads(whole)["steps"], strict=True)
        assert sum(a != b for a, b in steps) <= 1, "one place in a reply"


def test_a_part_of_the_task_is_forgotten() -> None:
    told = zip(replies(Dials()), replies(Dials(missing_goal=1.0)), strict=True)
    shorter = sum(len(json.loads(less)["steps"]) < len(json.loads(whole)["steps"]) for whole, less in told)
    assert shorter > 30
