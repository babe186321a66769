"""`/api/chat` and `/api/generate` of the stand-in: load, ask the brain, answer or go wrong as the scenario says."""

import time
from base64 import b64decode
from typing import TYPE_CHECKING, Any

from tests.ollama_double import bodies
from tests.ollama_double.brain import ChatRequest
from tests.ollama_double.counting import MESSAGE_TOKENS, PICTURE_TOKENS
from tests.ollama_double.wire import Speaker

if TYPE_CHECKING:
    from tests.ollama_double.server import State

DEFAULT_CONTEXT = 4096
"""What a server with little memory gives a model when nobody asks for more."""
FOREVER_S = 3600.0
_PIECE = 4
"""So many characters come as one token of a stream."""
STATUSES: dict[str, tuple[int, str]] = {
    "missing": (404, 'model "{model}" not found, try pulling it first'),
    "busy": (503, "server busy, please try again.  maximum pending requests exceeded"),
    "oom": (
        500,
        "model runner has unexpectedly stopped, this may be due to resource limitations or an internal error, check "
        "ollama server logs for details",
    ),
    "bad_request": (400, "invalid options: num_ctx"),
    "too_long": (400, "the prompt is longer than the context of the model"),
}


class Chat(Speaker):
    """See tests.ollama_double.server.Handler."""

    state: "State"

    def generate(self, asked: dict[str, Any]) -> None:
        """The older route, for whoever tries the server by hand: one prompt, one answer."""
        if self.state.find(str(asked.get("model", ""))) is None:
            self.fail(404, f"model '{asked.get('model')}' not found")
            return
        began_s = time.monotonic()
        request = request_of({**asked, "messages": [{"role": "user", "content": str(asked.get("prompt", ""))}]})
        text = self.state.brain.reply(request)
        count = self.state.counter.count
        ending = bodies.counts(count(request.user), count(text), time.monotonic() - began_s)
        body = {"model": request.model, "created_at": bodies.stamp(), "response": text, **ending}
        if asked.get("stream", True):
            self.begin_stream()
            self.line(body)
            self.end_stream()
        else:
            self.send(200, body)

    def chat(self, asked: dict[str, Any]) -> None:
        self.state.chats.append(asked)
        model = self.state.find(str(asked.get("model", "")))
        if model is None:
            self.fail(404, f"model '{asked.get('model')}' not found")
            return
        if asked.get("think") and "thinking" not in model.capabilities:
            self.fail(400, f'"{model.name}" does not support thinking')
            return
        load_s = self._load(model.name, asked)
        if load_s is None:
            return  # whoever leaves while a model is loaded ends the loading
        if not asked.get("messages"):
            reason = "unload" if asked.get("keep_alive") == 0 else "load"
            body = bodies.chat(model.name, {"content": ""}, **bodies.counts(0, 0, load_s, load_s, reason))
            self._whole(asked, body)
            return
        with self.state.thinking:  # OLLAMA_NUM_PARALLEL is 1
            self._act(self.state.scenario.next(), asked, model.name, load_s, "thinking" in model.capabilities)

    def _load(self, name: str, asked: dict[str, Any]) -> float | None:
        """Seconds that loading took: a model is loaded anew when its context changes. None: the client left."""
        wanted = int((asked.get("options") or {}).get("num_ctx") or DEFAULT_CONTEXT)
        model = self.state.find(name)
        context = min(wanted, self.state.largest_context, model.context if model is not None else wanted)
        if asked.get("keep_alive") == 0 and not asked.get("messages"):
            self.state.loaded.pop(name, None)
            return 0.0
        if self.state.loaded.get(name) == context:
            return 0.0
        self.state.loaded.pop(name, None)
        if not self.stays(self.state.cold_load_s):
            self.close_connection = True
            return None
        self.state.loads += 1
        self.state.loaded[name] = context
        return self.state.cold_load_s

    def _act(self, scenario: str, asked: dict[str, Any], model: str, load_s: float, thinks: bool) -> None:
        if scenario in STATUSES:
            status, text = STATUSES[scenario]
            self.fail(status, text.format(model=model))
        elif scenario == "html":
            self.send(502, b"<html><body><h1>502 Bad Gateway</h1></body></html>", "text/html")
        elif scenario == "bad_json":
            self.send(200, b"{not json")
        elif scenario == "no_message":
            self.send(200, bodies.chat(model, None, done=True, done_reason="stop"))
        elif scenario == "drop_before":
            self.drop()
        elif scenario == "hang":
            self.stays(FOREVER_S)
            self.close_connection = True
        else:
            self._answer(scenario, asked, model, load_s, thinks)

    def _answer(self, scenario: str, asked: dict[str, Any], model: str, load_s: float, thinks: bool) -> None:
        began_s = time.monotonic()
        request = request_of(asked)
        prompt = sum(self.state.counter.count(text) + MESSAGE_TOKENS for _, text in request.messages)
        prompt += PICTURE_TOKENS * len(request.pictures)
        context = self.state.loaded.get(model, DEFAULT_CONTEXT)
        if scenario == "truncated":
            context = min(context, prompt * 2 // 3)
        if prompt > context:
            prompt = context // 2 + 2  # what is too long is cut to about half a window, and only the count tells
            request = request_of(asked, context * 2)
        text, reason = self._spoken(scenario, request), "stop"
        limit = request.num_predict
        if scenario == "runaway":
            text = text * 1000
        elif scenario == "length" or 0 < limit < self.state.counter.count(text):
            text, reason = text[: min(max(len(text) // 2, 1), limit * _PIECE)], "length"
        thought = "The user wants an answer." if thinks and asked.get("think") is not False else ""
        if scenario in ("think_only", "think_empty"):
            thought, text = (text if scenario == "think_only" else "Hmm. Let me see."), ""
        completion = self.state.counter.count(thought + text)
        ending = bodies.counts(prompt, completion, time.monotonic() - began_s, load_s, reason)
        self._speak(scenario, asked, model, (thought, text), ending)

    def _spoken(self, scenario: str, request: ChatRequest) -> str:
        if scenario == "empty":
            return ""
        if scenario == "off_schema":
            return '{"thought": "this is not what the schema wants"}'
        if scenario == "repeat":
            return '{"goals": [' + "1, " * 40
        return self.state.brain.reply(request)

    def _speak(
        self, scenario: str, asked: dict[str, Any], model: str, said: tuple[str, str], ending: dict[str, Any]
    ) -> None:
        """Stream it, or send it whole; the protocol's default is to stream."""
        thought, text = said
        if not asked.get("stream", True):
            if scenario == "error_mid":
                self.fail(500, "an error was encountered while running the model")
            elif scenario in ("drop_mid", "hang_mid", "dribble"):
                self._half(scenario)
            else:
                message = {"content": text, **({"thinking": thought} if thought else {})}
                self.send(200, bodies.chat(model, message, **({} if scenario == "repeat" else ending)))
            return
        self.begin_stream()
        pieces = [("thinking", thought[i : i + _PIECE]) for i in range(0, len(thought), _PIECE)]
        pieces += [("content", text[i : i + _PIECE]) for i in range(0, len(text), _PIECE)]
        broken = scenario in ("error_mid", "drop_mid", "hang_mid", "dribble")
        for field, piece in pieces[: len(pieces) // 2] if broken else pieces:
            if not self.stays(self.state.token_s):
                self.close_connection = True
                return
            self.line(bodies.chat(model, {"content": "", field: piece}))
        if broken:
            self._break(scenario)
            return
        if scenario != "repeat":
            self.line(bodies.chat(model, {"content": ""}, **ending))
        self.end_stream()

    def _break(self, scenario: str) -> None:
        """A stream that does not come to its end."""
        if scenario == "error_mid":
            self.line({"error": "an error was encountered while running the model"})
            self.end_stream()
        elif scenario == "drop_mid":
            self.drop()
        elif scenario == "hang_mid":
            self.stays(FOREVER_S)
            self.close_connection = True
        else:
            self._dribble()

    def _half(self, scenario: str) -> None:
        """A whole answer of which only the beginning comes."""
        self.send_response(200)
        self.send_header("Content-Type", "application/json; charset=utf-8")
        self.send_header("Content-Length", "1000")
        self.end_headers()
        self.wfile.write(b'{"model":')
        if scenario == "drop_mid":
            self.drop()
        elif scenario == "hang_mid":
            self.stays(FOREVER_S)
            self.close_connection = True
        else:
            self._dribble()

    def _dribble(self) -> None:
        while self.stays(0.05):
            self.line(b" ")
        self.close_connection = True

    def _whole(self, asked: dict[str, Any], body: dict[str, Any]) -> None:
        if asked.get("stream", True):
            self.begin_stream()
            self.line(body)
            self.end_stream()
        else:
            self.send(200, body)


def request_of(asked: dict[str, Any], keep_tokens: int | None = None) -> ChatRequest:
    """What a model would see; with `keep_tokens`, only the end of the last message, as of a prompt that was cut."""
    messages = tuple((str(m.get("role", "")), str(m.get("content") or "")) for m in asked.get("messages") or [])
    if keep_tokens is not None and messages:
        messages = (*messages[:-1], (messages[-1][0], messages[-1][1][-keep_tokens:]))
    options = asked.get("options") or {}
    schema = asked.get("format")
    return ChatRequest(
        model=str(asked.get("model", "")),
        system="\n".join(text for role, text in messages if role == "system"),
        user=next((text for role, text in reversed(messages) if role == "user"), ""),
        messages=messages,
        schema=schema if isinstance(schema, dict) else None,
        pictures=tuple(b64decode(p) for m in asked.get("messages") or [] for p in m.get("images") or []),
        seed=int(options.get("seed") or 0),
        temperature=float(options.get("temperature") or 0.0),
        num_predict=int(options.get("num_predict") or -1),
    )
