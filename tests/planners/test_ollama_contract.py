"""What R2X relies on, asked of a real model server: `R2X_OLLAMA=1 ./justw test-ollama`.

`OLLAMA_HOST` says where it is; R2X_OLLAMA_MODEL, R2X_OLLAMA_VISION and R2X_OLLAMA_PLANNER name others than qwen3:8b,
qwen2.5vl:7b and goals. Against `./justw ollama-double` it is a rehearsal, and says so.
"""

import json
import os
import struct
import sys
import zlib

import pytest

from planners.asking import Answer, Question
from planners.model import OllamaModel
from planners.model_inspection import inspect
from planners.modelled import has_model
from planners.planner import PLANNERS
from tests.ollama_double.brains.contract import MARK
from tests.planners.test_tasks import furnished, hub_agrees
from tests.planners.toy import site
from wire.messages.plan import PlanRequest
from wire.planner_table import PlannerChoice

pytestmark = [
    pytest.mark.skipif(not os.environ.get("R2X_OLLAMA"), reason="asks a real model server: set R2X_OLLAMA=1"),
    pytest.mark.timeout(900),
]
MODEL = os.environ.get("R2X_OLLAMA_MODEL", "qwen3:8b")
VISION = os.environ.get("R2X_OLLAMA_VISION", "qwen2.5vl:7b")
PLANNER = os.environ.get("R2X_OLLAMA_PLANNER", "goals")
NUM_CTX = 4096
INSTRUCTIONS = (
    "the fruit belongs in the cold",
    "make sure the milk does not go off",
    "get everything edible off the beds and into the kitchen",
)
"""Out of the grammar's reach, so that the model has to read them."""


def choice(model: str = MODEL) -> PlannerChoice:
    table = {"name": PLANNER, "model": model, "num_ctx": NUM_CTX, "timeout_s": 300.0}
    return PlannerChoice.model_validate(table)


def say(text: str) -> None:
    sys.stdout.write(f"\n  {text}")


@pytest.fixture(scope="module")
def model() -> OllamaModel:
    """Loaded, as the planner has it when its first task comes."""
    loaded = OllamaModel(choice())
    loaded.start()
    assert loaded.loading_is_over(600.0)
    return loaded


@pytest.fixture(autouse=True)
def label() -> None:
    facts = inspect(choice()).facts
    if facts is not None and facts.stand_in:
        say("REHEARSAL against a stand-in: nothing is learned of any model")


def told(answer: Answer) -> str:
    call = answer.call
    return f"{call.model}: {call.prompt_tokens} + {call.completion_tokens} tokens in {call.latency_s:.1f} s: {answer.text[:80]!r}"


def test_the_model_is_there_and_says_what_it_can() -> None:
    state = inspect(choice())
    assert state.fault is None, state.fault
    assert MODEL in state.pulled or f"{MODEL}:latest" in state.pulled
    assert state.facts is not None
    assert "completion" in state.facts.capabilities
    say(f"{state.host}: {MODEL} has {', '.join(sorted(state.facts.capabilities))}")


def test_a_schema_is_kept_to(model: OllamaModel) -> None:
    schema = {
        "type": "object",
        "properties": {"number": {"type": "integer", "minimum": 0, "maximum": 9}},
        "required": ["number"],
        "additionalProperties": False,
    }
    user = 'Name a digit as JSON, as in {"number": 3}.'
    answer = model.ask(Question("contract", MARK, user, schema, max_tokens=32))
    say(told(answer))
    assert set(json.loads(answer.text)) == {"number"}
    assert isinstance(json.loads(answer.text)["number"], int)


def test_the_counts_are_those_of_the_prompt(model: OllamaModel) -> None:
    short = model.ask(Question("contract", MARK, "Say yes.", max_tokens=64)).call
    long = model.ask(
        Question("contract", MARK, "Say yes. " + "The lamp in the kitchen is on. " * 40, max_tokens=64)
    ).call
    say(f"{short.prompt_tokens} tokens, and with 40 sentences more {long.prompt_tokens}")
    assert short.prompt_tokens < 120
    assert 200 < long.prompt_tokens - short.prompt_tokens < 600


def test_the_context_that_was_asked_for_was_allocated(model: OllamaModel) -> None:
    model.ask(Question("contract", MARK, "Say yes.", max_tokens=64))
    context = inspect(choice()).context
    say(f"context {context}")
    assert context == NUM_CTX


def test_a_picture_is_seen() -> None:
    eyes = OllamaModel(choice(VISION))
    schema = {
        "type": "object",
        "properties": {"colour": {"type": "string", "enum": ["red", "green", "blue"]}},
        "required": ["colour"],
    }
    user = 'Which colour is the picture? Answer as JSON, as in {"colour": "blue"}.'
    answer = eyes.ask(Question("contract", MARK, user, schema, pictures=(png(224, (220, 20, 20)),), max_tokens=32))
    say(told(answer))
    assert json.loads(answer.text) == {"colour": "red"}


@pytest.mark.parametrize("instruction", INSTRUCTIONS)
def test_an_instruction_goes_through_the_planner(instruction: str) -> None:
    if PLANNER not in PLANNERS or not has_model(PLANNERS[PLANNER]):
        pytest.skip(f"no planner {PLANNER!r} that has a model; R2X_OLLAMA_PLANNER names one")
    planner = PLANNERS[PLANNER](site().model_copy(update={"planner": choice()}))
    world = furnished(1, ("kitchen", "living-room")).world()
    reply = planner.make_plan(PlanRequest(task="t", epoch=0, instruction=instruction, world=world, now_s=0.0))
    for call in reply.calls:
        say(
            f"{call.purpose}: {call.outcome}, {call.prompt_tokens} + {call.completion_tokens} tokens, {call.latency_s:.1f} s"
        )
    made = f"{len(reply.plan.nodes)} nodes by {reply.plan.planner}" if reply.plan is not None else ""
    say(f"{instruction!r}: {made or (reply.refusal.reason if reply.refusal is not None else '')} {reply.note}")
    assert reply.calls, "the model was not asked"
    assert all(call.outcome in ("ok", "invalid") for call in reply.calls)
    if reply.plan is not None:
        hub_agrees(reply.plan, world)


def png(side: int, colour: tuple[int, int, int]) -> bytes:
    """A square of one colour."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = (b"\0" + bytes(colour) * side) * side
    head = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
