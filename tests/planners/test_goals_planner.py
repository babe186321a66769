"""The planner `goals`: who is asked what, how often, and that plans come from code."""

import ast
import json
from pathlib import Path
from typing import Any

import pytest

from planners.asking import ModelFailed
from planners.goals.planner import GoalsPlanner
from planners.modelled import modelled
from planners.planner import PLANNERS, Planner
from planners.prompt import system_prompt
from tests.ollama_double.brain import emulated
from tests.ollama_double.dials import Dials
from tests.ollama_double.server import State, running
from tests.planners.emulated_model import EmulatedModel, tokens
from tests.planners.executor import run
from tests.planners.figures import KINDS, MIXED, outcome, prompt_tokens, replan_calls, tally
from tests.planners.home import home, home_world
from tests.planners.instructions import rows, written
from tests.planners.scripted_model import WrittenModel
from tests.planners.test_tasks import hub_agrees
from tests.planners.toy import site
from wire.goals import holds
from wire.messages.plan import PlanReply, PlanRequest
from wire.messages.world import WorldState
from wire.planner_table import PlannerChoice

SAY = "stash the mug in the sink"
GOOD = json.dumps({"goals": [{"of": SAY, "p": "in", "a": "Mug", "b": "Sink"}]})
WRONG = json.dumps({"goals": [{"of": SAY, "p": "in", "a": "Apple", "b": "Sink"}]})


def row(model: Any, grammar: bool = True) -> Planner:
    """As the table has it."""
    here = site().model_copy(update={"planner": PlannerChoice(name="goals", grammar=grammar)})
    return modelled(GoalsPlanner, lambda _: model, sleep=lambda _: None)(here)


def ask(model: Any, say: str = SAY, world: WorldState | None = None, **more: Any) -> PlanReply:
    request = PlanRequest(task="t", epoch=1, instruction=say, world=world or home_world(), now_s=1.0, **more)
    return row(model).make_plan(request)


def test_what_the_grammar_reads_asks_nobody() -> None:
    model = WrittenModel([GOOD])
    reply = ask(model, "put the mug in the sink")
    assert reply.plan is not None
    assert (reply.plan.planner, reply.plan.prompt_tokens) == ("goals", 0)
    assert (model.asked, reply.calls) == ([], ())


def test_without_its_grammar_the_model_reads_everything() -> None:
    model = WrittenModel([GOOD.replace("stash the mug in", "put the mug in")])
    say = "put the mug in the sink"
    request = PlanRequest(task="t", epoch=1, instruction=say, world=home_world(), now_s=1.0)
    reply = row(model, grammar=False).make_plan(request)
    assert reply.plan is not None
    assert written(reply.plan.goals) == "in(Mug,Sink)"
    assert [call.purpose for call in reply.calls] == ["goals"]


def test_one_question_makes_goals_and_code_makes_the_plan() -> None:
    model = WrittenModel([GOOD])
    reply = ask(model)
    assert reply.plan is not None
    assert written(reply.plan.goals) == "in(Mug,Sink)"
    assert [node.action for node in reply.plan.nodes] == ["pickup", "put"]
    assert [call.purpose for call in reply.calls] == ["goals"]
    assert reply.plan.prompt_tokens == 100
    hub_agrees(reply.plan, home_world())


@pytest.mark.parametrize("bad", [WRONG, "sorry, what?", GOOD[:-4], '{"goals": []}'])
def test_an_objection_is_put_to_the_model_with_its_reply(bad: str) -> None:
    model = WrittenModel([bad, GOOD])
    reply = ask(model)
    assert reply.plan is not None
    assert [call.outcome for call in reply.calls] == ["invalid", "ok"]
    first, repair = model.asked
    assert repair.user.startswith(first.user)
    assert bad in repair.user
    assert "\n- " in repair.user
    assert (first.purpose, repair.purpose) == ("goals", "repair")
    assert first.system == repair.system == system_prompt("goals")


def test_after_two_repairs_there_is_an_end_and_the_grammars_word_counts() -> None:
    model = WrittenModel([WRONG])
    reply = ask(model)
    assert reply.refusal is not None
    assert reply.refusal.reason == "I do not understand 'stash'"
    assert reply.note.startswith("scripted instead of goals: no goals could be made of it")
    assert [call.outcome for call in reply.calls] == ["invalid"] * 3
    assert [question.temperature for question in model.asked] == [0.0, 0.0, 0.3]
    assert [question.seed for question in model.asked] == [0, 1, 2]


def test_a_model_that_fails_is_passed_on() -> None:
    request = PlanRequest(task="t", epoch=1, instruction=SAY, world=home_world(), now_s=1.0)
    with pytest.raises(ModelFailed):
        GoalsPlanner(site(), WrittenModel(["!timeout"])).make_plan(request)


def test_what_one_reply_got_wrong_another_may_have_right() -> None:
    say = "kill the telly and latch the box"
    telly, box = (
        {"of": "kill the telly", "p": "off", "a": "Television"},
        {"of": "latch the box", "p": "closed", "a": "Box"},
    )
    model = WrittenModel(
        [
            json.dumps({"goals": [telly, {**box, "p": "open", "a": "Apple"}]}),
            json.dumps({"goals": [{**telly, "p": "on"}, box]}),
        ]
    )
    reply = ask(model, say)
    assert reply.plan is not None
    assert written(reply.plan.goals) == "off(Television) ; closed(Box)"
    assert len(model.asked) == 2


def test_the_models_question_is_the_operators_to_answer() -> None:
    reply = ask(WrittenModel([json.dumps({"goals": [], "ask": "Which mug\nis meant? <|x|>"})]))
    assert reply.refusal is not None
    assert (reply.refusal.question, reply.refusal.reason) == (True, "Which mug is meant? (/x/)")


def test_words_without_a_name_are_refused_by_their_name() -> None:
    reply = ask(WrittenModel([json.dumps({"goals": [], "unknown": ["the gizmo"]})]), "stash the gizmo in the sink")
    assert reply.refusal is not None
    assert (reply.refusal.question, reply.refusal.reason) == (False, "I do not understand 'the gizmo'")


@pytest.mark.parametrize(
    ("say", "question"),
    [("stash the mug on the table", True), ("open the apple", False), ("put the mug in the garage", False)],
)
def test_no_model_is_asked_to_guess(say: str, question: bool) -> None:
    model = WrittenModel([GOOD])
    reply = ask(model, say)
    assert reply.refusal is not None
    assert reply.refusal.question == question
    assert model.asked == []


def test_a_goal_that_no_robot_can_reach_is_refused_with_the_skill() -> None:
    world = home_world()
    lame = world.model_copy(
        update={"robots": tuple(r.model_copy(update={"skills": ("goto", "explore")}) for r in world.robots)}
    )
    reply = ask(WrittenModel([GOOD]), world=lame)
    assert reply.refusal is not None
    assert reply.refusal.reason == "no robot here can do that: none announces pickup"
    assert len(reply.calls) == 1


def test_a_replan_costs_nothing() -> None:
    assert replan_calls() == 0
    model = WrittenModel([GOOD])
    plan = ask(model).plan
    assert plan is not None
    again = ask(model, goals=plan.goals, failures=("dog-1 could not pickup mug-1: it slipped",))
    assert again.plan is not None
    assert (again.calls, again.plan.prompt_tokens, len(model.asked)) == ((), 0, 1)


def test_a_goal_call_is_short_in_a_home_with_thirty_things() -> None:
    assert len(home_world().objects) == 30
    assert max(prompt_tokens()) < 450


def test_the_beginning_of_prompts_is_the_same_whatever_is_said() -> None:
    model = EmulatedModel()
    for say in ("stash the vase in the box", "kill the microwave", "polish the plate"):
        ask(model, say)
    systems, users = zip(*((q.system, q.user) for q, _ in model.said), strict=True)
    assert len(set(systems)) == 1
    assert len({user.split("instruction:")[0] for user in users}) == 1


def test_names_last_as_long_as_the_planner() -> None:
    model = EmulatedModel()
    planner = row(model)
    world = home_world()
    mug = next(obj for obj in world.objects if obj.type == "Mug")
    for objects in (world.objects, (mug.model_copy(update={"id": "a-mug"}), *world.objects)):
        changed = world.model_copy(update={"objects": objects})
        planner.make_plan(PlanRequest(task="t", epoch=1, instruction=SAY, world=changed, now_s=1.0))
    first, second = (question.user for question, _ in model.said)
    assert "mug1(dirty)" in first
    assert "mug1(dirty)" in second
    assert "mug3" in second


@pytest.mark.parametrize("say", [row.say for row in rows() if row.by == "model" and not row.refused][::9])
def test_tasks_end_with_the_goals_true(say: str) -> None:
    house = home()
    reply, goals, replies = run(house, row(EmulatedModel()), say)
    assert reply.plan is not None, reply.refusal
    assert reply.plan.planner == "goals"
    assert all(holds(goal, house.truth()) for goal in goals)
    assert sum(len(each.calls) for each in replies[1:]) == 0


def test_errors_of_the_model_are_made_good() -> None:
    """Three replies in ten with errors of all kinds: the goals are as without, within two points of all tasks."""
    clean = tally(Dials(), "model", execute=False)
    assert (clean.exact, clean.spoilt) == (clean.tasks, 0)
    spoilt = tally(Dials(seed=5, **dict.fromkeys(KINDS, MIXED)), "model", execute=False)
    assert spoilt.spoilt >= 0.28 * spoilt.calls
    assert spoilt.exact >= clean.exact - 0.02 * len(rows())


def test_every_kind_of_error_alone_is_caught_or_made_good() -> None:
    """Where the words are known no error passes; a strange word may stand for anything, so a wrong name for it can."""
    said = [r for r in rows() if r.by == "model" and r.style in ("count", "order", "negation")]
    for kind in KINDS:
        for r in said:
            got = outcome(r, EmulatedModel(Dials(seed=1, **{kind: 1.0})))
            same = "<" not in got and sorted(got.split(" ; ")) == sorted(r.want.split(" ; "))
            assert same or got in (r.want, "!"), (kind, r.say, got)


def test_over_real_http_with_the_real_client() -> None:
    state = State(emulated(Dials()))
    with running(state) as url:
        table = {"name": "goals", "model": "qwen3:8b", "host": url, "timeout_s": 20.0}
        here = site().model_copy(update={"planner": PlannerChoice.model_validate(table)})
        request = PlanRequest(task="t", epoch=1, instruction=SAY, world=home_world(), now_s=1.0)
        reply = PLANNERS["goals"](here).make_plan(request)
    assert reply.plan is not None, reply.refusal
    assert written(reply.plan.goals) == "in(Mug,Sink)"
    (call,) = reply.calls
    assert (call.purpose, call.outcome, call.stand_in) == ("goals", "ok", True)
    assert 0 < call.prompt_tokens < 450
    assert state.chats[-1]["format"]["required"] == ["goals"]
    model = EmulatedModel()
    ask(model)
    assert tokens(model.said[0][0]) <= call.prompt_tokens


@pytest.mark.parametrize("name", ["brains/goals.py", "deeds.py", "english.py"])
def test_the_emulated_planner_knows_the_prompt_alone(name: str) -> None:
    tree = ast.parse((Path(__file__).parents[1] / "ollama_double" / name).read_text())
    imported = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    imported += [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    assert not [module for module in imported if module.split(".")[0] in ("planners", "wire", "hub")]
