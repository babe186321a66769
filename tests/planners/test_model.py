"""The client of a model server, over real HTTP: what each thing that a server may do comes to."""

import logging
import socket
import threading
import time
from typing import Any

import pytest

from planners.asking import Answer, ModelFailed, Question
from planners.model import OllamaModel
from tests.ollama_double.at_hand import stand_in
from tests.ollama_double.server import State
from wire.planner_table import PlannerChoice

SCHEMA = {"type": "object", "properties": {"a": {"type": "integer"}}, "required": ["a"]}
QUESTION = Question("goals", "You turn words into goals.", "Put the apple into the fridge, please.", SCHEMA)
LONG = Question("goals", "You turn words into goals.", "Put the apple into the fridge. " * 30, SCHEMA)


def failure(choice: PlannerChoice, question: Question = QUESTION) -> ModelFailed:
    with pytest.raises(ModelFailed) as caught:
        OllamaModel(choice).ask(question)
    return caught.value


def test_an_answer_and_its_record() -> None:
    with stand_in() as (state, choice):
        answer = OllamaModel(choice).ask(QUESTION)
    assert answer.text == '{"a": 1}'
    call = answer.call
    assert (call.purpose, call.model, call.outcome, call.seed) == ("goals", "qwen3:8b", "ok", 0)
    assert call.stand_in
    assert call.counted_by == state.counter.name != "server"
    assert call.prompt_tokens > 15
    assert call.completion_tokens == state.counter.count('{"a": 1}')
    assert len(call.schema_hash) == 12


def test_what_stands_in_a_request() -> None:
    with stand_in(table={"num_ctx": 2048}) as (state, choice):
        OllamaModel(choice).ask(Question("goals", "S", "U", SCHEMA, max_tokens=77, temperature=0.2, seed=9))
        (body,) = state.chats
    assert list(body) == ["model", "stream", "options", "format", "keep_alive", "messages", "tools", "think"]
    assert body["options"] == {"num_ctx": 2048, "num_predict": 77, "temperature": 0.2, "seed": 9}
    assert body["format"] == SCHEMA
    assert body["think"] is False
    assert body["messages"] == [{"role": "system", "content": "S"}, {"role": "user", "content": "U"}]


def test_a_model_that_cannot_think_is_not_told_about_it() -> None:
    with stand_in(table={"model": "llama3.1:8b"}) as (state, choice):
        assert OllamaModel(choice).ask(QUESTION).text
        assert "think" not in state.chats[0]


def test_pictures_reach_a_model_that_sees_and_no_other() -> None:
    question = Question("look", "S", "What is there?", pictures=(b"\x89PNG 1", b"\x89PNG 2"))
    with stand_in(table={"model": "qwen2.5vl:7b"}) as (state, choice):
        assert OllamaModel(choice).ask(question).call.prompt_tokens > 2000
        assert state.brain.heard[0].pictures == question.pictures
    with stand_in() as (state, choice):
        failed = failure(choice, question)
        assert not state.chats
    assert failed.call.outcome == "refused"
    assert "cannot look at pictures: choose a model with the capability `vision`" in str(failed)


WHAT_COMES_OF: dict[str, tuple[str, str, bool]] = {
    "missing": ("unreachable", "`ollama pull qwen3:8b` fetches it", False),
    "busy": ("busy", "too many requests waiting", True),
    "html": ("broken", "a page of HTML came with status 502", True),
    "oom": ("refused", "model runner has unexpectedly stopped", True),
    "bad_request": ("refused", "invalid options: num_ctx", False),
    "too_long": ("truncated", "does not fit into its context", False),
    "bad_json": ("broken", "not the protocol of a model server", True),
    "no_message": ("broken", "not the protocol of a model server", True),
    "drop_before": ("broken", "ended in the middle", True),
    "drop_mid": ("broken", "ended in the middle", True),
    "error_mid": ("refused", "an error was encountered while running the model", True),
    "repeat": ("looping", "it repeated itself", True),
    "length": ("truncated", "the answer was cut after 512 tokens", False),
    "think_empty": ("empty", "said nothing after it had thought", True),
    "empty": ("empty", "the model said nothing", True),
    "truncated": ("truncated", "its context is shorter than planner.num_ctx says", False),
}


@pytest.mark.parametrize("scenario", WHAT_COMES_OF)
def test_every_failure_has_its_outcome_and_a_sentence(scenario: str) -> None:
    outcome, words, again = WHAT_COMES_OF[scenario]
    with stand_in(scenario) as (_, choice):
        failed = failure(choice, LONG)
    assert (failed.call.outcome, failed.again) == (outcome, again)
    assert words in str(failed)
    assert str(failed).startswith("qwen3:8b: ")
    assert failed.call.stand_in


@pytest.mark.parametrize("scenario", ["hang", "hang_mid", "dribble"])
def test_a_server_that_comes_to_no_end_is_left_in_time(scenario: str) -> None:
    with stand_in(scenario, table={"timeout_s": 0.6}) as (_, choice):
        failed = failure(choice)
    assert failed.call.outcome == "timeout"
    assert "no whole answer within 0.6 s" in str(failed)
    assert not failed.again
    if scenario == "hang_mid":
        assert failed.call.completion_tokens > 0, "what came before it hung was spent"
        assert failed.call.counted_by == "pieces of the stream"


@pytest.mark.parametrize("scenario", ["think_empty", "empty", "repeat", "length", "truncated", "drop_mid"])
def test_what_was_spent_in_vain_is_counted(scenario: str) -> None:
    with stand_in(scenario) as (_, choice):
        failed = failure(choice, LONG)
    counted = failed.call.prompt_tokens + failed.call.completion_tokens
    assert counted > 0 or scenario == "empty"


def test_an_answer_in_the_thoughts_of_a_model_is_taken_from_there() -> None:
    with stand_in("think_only") as (_, choice):
        assert OllamaModel(choice).ask(QUESTION).text == '{"a": 1}'


def test_json_of_another_shape_is_the_planners_to_judge() -> None:
    with stand_in("off_schema") as (_, choice):
        assert "thought" in OllamaModel(choice).ask(QUESTION).text


def test_a_prompt_that_does_not_fit_is_not_sent() -> None:
    with stand_in(table={"num_ctx": 1024}) as (state, choice):
        failed = failure(choice, Question("plan", "", "apple " * 400))
        assert not state.chats
    assert failed.call.outcome == "truncated"
    assert "set a larger planner.num_ctx" in str(failed)


def test_a_model_that_runs_on_is_left() -> None:
    question = Question("goals", "S", "U", max_tokens=5)
    with stand_in("runaway") as (_, choice):
        failed = failure(choice, question)
    assert failed.call.outcome == "looping"
    assert "came to no end after 21 pieces" in str(failed)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def test_where_no_server_is(monkeypatch: pytest.MonkeyPatch) -> None:
    port = free_port()
    failed = failure(PlannerChoice(host=f"http://127.0.0.1:{port}"))
    assert failed.call.outcome == "unreachable"
    assert f"no model server answers at http://127.0.0.1:{port}: `ollama serve` starts one" in str(failed)
    monkeypatch.setenv("OLLAMA_HOST", f"127.0.0.1:{port}")
    assert f"answers at 127.0.0.1:{port}" in str(failure(PlannerChoice()))


def test_the_environment_names_the_server_and_its_proxies_are_passed_by(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("HTTP_PROXY", "http_proxy", "ALL_PROXY"):
        monkeypatch.setenv(name, f"http://127.0.0.1:{free_port()}")
    monkeypatch.delenv("NO_PROXY", raising=False)
    with stand_in() as (_, choice):
        monkeypatch.setenv("OLLAMA_HOST", choice.host)
        assert OllamaModel(PlannerChoice()).ask(QUESTION).text == '{"a": 1}'
        monkeypatch.setenv("OLLAMA_HOST", f"127.0.0.1:{free_port()}")
        assert OllamaModel(choice).ask(QUESTION).text == '{"a": 1}', "the site file goes before"


def test_a_bad_address_in_the_environment_is_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OLLAMA_HOST", "127.0.0.1:notaport")
    assert failure(PlannerChoice()).call.outcome in ("unreachable", "broken")


def loaded(model: OllamaModel, patience_s: float | None = None) -> OllamaModel:
    """The model, once it is loaded; then with more patience, so that a busy machine fails no test."""
    model.start()
    assert model.loading_is_over(30.0)
    if patience_s is not None:
        model._choice = model._choice.model_copy(update={"timeout_s": patience_s})
    return model


def test_it_is_loaded_once_with_one_context(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "model")
    with stand_in(cold_load_s=0.3, table={"num_ctx": 4096}) as (state, choice):
        model = loaded(OllamaModel(choice))
        for _ in range(3):
            model.ask(QUESTION)
        assert (state.loads, state.loaded) == (1, {"qwen3:8b": 4096})
    assert "qwen3:8b is loaded with a context of 4096 tokens" in caplog.text
    assert "(a stand-in without a model)" in caplog.text


def test_a_cold_load_goes_on_when_a_question_gives_up_waiting() -> None:
    with stand_in(cold_load_s=1.5, table={"timeout_s": 0.4}) as (state, choice):
        model = OllamaModel(choice)
        model.start()
        failed = _fails(model)
        assert "still being loaded" in str(failed)
        assert failed.call.outcome == "timeout"
        assert loaded(model, patience_s=20.0).ask(QUESTION).text
        assert state.loads == 1


def test_a_question_that_finds_the_model_unloaded_has_it_loaded_behind_it() -> None:
    with stand_in(cold_load_s=1.0, table={"timeout_s": 0.4}) as (state, choice):
        model = OllamaModel(choice)
        assert _fails(model).call.outcome == "timeout"
        assert loaded(model, patience_s=20.0).ask(QUESTION).text
        assert state.loads == 1


def _fails(model: OllamaModel) -> ModelFailed:
    with pytest.raises(ModelFailed) as caught:
        model.ask(QUESTION)
    return caught.value


def test_a_server_that_gives_less_context_is_found_out(caplog: pytest.LogCaptureFixture) -> None:
    with stand_in(largest_context=600) as (_, choice):
        model = loaded(OllamaModel(choice))
        with pytest.raises(ModelFailed, match="do not fit into a context of 600"):
            model.ask(LONG)
    assert "has a context of 600 tokens, not the 8192 of planner.num_ctx" in caplog.text


def test_one_question_at_a_time() -> None:
    with stand_in(token_s=0.05) as (state, choice):
        models, answers = [OllamaModel(choice) for _ in range(2)], []
        busy: list[int] = []
        original = state.brain.reply

        def watch(request: Any) -> str:
            busy.append(len(answers))
            return original(request)

        state.brain.reply = watch
        asks = [models[0].ask, models[1].ask, models[0].ask]
        threads = [threading.Thread(target=lambda ask=ask: answers.append(ask(QUESTION))) for ask in asks]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(20.0)
    assert [answer.text for answer in answers] == ['{"a": 1}'] * 3
    assert busy == [0, 1, 2]


def test_a_server_that_was_restarted_is_simply_asked() -> None:
    with stand_in() as (first, choice):
        model = OllamaModel(choice)
        assert isinstance(model.ask(QUESTION), Answer)
    assert _fails(model).call.outcome == "unreachable"
    port = int(choice.host.rpartition(":")[2])
    server = _again(first, port)
    try:
        assert model.ask(QUESTION).text == '{"a": 1}'
    finally:
        server.shutdown()
        server.server_close()


def _again(state: State, port: int) -> Any:
    from tests.ollama_double.server import serve

    server = serve(state, port)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    time.sleep(0.05)
    return server
