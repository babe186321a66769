"""The stand-in for an Ollama server: its models, what is loaded, the requests that it had; and its routes."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import ThreadingHTTPServer
from typing import Any, ClassVar

from tests.ollama_double import bodies
from tests.ollama_double.bodies import StandIn
from tests.ollama_double.brain import Brain
from tests.ollama_double.chat import Chat
from tests.ollama_double.counting import Counter, counter
from tests.ollama_double.creating import BLOBS, Creating
from tests.ollama_double.scenarios import Sequence

PULLABLE = (
    StandIn("qwen3:8b"),
    StandIn("llama3.1:8b", ("completion", "tools")),
    StandIn("qwen2.5vl:7b", ("completion", "vision"), 128000),
)


@dataclass
class State:
    """What the routes share."""

    brain: Brain
    scenario: Sequence = field(default_factory=lambda: Sequence("ok"))
    models: list[StandIn] = field(default_factory=lambda: list(PULLABLE))
    cold_load_s: float = 0.0
    token_s: float = 0.0
    """How long one token of an answer takes."""
    largest_context: int = 1_000_000
    """More than this is not allocated, whatever is asked for."""
    counter: Counter = field(default_factory=counter)
    loaded: dict[str, int] = field(default_factory=dict)
    chats: list[dict[str, Any]] = field(default_factory=list)
    """Every body of `/api/chat`, as it came."""
    loads: int = 0
    blobs: dict[str, bytes] = field(default_factory=dict)
    """What was uploaded, by its digest."""
    thinking: threading.Lock = field(default_factory=threading.Lock)

    def find(self, name: str) -> StandIn | None:
        """By its name; without a tag, `latest` is meant."""
        full = name if ":" in name else f"{name}:latest"
        return next((model for model in self.models if model.name == full), None)


class Handler(Creating, Chat):
    """One connection."""

    state: ClassVar[State]

    def do_GET(self) -> None:
        routes = {"/api/tags": self._tags, "/api/ps": self._ps, "/api/version": self._version}
        if self.path == "/":
            self.send(200, b"Ollama is running", "text/plain; charset=utf-8")
        elif self.path in routes:
            routes[self.path]()
        else:
            self.send(404, b"404 page not found", "text/plain")

    def do_POST(self) -> None:
        routes = {
            "/api/chat": self.chat,
            "/api/generate": self.generate,
            "/api/show": self._show,
            "/api/pull": self._pull,
            "/api/create": self.create,
        }
        if self.path.startswith(BLOBS):
            self.blob()
            return
        try:
            asked = self.body()
        except ValueError as error:
            self.fail(400, str(error))
            return
        if self.path not in routes:
            self.send(404, b"404 page not found", "text/plain")
            return
        try:
            routes[self.path](asked)
        except (BrokenPipeError, ConnectionResetError):
            self.close_connection = True

    def _tags(self) -> None:
        self.send(200, bodies.tags(self.state.models))

    def _ps(self) -> None:
        self.send(200, bodies.ps(self.state.loaded))

    def _version(self) -> None:
        counted_by = self.state.counter.name
        self.send(200, {"version": bodies.VERSION, "family": bodies.STAND_IN, "counted_by": counted_by})

    def _show(self, asked: dict[str, Any]) -> None:
        model = self.state.find(str(asked.get("model", "")))
        if model is None:
            self.fail(404, f"model '{asked.get('model')}' not found")
        else:
            self.send(200, bodies.show(model, self.state.counter.name))

    def _pull(self, asked: dict[str, Any]) -> None:
        name = str(asked.get("model", ""))
        model = next((model for model in PULLABLE if model.name == name), None)
        lines: list[dict[str, Any]] = [{"status": "pulling manifest"}]
        if model is None:
            lines += [{"error": "pull model manifest: file does not exist"}]
        else:
            digest = "sha256:" + "0" * 64
            lines += [{"status": f"pulling {'0' * 12}", "digest": digest, "total": 10, "completed": k} for k in (0, 10)]
            lines += [{"status": "verifying sha256 digest"}, {"status": "writing manifest"}, {"status": "success"}]
            if self.state.find(name) is None:
                self.state.models.append(model)
        if asked.get("stream", True):
            self.begin_stream()
            for line in lines:
                self.line(line)
            self.end_stream()
        elif "error" in lines[-1]:
            self.send(500, lines[-1])
        else:
            self.send(200, lines[-1])


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 64


def serve(state: State, port: int = 0) -> ThreadingHTTPServer:
    """A server at a port of this machine alone, not yet serving. Raises OSError."""
    handler = type("BoundHandler", (Handler,), {"state": state})
    return _Server(("127.0.0.1", port), handler)


@contextmanager
def running(state: State) -> Iterator[str]:
    """Serve from a thread; yields the address."""
    server = serve(state)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
