"""The row of a planner with a model: budgets, records, retries, kept answers, and `scripted` wherever the model fails."""

import json
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planners.asking import Answer, Model, ModelFailed, Question
from planners.kept_replies import KeptReplies
from planners.meter import MOST_CALLS, Meter
from planners.modelled import modelled
from planners.planner import Planner
from planners.retries import RETRIES, RetryingModel
from tests.ollama_double.at_hand import stand_in
from tests.planners.scripted_model import VisitPlanner, WrittenModel
from tests.planners.test_tasks import furnished, hub_agrees
from tests.planners.toy import site
from wire.messages.plan import PlanReply, PlanRequest
from wire.planner_table import Budget, PlannerChoice
from wire.site import STATE_VARIABLE

QUESTION = Question("goals", "S", "U")
OUTCOMES = ["unreachable", "busy", "timeout", "broken", "truncated", "looping", "empty", "refused", "invalid"]


def row(model: Model, **table: Any) -> Planner:
    choice = PlannerChoice.model_validate({"name": "visits", **table})
    here = site().model_copy(update={"planner": choice})
    return modelled(VisitPlanner, lambda _: model, sleep=lambda _: None)(here)


def ask(planner: Planner, task: str = "t", **more: Any) -> PlanReply:
    world = furnished(1, ("kitchen",)).world()
    request = PlanRequest(task=task, epoch=1, instruction="turn off every TV", world=world, now_s=0.0, **more)
    reply = planner.make_plan(request)
    assert (reply.task, reply.epoch) == (task, 1)
    assert reply.plan is not None
    hub_agrees(reply.plan, world)
    return reply


def test_what_the_model_cost_stands_in_the_reply_and_in_the_plan() -> None:
    reply = ask(row(WrittenModel(["kitchen"])))
    assert reply.plan is not None
    assert (reply.plan.planner, reply.note) == ("visits", "")
    assert (reply.plan.prompt_tokens, reply.plan.completion_tokens) == (100, 20)
    assert [call.outcome for call in reply.calls] == ["ok"]


def test_answers_that_the_planner_rejects_are_recorded_as_that() -> None:
    reply = ask(row(WrittenModel(["the moon", "the moon", "kitchen"])))
    assert [call.outcome for call in reply.calls] == ["invalid", "invalid", "ok"]
    assert reply.plan is not None
    assert reply.plan.prompt_tokens == 300
    reply = ask(row(WrittenModel(["the moon"])))
    assert [call.outcome for call in reply.calls] == ["invalid"] * 3
    assert reply.plan is not None
    assert reply.plan.planner == "scripted"
    assert reply.note == "scripted instead of visits: written: it names no room"


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_whatever_the_model_does_there_is_a_plan_and_it_says_whose(outcome: str) -> None:
    reply = ask(row(WrittenModel([f"!{outcome}"])))
    assert reply.plan is not None
    assert reply.plan.planner == "scripted"
    assert reply.note == f"scripted instead of visits: written: {outcome}"
    assert [call.outcome for call in reply.calls] == [outcome] * (1 + len(RETRIES.get(outcome, ())))
    assert reply.plan.prompt_tokens == 100 * len(reply.calls), "what was spent in vain was spent"


def test_a_model_that_has_failed_at_a_task_is_not_asked_for_it_again() -> None:
    model = WrittenModel(["!timeout"])
    planner = row(model)
    ask(planner)
    reply = ask(planner)
    assert (len(model.asked), reply.calls) == (1, ())
    assert reply.note == "scripted instead of visits: written: timeout"
    ask(planner, task="another")
    assert len(model.asked) == 2


def test_a_model_whose_plans_cannot_be_carried_out_has_its_chance() -> None:
    model = WrittenModel(["kitchen"])
    planner = row(model)
    assert ask(planner, rejected=1).note == ""
    reply = ask(planner, rejected=2)
    assert reply.note == "scripted instead of visits: 2 plans in a row could not be carried out"
    assert reply.plan is not None
    assert reply.plan.planner == "scripted"
    assert len(model.asked) == 1


def test_without_a_fallback_the_task_is_refused_and_its_tokens_are_counted() -> None:
    planner = row(WrittenModel(["!looping"]), fallback=False)
    world = furnished(1, ("kitchen",)).world()
    request = PlanRequest(task="t", epoch=1, instruction="turn off every TV", world=world, now_s=0.0, rejected=9)
    reply = planner.make_plan(request)
    assert reply.refusal is not None
    assert reply.refusal.reason == "written: looping"
    assert [call.completion_tokens for call in reply.calls] == [20, 20]


@pytest.mark.parametrize(
    ("budget", "calls", "words"),
    [
        ({"calls": 2}, 2, "budget of 2 calls of the model is spent"),
        ({"tokens": 150}, 2, "budget of 150 tokens is spent"),
        ({"seconds": 2.5}, 3, "budget of 2.5 s of the model's time is spent"),
        ({"calls": 0}, 0, "budget of 0 calls"),
    ],
)
def test_a_spent_budget_ends_in_a_plan_without_the_model(budget: dict[str, Any], calls: int, words: str) -> None:
    model = WrittenModel(["the moon"])
    reply = ask(row(model, budget=budget))
    if calls < 3:
        assert words in reply.note
    assert len(model.asked) == len(reply.calls) == calls
    assert reply.plan is not None
    assert reply.plan.planner == "scripted"


def test_the_budget_is_of_the_task_and_not_of_one_plan() -> None:
    model = WrittenModel(["kitchen"])
    planner = row(model, budget={"calls": 2})
    assert [ask(planner).note for _ in range(2)] == ["", ""]
    assert "budget of 2 calls" in ask(planner).note
    assert ask(planner, task="another").note == ""


@given(
    st.lists(st.sampled_from(["ok", *(f"!{outcome}" for outcome in OUTCOMES)]), min_size=1, max_size=40),
    st.integers(0, 12),
    st.integers(0, 3000),
)
def test_no_budget_is_overspent_by_more_than_one_call(script: list[str], calls: int, tokens: int) -> None:
    model = WrittenModel(script)
    meter = Meter(model, Budget(calls=calls, tokens=tokens))
    meter.open("t")
    patient = RetryingModel(meter, lambda _: None)
    for _ in range(20):
        with suppress(ModelFailed):
            patient.ask(QUESTION)
    assert len(model.asked) <= calls
    assert 120 * (len(model.asked) - 1) < max(tokens, 1)
    assert len(meter.calls()) == len(model.asked)


def test_one_reply_holds_so_many_calls_and_no_more() -> None:
    meter = Meter(WrittenModel(["x"], tokens=(0, 0), latency_s=0.0), Budget(calls=1000))
    meter.open("t")
    for _ in range(MOST_CALLS):
        meter.ask(QUESTION)
    with pytest.raises(ModelFailed, match="64 calls of the model for one plan are too many"):
        meter.ask(QUESTION)


def test_which_failures_are_tried_again_and_after_how_long() -> None:
    slept: list[float] = []
    model = WrittenModel(["!busy", "!busy", "!broken", "!busy", "!busy"])
    with pytest.raises(ModelFailed):
        RetryingModel(model, slept.append).ask(QUESTION)
    assert slept == [0.5, 1.0, 0.5, 2.0]
    slept.clear()
    with pytest.raises(ModelFailed):
        RetryingModel(WrittenModel(["!refused"]), slept.append).ask(QUESTION)
    assert slept == [2.0]
    for outcome in ("unreachable", "timeout", "truncated", "invalid", "unasked"):
        assert outcome not in RETRIES


def test_a_model_that_repeats_itself_is_asked_differently() -> None:
    model = WrittenModel(["!looping", "ok"])
    RetryingModel(model, lambda _: None).ask(QUESTION)
    assert [(q.seed, q.temperature, q.think) for q in model.asked] == [(0, 0.0, False), (1, 0.3, False)]
    model = WrittenModel(["!empty", "ok"])
    RetryingModel(model, lambda _: None).ask(QUESTION)
    assert [(q.seed, q.temperature, q.think) for q in model.asked] == [(0, 0.0, False), (1, 0.3, True)]


def test_the_seed_of_the_site_file_is_in_every_question() -> None:
    model = WrittenModel(["kitchen"])
    ask(row(model, seed=40))
    assert [question.seed for question in model.asked] == [40]


def test_kept_answers_are_given_again_without_a_server(tmp_path: Path) -> None:
    model = WrittenModel(["first", "second"])
    keeper = KeptReplies(tmp_path / "replies", "m", 4096, model)
    first = keeper.ask(QUESTION)
    again = keeper.ask(Question("repair", "S", "U"))
    assert (first.text, again.text, len(model.asked)) == ("first", "first", 1)
    assert (first.call.cached, again.call.cached) == (False, True)
    assert (again.call.purpose, again.call.latency_s) == ("repair", 0.0)
    assert again.call.prompt_tokens == first.call.prompt_tokens
    only = KeptReplies(tmp_path / "replies", "m", 4096, None)
    assert only.ask(QUESTION).text == "first"
    with pytest.raises(ModelFailed, match="no answer to this question is kept") as caught:
        only.ask(Question("goals", "S", "something else"))
    assert caught.value.call.outcome == "unasked"


@pytest.mark.parametrize(
    "other",
    [
        Question("goals", "S", "V"),
        Question("goals", "T", "U"),
        Question("goals", "S", "U", {"type": "object"}),
        Question("goals", "S", "U", pictures=(b"1",)),
        Question("goals", "S", "U", seed=1),
        Question("goals", "S", "U", temperature=0.3),
        Question("goals", "S", "U", max_tokens=3),
        Question("goals", "S", "U", think=True),
    ],
)
def test_everything_that_decides_an_answer_is_another_question(tmp_path: Path, other: Question) -> None:
    keeper = KeptReplies(tmp_path, "m", 4096, WrittenModel(["first", "second"]))
    assert [keeper.ask(QUESTION).text, keeper.ask(other).text] == ["first", "second"]
    assert [keeper.ask(QUESTION).text, keeper.ask(other).text] == ["first", "second"]


@pytest.mark.parametrize("spoilt", ["", "[]", '{"text": "x"}', '{"text": "x", "call": {"model": 3}}'])
def test_a_spoilt_file_is_passed_over(tmp_path: Path, spoilt: str, caplog: pytest.LogCaptureFixture) -> None:
    keeper = KeptReplies(tmp_path, "m", 4096, WrittenModel(["first", "second"]))
    keeper.ask(QUESTION)
    (file,) = tmp_path.iterdir()
    file.write_text(spoilt)
    assert keeper.ask(QUESTION).text == "second"
    assert "is not a kept answer" in caplog.text
    assert json.loads(file.read_text())["text"] == "second"


@pytest.mark.parametrize(
    ("scenario", "outcomes", "planner"),
    [
        ("busy,busy,ok", ["busy", "busy", "ok"], "visits"),
        ("drop_before,drop_mid,html,ok", ["broken", "broken", "broken", "ok"], "visits"),
        ("oom,ok", ["refused", "ok"], "visits"),
        ("repeat,ok", ["looping", "ok"], "visits"),
        ("think_empty,ok", ["empty", "ok"], "visits"),
        ("error_mid", ["refused", "refused"], "scripted"),
        ("missing", ["unreachable"], "scripted"),
        ("busy", ["busy"] * 4, "scripted"),
        ("off_schema", ["invalid"] * 3, "scripted"),
        ("truncated,bad_request", ["truncated"], "scripted"),
    ],
)
def test_over_real_http_the_fleet_always_gets_its_plan(
    scenario: str, outcomes: list[str], planner: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(STATE_VARIABLE, str(tmp_path))
    with stand_in(scenario, text="kitchen", table={"name": "visits"}) as (_, choice):
        here = site().model_copy(update={"planner": choice})
        reply = ask(modelled(LongVisits, sleep=lambda _: None)(here))
    assert [call.outcome for call in reply.calls] == outcomes
    assert all(call.stand_in for call in reply.calls)
    assert reply.plan is not None
    assert reply.plan.planner == planner
    assert (planner == "scripted") == ("scripted instead of visits: qwen3:8b" in reply.note or scenario == "off_schema")


class LongVisits(VisitPlanner):
    """With a prompt that is long enough to be cut."""

    def __init__(self, site: Any, model: Model) -> None:
        super().__init__(site, _Longer(model))


class _Longer:
    def __init__(self, model: Model) -> None:
        self._ask: Callable[[Question], Answer] = model.ask

    def ask(self, question: Question) -> Answer:
        return self._ask(Question(question.purpose, "Answer with a room. " * 40, question.user))


def test_kept_answers_replay_a_run_without_its_server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(STATE_VARIABLE, str(tmp_path))
    with stand_in(text="kitchen", table={"name": "visits", "replies": "keep"}) as (state, choice):
        here = site().model_copy(update={"planner": choice})
        first = ask(modelled(VisitPlanner)(here))
        second = ask(modelled(VisitPlanner)(here))
        assert len([body for body in state.chats if body["messages"]]) == 1
    offline = here.model_copy(update={"planner": choice.model_copy(update={"replies": "only"})})
    third = ask(modelled(VisitPlanner)(offline))
    assert [reply.calls[0].cached for reply in (first, second, third)] == [False, True, True]
    assert second == third
    assert first.plan == third.plan
