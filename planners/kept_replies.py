"""Answers of a model kept on disk: the same question again gets the same answer, without a server."""

import json
import logging
import os
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path

from pydantic import ValidationError

from planners.asking import Answer, Model, ModelFailed, Question
from wire.messages.plan import ModelCall

log = logging.getLogger("model")


class KeptReplies:
    """See planners.asking.Model. Without `model` there is nothing but what was kept."""

    def __init__(self, folder: Path, name: str, num_ctx: int, model: Model | None) -> None:
        self._folder, self._name, self._num_ctx, self._model = folder, name, num_ctx, model

    def ask(self, question: Question) -> Answer:
        file = self._folder / f"{fingerprint(question, self._name, self._num_ctx)}.json"
        kept = _read(file, question)
        if kept is not None:
            return kept
        if self._model is None:
            call = ModelCall(purpose=question.purpose, model=self._name, outcome="unasked", seed=question.seed)
            raise ModelFailed(f"{self._name}: no answer to this question is kept in {self._folder}", call, again=False)
        answer = self._model.ask(question)
        _write(file, answer)
        return answer


def fingerprint(question: Question, name: str, num_ctx: int) -> str:
    """Of everything that decides the answer. What the question is for does not."""
    parts = asdict(question)
    del parts["purpose"]
    parts["pictures"] = [sha256(picture).hexdigest() for picture in question.pictures]
    return sha256(json.dumps([name, num_ctx, parts], sort_keys=True).encode()).hexdigest()


def _read(file: Path, question: Question) -> Answer | None:
    try:
        kept = json.loads(file.read_text())
        call = ModelCall.model_validate(kept["call"])
        text = str(kept["text"])
    except FileNotFoundError:
        return None
    except (OSError, ValueError, ValidationError, KeyError, TypeError) as error:
        log.warning("%s is not a kept answer and is passed over: %s", file, error)
        return None
    return Answer(text, call.model_copy(update={"purpose": question.purpose, "latency_s": 0.0, "cached": True}))


def _write(file: Path, answer: Answer) -> None:
    """Whole or not at all: another process may read it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_suffix(f".{os.getpid()}")
    part.write_text(json.dumps({"text": answer.text, "call": answer.call.model_dump()}, indent=1))
    part.replace(file)
