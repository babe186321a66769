"""Hub, robots and a planner whose model does its worst: the fleet always does the task."""

import re

import pytest

from planners.core import PlannerCore
from planners.modelled import modelled
from tests.hub.home import Flat
from tests.hub.test_episode import fetch
from tests.ollama_double.at_hand import stand_in
from tests.planners.scripted_model import VisitPlanner
from wire.messages.operator import CallsReply, CallsRequest, TaskState
from wire.planner_table import PlannerChoice


def episode(choice: PlannerChoice) -> tuple[Flat, TaskState]:
    home = Flat(fetch, choice=choice)
    home.mesh.run(0.5)
    home.mesh.remove("planner")
    planner = modelled(VisitPlanner, sleep=lambda _: None)(home.site)
    home.mesh.add(PlannerCore(planner), "planner", "planner")
    home.mesh.run(3.0)
    home.ask()
    return home, home.until_end()


WORST = {
    "missing": ["unreachable"],
    "busy": ["busy"] * 4,
    "html": ["broken"] * 4,
    "oom": ["refused"] * 2,
    "bad_json": ["broken"] * 4,
    "drop_mid": ["broken"] * 4,
    "error_mid": ["refused"] * 2,
    "hang": ["timeout"],
    "dribble": ["timeout"],
    "repeat": ["looping"] * 2,
    "empty": ["empty"] * 2,
    "length": ["truncated"],
    "off_schema": ["invalid"] * 3,
}


@pytest.mark.parametrize("scenario", WORST)
def test_a_dead_slow_lying_or_looping_model_stops_nobody(scenario: str) -> None:
    impatient = {"timeout_s": 1.0} if scenario in ("hang", "dribble") else {}
    with stand_in(scenario, table={"name": "visits", **impatient}) as (_, choice):
        home, state = episode(choice)
    assert (state.status, state.planner, state.fails) == ("done", "scripted", 0), state
    assert state.planner_note.startswith("scripted instead of visits: ")
    assert any(state.planner_note in line for line in state.log)
    calls = home.mesh.call("calls", CallsRequest(task="t-1"))
    assert isinstance(calls, CallsReply)
    assert [row.call.outcome for row in calls.calls] == WORST[scenario]
    assert state.stand_in
    assert (state.prompt_tokens, state.completion_tokens) == (calls.prompt_tokens, calls.completion_tokens)


def test_without_any_server_the_task_is_done() -> None:
    with stand_in() as (_, choice):
        pass
    _, state = episode(choice)
    assert (state.status, state.planner, state.stand_in) == ("done", "scripted", False)
    assert re.search(r"no model server answers at http://127\.0\.0\.1:\d+", state.planner_note)


def test_a_model_that_answers_has_its_plan_carried_out() -> None:
    with stand_in(text="kitchen", table={"name": "visits"}) as (_, choice):
        _, state = episode(choice)
    assert (state.status, state.planner, state.planner_note) == ("done", "visits", "")
    assert state.stand_in
    assert state.prompt_tokens > 0
