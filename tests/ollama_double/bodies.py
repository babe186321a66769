"""The JSON bodies of an Ollama server, field by field as version 0.33 sends them."""

import time
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

VERSION = "0.33.2"
STAND_IN = "stand-in"
"""The family of every model here: who asks `/api/show`, `/api/tags` or `/api/ps` sees that there is no model."""
_DIGEST = "0" * 64


@dataclass(frozen=True)
class StandIn:
    """A model that is not there."""

    name: str
    capabilities: tuple[str, ...] = ("completion", "tools", "thinking")
    context: int = 40960
    """The longest that it could have."""


def stamp(ahead_s: float = 0.0) -> str:
    return datetime.fromtimestamp(time.time() + ahead_s, UTC).isoformat().replace("+00:00", "Z")


def details() -> dict[str, Any]:
    return {
        "parent_model": "",
        "format": "none",
        "family": STAND_IN,
        "families": [STAND_IN],
        "parameter_size": "0B",
        "quantization_level": "none",
    }


def tags(models: list[StandIn]) -> dict[str, Any]:
    rows = [
        {
            "name": model.name,
            "model": model.name,
            "modified_at": stamp(),
            "size": 0,
            "digest": _DIGEST,
            "details": details(),
            "capabilities": list(model.capabilities),
        }
        for model in models
    ]
    return {"models": rows}


def show(model: StandIn, counted_by: str) -> dict[str, Any]:
    return {
        "modelfile": f"# {STAND_IN}: no weights\n",
        "parameters": "",
        "template": "{{ .Prompt }}",
        "details": details(),
        "model_info": {
            "general.architecture": STAND_IN,
            f"{STAND_IN}.context_length": model.context,
            "tokenizer.ggml.model": counted_by,
        },
        "capabilities": list(model.capabilities),
        "modified_at": stamp(),
    }


def ps(loaded: dict[str, int]) -> dict[str, Any]:
    rows = [
        {
            "name": name,
            "model": name,
            "size": 0,
            "digest": _DIGEST,
            "details": details(),
            "expires_at": stamp(300.0),
            "size_vram": 0,
            "context_length": context,
        }
        for name, context in sorted(loaded.items())
    ]
    return {"models": rows}


def chat(model: str, message: dict[str, Any] | None, **ending: Any) -> dict[str, Any]:
    """One object of `/api/chat`: a whole answer, a piece of a stream, or its end."""
    body: dict[str, Any] = {"model": model, "created_at": stamp()}
    if message is not None:
        body["message"] = {"role": "assistant", **message}
    return {**body, "done": False, **ending}


def counts(prompt: int, completion: int, took_s: float, load_s: float = 0.0, reason: str = "stop") -> dict[str, Any]:
    """What the last object of an answer has besides."""
    nanoseconds = int(took_s * 1e9)
    return {
        "done": True,
        "done_reason": reason,
        "total_duration": nanoseconds,
        "load_duration": int(load_s * 1e9),
        "prompt_eval_count": prompt,
        "prompt_eval_duration": nanoseconds // 2,
        "eval_count": completion,
        "eval_duration": nanoseconds // 2,
    }
