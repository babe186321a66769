"""Questions about pictures that cameras ask: one at a time, and no plan that is asked for waits behind them."""

import json
import threading
from collections import deque
from dataclasses import dataclass
from typing import Any

from planners.asking import Model, ModelFailed, Question
from wire.bus import Request
from wire.messages.look import LookReply, LookRequest

MOST_WAITING = 32
LONGEST_WAIT_S = 60.0
"""Whoever waited longer has half of its time left, which is less than a slow model needs."""
MOST_CHARACTERS = 32_000
NO_MODEL = "no model looks at pictures here: name one as `vision` in the site file's table [planner]"


@dataclass(frozen=True)
class _Waiting:
    request: Request
    look: LookRequest
    since_s: float


class Looks:
    """The cameras' queue to the model.

    By the wall clock a thread asks, and the planner goes on with what else it is asked. With `time_stands`, in lockstep,
    it asks at once and within the step: what comes of a run must not depend on how fast a model is.
    """

    def __init__(self, model: Model | None, time_stands: bool = False) -> None:
        self._model, self._time_stands = model, time_stands
        self._waiting: deque[_Waiting] = deque()
        self._asked: _Waiting | None = None
        self._thread: threading.Thread | None = None
        self._answers: list[LookReply] = []
        """Filled by the thread, with one."""

    @property
    def busy(self) -> bool:
        """Whether somebody waits for an answer."""
        return bool(self._waiting) or self._asked is not None

    def take(self, request: Request, look: LookRequest, now_s: float) -> None:
        """One more question; an older one of the same asker that still waits is given up for it."""
        if self._model is None:
            request.reply(LookReply(reason=NO_MODEL))
            return
        fault = _fault(look)
        if fault:
            request.reply(LookReply(reason=fault))
            return
        for older in [w for w in self._waiting if w.look.asker == look.asker]:
            self._waiting.remove(older)
            older.request.reply(LookReply(reason=f"a newer picture of {look.asker} is to be looked at instead"))
        if len(self._waiting) >= MOST_WAITING:
            request.reply(LookReply(reason=f"{MOST_WAITING} pictures wait already; look less often"))
            return
        self._waiting.append(_Waiting(request, look, now_s))

    def step(self, now_s: float) -> None:
        """Pass an answer on that has come, and put the next question. To be called when no plan is asked for."""
        if self._asked is not None and self._thread is not None and not self._thread.is_alive():
            if not self._answers:
                raise RuntimeError("the thread that asks the model has ended without an answer")
            self._asked.request.reply(self._answers.pop())
            self._asked = self._thread = None
        if self._asked is not None or self._model is None:
            return
        waiting = self._next(now_s)
        if waiting is None:
            return
        if self._time_stands:
            waiting.request.reply(answer(self._model, waiting.look))
            return
        self._asked = waiting
        self._thread = threading.Thread(
            target=self._ask, args=(self._model, waiting.look), name=f"look-{waiting.look.asker}", daemon=True
        )
        self._thread.start()

    def _next(self, now_s: float) -> _Waiting | None:
        while self._waiting:
            waiting = self._waiting.popleft()
            if now_s - waiting.since_s <= LONGEST_WAIT_S:
                return waiting
            waiting.request.reply(LookReply(reason=f"the model had no time for it within {LONGEST_WAIT_S:g} s"))
        return None

    def _ask(self, model: Model, look: LookRequest) -> None:
        self._answers.append(answer(model, look))


def answer(model: Model, look: LookRequest) -> LookReply:
    """What a model says of a picture; blocks until it has."""
    try:
        said = model.ask(question_of(look))
    except ModelFailed as failed:
        return LookReply(reason=str(failed)[:2000] or "the model failed and did not say why", call=failed.call)
    if len(said.text) > MOST_CHARACTERS:
        return LookReply(reason=f"the model's answer is longer than {MOST_CHARACTERS} characters", call=said.call)
    return LookReply(text=said.text, call=said.call)


def question_of(look: LookRequest) -> Question:
    """A camera's question as planners know questions."""
    return Question(
        purpose=look.purpose,
        system=look.system,
        user=look.user,
        schema=_schema(look.answer_schema),
        pictures=(look.picture,),
        max_tokens=look.max_tokens,
        seed=look.seed,
    )


def _fault(look: LookRequest) -> str:
    """Why this cannot be asked; empty when it can."""
    if not look.picture.startswith((b"\xff\xd8", b"\x89PNG")):
        return "the picture is no JPEG or PNG file"
    try:
        _schema(look.answer_schema)
    except ValueError as error:
        return f"answer_schema: {error}"
    return ""


def _schema(text: str) -> dict[str, Any] | None:
    """Raises ValueError when the text is no JSON object."""
    if not text:
        return None
    schema = json.loads(text)
    if not isinstance(schema, dict):
        raise ValueError("a JSON object is expected")
    return schema
