"""A language model of an Ollama server: the one importer of `ollama`. Blocks, and reads the clock.

Whatever the server does, `ask` ends within the time limit with a whole answer or with ModelFailed.
"""

import asyncio
import json
import logging
import os
import threading
import time
from contextlib import aclosing
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from typing import Any

import httpx
import ollama

from planners.asking import Answer, ModelFailed, Question
from planners.reply_checks import Fault, Heard, fault_of, misfit, text_of
from planners.server_faults import FAULTS, CannotSee, fault_in, fault_of_status
from wire.messages.plan import ModelCall
from wire.planner_table import PlannerChoice

log = logging.getLogger("model")

SERVER_FAULTS = (ollama.ResponseError, *FAULTS)
STAND_IN = "stand-in"
"""The family of models that are none: servers for tests and rehearsals say so."""
CONNECT_S = 2.0
KEEP_ALIVE = "2h"
_SAY_S = 10.0
_RUNAWAY = 4
"""So many pieces for each token that was allowed are no answer any more."""


@dataclass(frozen=True)
class Facts:
    """What a server says of a model."""

    capabilities: frozenset[str]
    stand_in: bool
    counted_by: str
    longest_context: int | None
    """What the model could have at most; None where it does not say."""


class OllamaModel:
    """See planners.asking.Model. A server is asked one question at a time, whoever asks, whatever the model."""

    def __init__(self, choice: PlannerChoice) -> None:
        self._choice, self._name = choice, choice.model
        self._loading: threading.Thread | None = None
        self._loading_since_s = 0.0
        self._context = choice.num_ctx
        """What was really allocated."""

    def start(self) -> None:
        """Have the model loaded in the background: a client that leaves while it is loaded would end the loading."""
        if self._loading is None or not self._loading.is_alive():
            self._loading_since_s = time.monotonic()
            self._loading = threading.Thread(target=lambda: asyncio.run(self._load()), name="load", daemon=True)
            self._loading.start()

    def loading_is_over(self, limit_s: float) -> bool:
        """Wait for the loading that `start` began, whatever came of it, but not for longer than this."""
        if self._loading is not None:
            self._loading.join(limit_s)
        return self._loading is None or not self._loading.is_alive()

    def ask(self, question: Question) -> Answer:
        with turn(address(self._choice.host)):
            return self._ask(question)

    def _ask(self, question: Question) -> Answer:
        began_s = time.monotonic()
        heard, facts = Heard(), [Facts(frozenset(), False, "server", None)]
        fault = misfit(question, self._context) or self._wait_for_loading()
        if fault is None:
            try:
                asyncio.run(self._hear(question, heard, facts))
            except SERVER_FAULTS as error:
                fault = describe(error, self._choice, self._choice.timeout_s)
            else:
                fault = fault_of(heard, question, self._context)
        call = self._record(question, heard, facts[0], fault, time.monotonic() - began_s)
        if fault is None:
            return Answer(text_of(heard, question), call)
        if fault.outcome == "timeout":
            self.start()  # it may have been loading: that goes on where nobody waits for it
        raise ModelFailed(f"{self._name}: {fault.text}", call, fault.again)

    def _wait_for_loading(self) -> Fault | None:
        if self.loading_is_over(self._choice.timeout_s):
            return None
        return Fault(
            "timeout", f"it is still being loaded, {time.monotonic() - self._loading_since_s:.0f} s so far", again=False
        )

    async def _hear(self, question: Question, heard: Heard, facts: list[Facts]) -> None:
        async with asyncio.timeout(self._choice.timeout_s), client(self._choice.host, self._choice.timeout_s) as server:
            facts[0] = known = facts_of(await server.show(self._name))
            if question.pictures and "vision" not in known.capabilities:
                raise CannotSee
            think = question.think if "thinking" in known.capabilities else None
            stream = await server.chat(
                self._name,
                _messages(question),
                stream=True,
                think=think,
                format=question.schema,
                options=self._options(question),
                keep_alive=KEEP_ALIVE,
            )
            async with aclosing(stream):
                async for part in stream:
                    _take(heard, part)
                    if heard.pieces > _RUNAWAY * question.max_tokens:
                        return  # without `done`, as of a server that stops a model by itself

    def _options(self, question: Question) -> dict[str, Any]:
        return {
            "num_ctx": self._choice.num_ctx,
            "num_predict": question.max_tokens,
            "temperature": question.temperature,
            "seed": question.seed,
        }

    def _record(
        self, question: Question, heard: Heard, facts: Facts, fault: Fault | None, latency_s: float
    ) -> ModelCall:
        counted = heard.completion_tokens is not None
        return ModelCall(
            purpose=question.purpose,
            model=self._name,
            outcome="ok" if fault is None else fault.outcome,
            prompt_tokens=heard.prompt_tokens or 0,
            completion_tokens=heard.pieces if heard.completion_tokens is None else heard.completion_tokens,
            counted_by=facts.counted_by if counted or not heard.pieces else "pieces of the stream",
            latency_s=round(latency_s, 3),
            seed=question.seed,
            schema_hash=schema_hash(question.schema),
            stand_in=facts.stand_in,
        )

    async def _load(self) -> None:
        """Load the model and see how long a context it got; the log tells how it goes."""
        choice, began_s = self._choice, time.monotonic()
        log.info("%s is loaded with a context of %d tokens", self._name, choice.num_ctx)
        try:
            async with client(choice.host, choice.load_timeout_s) as server:
                facts = facts_of(await server.show(self._name))
                options = {"num_ctx": choice.num_ctx}
                wait = server.chat(self._name, [], options=options, keep_alive=KEEP_ALIVE)
                load = asyncio.create_task(asyncio.wait_for(wait, choice.load_timeout_s))
                while not (await asyncio.wait({load}, timeout=_SAY_S))[0]:
                    log.info("%s is being loaded, %.0f s so far", self._name, time.monotonic() - began_s)
                await load
                context = allocated(await server.ps(), self._name)
        except SERVER_FAULTS as error:
            log.warning("%s: %s", self._name, describe(error, choice, choice.load_timeout_s).text)
            return
        what = "a stand-in without a model" if facts.stand_in else ", ".join(sorted(facts.capabilities))
        log.info("%s is there after %.1f s (%s)", self._name, time.monotonic() - began_s, what)
        self._context = choice.num_ctx if context is None else min(context, choice.num_ctx)
        if self._context < choice.num_ctx:
            log.warning(
                "%s has a context of %d tokens, not the %d of planner.num_ctx",
                self._name,
                self._context,
                choice.num_ctx,
            )


@cache
def turn(host: str) -> threading.Lock:
    """Whose turn it is at a server: models that answer at the same time are slower than one after the other."""
    return threading.Lock()


def address(host: str) -> str:
    """Where the server is looked for."""
    return host or os.environ.get("OLLAMA_HOST") or "http://127.0.0.1:11434"


def describe(error: BaseException, choice: PlannerChoice, limit_s: float) -> Fault:
    """One of SERVER_FAULTS."""
    if isinstance(error, ollama.ResponseError):
        return fault_of_status(error.status_code, str(error.error), choice.model)
    return fault_in(error, choice.model, address(choice.host), limit_s)


def client(host: str, timeout_s: float) -> ollama.AsyncClient:
    """A client for one use. Proxies of the environment are not for servers of one's own, and nobody is redirected."""
    return ollama.AsyncClient(
        host or None,
        verify=address(host).startswith("https"),  # certificates take a while to load, and plain HTTP has none
        follow_redirects=False,
        timeout=httpx.Timeout(timeout_s, connect=min(CONNECT_S, timeout_s)),
        trust_env=False,
    )


def facts_of(shown: ollama.ShowResponse) -> Facts:
    """From the answer of `/api/show`."""
    info = shown.modelinfo or {}
    stand_in = shown.details is not None and shown.details.family == STAND_IN
    longest = info.get(f"{info.get('general.architecture')}.context_length")
    return Facts(
        frozenset(shown.capabilities or ()),
        stand_in,
        str(info.get("tokenizer.ggml.model", STAND_IN))[:200] if stand_in else "server",
        longest if isinstance(longest, int) else None,
    )


def allocated(running: ollama.ProcessResponse, name: str) -> int | None:
    """The context that a loaded model really has; None where it is not loaded or does not say."""
    full = name if ":" in name else f"{name}:latest"
    return next((row.context_length for row in running.models if full in (row.name, row.model)), None)


def schema_hash(schema: dict[str, Any] | None) -> str:
    return "" if schema is None else sha256(json.dumps(schema, sort_keys=True).encode()).hexdigest()[:12]


def _messages(question: Question) -> list[dict[str, Any]]:
    user: dict[str, Any] = {"role": "user", "content": question.user}
    if question.pictures:
        user["images"] = list(question.pictures)
    return [*([{"role": "system", "content": question.system}] if question.system else []), user]


def _take(heard: Heard, part: ollama.ChatResponse) -> None:
    """One piece of the stream."""
    heard.text += part.message.content or ""
    heard.thinking += part.message.thinking or ""
    if part.done:
        heard.done, heard.done_reason = True, part.done_reason or ""
        heard.prompt_tokens, heard.completion_tokens = part.prompt_eval_count, part.eval_count
    else:
        heard.pieces += 1
