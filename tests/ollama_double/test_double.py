"""The stand-in, seen by the client that others use: routes, streams, statuses, loading, and the errors of its brains."""

import json
import subprocess
import sys
import urllib.request
from pathlib import Path
from typing import Any

import httpx
import ollama
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.ollama_double.at_hand import Says, stand_in
from tests.ollama_double.brain import NOTHING_TO_SAY, Candidate, ChatRequest, Emulation, candidates, emulated
from tests.ollama_double.brains.contract import MARK
from tests.ollama_double.counting import by_rule, counter
from tests.ollama_double.dials import Dials, dials_from
from tests.ollama_double.replay import read_replies
from tests.ollama_double.scenarios import SCENARIOS, Sequence

ROOT = Path(__file__).resolve().parents[2]
ASK = [{"role": "user", "content": "x"}]


def client(host: str) -> ollama.Client:
    return ollama.Client(host, timeout=httpx.Timeout(5.0), trust_env=False)


def test_every_route_is_understood_by_the_client() -> None:
    with stand_in() as (_, choice), client(choice.host) as server:
        (model, *_) = server.list().models
        assert (model.model, model.details.family) == ("qwen3:8b", "stand-in")
        shown = server.show("qwen3:8b")
        assert shown.capabilities == ["completion", "tools", "thinking"]
        assert shown.modelinfo["tokenizer.ggml.model"] == counter().name
        assert server.ps().models == []
        server.chat("qwen3:8b", [], options={"num_ctx": 5000})
        (loaded,) = server.ps().models
        assert (loaded.name, loaded.context_length) == ("qwen3:8b", 5000)
        assert server.generate("qwen3:8b", "x").response == '{"a": 1}'
        assert [part.status for part in server.pull("qwen3:8b", stream=True)][-1] == "success"
        with pytest.raises(ollama.ResponseError, match="file does not exist") as caught:
            list(server.pull("nosuch:1b", stream=True))
        assert caught.value.status_code == -1
        with pytest.raises(ollama.ResponseError, match="'nosuch' not found"):
            server.show("nosuch")


def test_plain_routes() -> None:
    with stand_in() as (state, choice):
        with urllib.request.urlopen(choice.host + "/") as answer:
            assert answer.read() == b"Ollama is running"
        with urllib.request.urlopen(choice.host + "/api/version") as answer:
            version = json.loads(answer.read())
    assert version == {"version": "0.33.2", "family": "stand-in", "counted_by": state.counter.name}


@pytest.mark.parametrize("stream", [False, True])
def test_an_answer_whole_and_in_pieces(stream: bool) -> None:
    with stand_in() as (_, choice), client(choice.host) as server:
        answer: Any = server.chat("qwen3:8b", ASK, stream=stream, think=False)
        parts = list(answer) if stream else [answer]
    assert "".join(part.message.content for part in parts) == '{"a": 1}'
    assert [part.done for part in parts] == [False] * (len(parts) - 1) + [True]
    assert (parts[-1].done_reason, parts[-1].eval_count) == ("stop", counter().count('{"a": 1}'))


def test_a_model_that_can_think_does_so_unless_it_is_told_not_to() -> None:
    with stand_in() as (_, choice), client(choice.host) as server:
        assert server.chat("qwen3:8b", ASK).message.thinking
        assert not server.chat("qwen3:8b", ASK, think=False).message.thinking
        with pytest.raises(ollama.ResponseError, match=r'"llama3\.1:8b" does not support thinking'):
            server.chat("llama3.1:8b", ASK, think=True)


RAISED: dict[str, tuple[type[Exception], int | None]] = {
    "missing": (ollama.ResponseError, 404),
    "busy": (ollama.ResponseError, 503),
    "html": (ollama.ResponseError, 502),
    "oom": (ollama.ResponseError, 500),
    "bad_request": (ollama.ResponseError, 400),
    "too_long": (ollama.ResponseError, 400),
    "bad_json": (json.JSONDecodeError, None),
    "no_message": (ValueError, None),
    "drop_before": (httpx.RemoteProtocolError, None),
    "drop_mid": (httpx.RemoteProtocolError, None),
    "error_mid": (ollama.ResponseError, 500),
}


@pytest.mark.parametrize("scenario", RAISED)
def test_what_the_client_makes_of_a_scenario(scenario: str) -> None:
    kind, status = RAISED[scenario]
    with stand_in(scenario) as (_, choice), client(choice.host) as server:
        with pytest.raises(kind) as caught:
            server.chat("qwen3:8b", ASK)
        assert getattr(caught.value, "status_code", None) == status


def test_a_model_that_repeats_itself_ends_without_done() -> None:
    with stand_in("repeat") as (_, choice), client(choice.host) as server:
        answer = server.chat("qwen3:8b", ASK)
        assert (answer.done, answer.done_reason, answer.eval_count) == (False, None, None)
        assert not any(part.done for part in server.chat("qwen3:8b", ASK, stream=True))


def test_a_sequence_is_gone_through_once_and_its_last_entry_stays() -> None:
    with stand_in("busy,html,ok") as (_, choice), client(choice.host) as server:
        for status in (503, 502):
            with pytest.raises(ollama.ResponseError) as caught:
                server.chat("qwen3:8b", ASK)
            assert caught.value.status_code == status
        assert [server.chat("qwen3:8b", ASK).done for _ in range(3)] == [True] * 3


def test_another_context_loads_the_model_anew_and_whoever_leaves_ends_the_loading() -> None:
    with stand_in(cold_load_s=0.5) as (state, choice):
        with client(choice.host) as server:
            for num_ctx in (4096, 4096, 8192):
                server.chat("qwen3:8b", ASK, options={"num_ctx": num_ctx})
        assert state.loads == 2
        state.cold_load_s = 30.0
        impatient = ollama.Client(choice.host, timeout=httpx.Timeout(0.3), trust_env=False)
        with pytest.raises(httpx.ReadTimeout), impatient:
            impatient.chat("qwen3:8b", ASK, options={"num_ctx": 2048})
        assert (state.loads, state.loaded) == (2, {})


def test_a_prompt_that_is_too_long_is_cut_to_half_the_window_and_only_the_count_tells() -> None:
    with stand_in() as (state, choice), client(choice.host) as server:
        words = "nothing in here " * 400 + "the end"
        answer = server.chat("qwen3:8b", [{"role": "user", "content": words}], options={"num_ctx": 512})
        assert answer.prompt_eval_count == 258
        assert state.brain.heard[-1].user.endswith("the end")
        assert len(state.brain.heard[-1].user) < len(words)


def test_every_brain_is_found_and_only_the_prompt_decides_which_is_asked() -> None:
    assert "contract" in [candidate.name for candidate in candidates(Dials())]
    brain = emulated(Dials())
    assert brain.reply(ChatRequest("m", MARK, "Name a digit")) == '{"number": 7}'
    assert brain.reply(ChatRequest("m", "", "gibberish")) == NOTHING_TO_SAY


def _spoilt(dials: Dials, prompts: int = 200) -> list[str]:
    candidate = Candidate("all", lambda _: True, Says('{"goals": [1, 2, 3]}'))
    emulation = Emulation(dials, [candidate])
    return [emulation.reply(ChatRequest("m", "", f"prompt {n}")) for n in range(prompts)]


def test_dials_make_errors_as_often_as_they_say_and_the_same_ones_every_time() -> None:
    assert set(_spoilt(Dials())) == {'{"goals": [1, 2, 3]}'}
    some = _spoilt(Dials(seed=3, broken_json=0.3))
    assert some == _spoilt(Dials(seed=3, broken_json=0.3)) != _spoilt(Dials(seed=4, broken_json=0.3))
    assert 40 <= sum(text != '{"goals": [1, 2, 3]}' for text in some) <= 80
    assert all("```" in text for text in _spoilt(Dials(prose=1.0)))
    assert not any(_parses(text) for text in _spoilt(Dials(broken_json=1.0)))


def _parses(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


@given(st.floats(0.0, 1.0), st.integers(0, 99))
def test_whether_an_error_is_made_depends_on_the_prompt_and_the_place(rate: float, seed: int) -> None:
    dials = Dials(seed=seed, invented_id=rate)
    made = [dials.slips("invented_id", f"p{n % 7}", what=f"goal {n}") for n in range(20)]
    assert made == [dials.slips("invented_id", f"p{n % 7}", what=f"goal {n}") for n in range(20)]
    assert not any(dials.slips("wrong_skill", f"p{n}") for n in range(20))
    assert all(made) or rate < 1.0
    assert not any(made) or rate > 0.0


def test_what_is_typed_wrong_is_said_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="there is no dial 'sloth'; there are invented_id"):
        dials_from(["sloth=1"], 0)
    with pytest.raises(ValueError, match=r"prose=2: a rate lies between 0 and 1"):
        dials_from(["prose=2"], 0)
    with pytest.raises(ValueError, match=r"as in prose=0\.1"):
        dials_from(["prose=much"], 0)
    with pytest.raises(ValueError, match="no scenario doom; there are ok"):
        Sequence("ok,doom")
    with pytest.raises(ValueError, match="no scenario is named"):
        Sequence(" , ")
    file = tmp_path / "replies.toml"
    for text in ("", "reply = 3", '[[reply]]\nprompt = "x"', "no toml"):
        file.write_text(text)
        with pytest.raises(ValueError, match=r"\[\[reply\]\]"):
            read_replies(file)


def test_hand_written_replies(tmp_path: Path) -> None:
    file = tmp_path / "replies.toml"
    file.write_text('[[reply]]\nprompt = "every TV"\ntext = "A"\n[[reply]]\nprompt = "TV"\ntext = "B"\n')
    brain = read_replies(file)
    said = [brain.reply(ChatRequest("m", "", words)) for words in ("turn off every TV", "a TV", "a lamp")]
    assert said == ["A", "B", NOTHING_TO_SAY]


@given(st.text(max_size=200))
def test_counting_by_rule_is_whole_and_of_the_order_of_words(text: str) -> None:
    assert 0 <= by_rule(text) <= len(text)
    assert by_rule(text + " more") >= by_rule(text)


def test_the_program_says_what_it_is_and_what_is_wrong(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tests.ollama_double", "--port", "0", "--scenario", "doom"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=60, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("error: no scenario doom; there are ok, ")
    assert all(name in done.stderr for name in SCENARIOS)
