"""HTTP as an Ollama server speaks it: one JSON object, or a chunked stream of JSON lines."""

import json
import select
import socket
import time
from contextlib import suppress
from http.server import BaseHTTPRequestHandler
from typing import Any

_LOOK_S = 0.02


class Speaker(BaseHTTPRequestHandler):
    """Reads one request and writes its answer."""

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def handle(self) -> None:
        """A client may leave at any time."""
        with suppress(ConnectionError):
            super().handle()

    def log_message(self, format: str, *args: object) -> None:
        """Tests read no log of it."""

    def body(self) -> Any:
        """The JSON of the request. Raises ValueError."""
        return json.loads(self.rfile.read(int(self.headers.get("content-length") or 0)) or b"{}")

    def send(self, status: int, content: dict[str, Any] | bytes, kind: str = "application/json; charset=utf-8") -> None:
        data = content if isinstance(content, bytes) else json.dumps(content).encode()
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def fail(self, status: int, text: str) -> None:
        self.send(status, {"error": text})

    def begin_stream(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "application/x-ndjson")
        self.send_header("Transfer-Encoding", "chunked")
        self.end_headers()

    def line(self, content: dict[str, Any] | bytes) -> None:
        """One line of the stream."""
        data = content if isinstance(content, bytes) else json.dumps(content).encode() + b"\n"
        self.wfile.write(f"{len(data):x}\r\n".encode() + data + b"\r\n")
        self.wfile.flush()

    def end_stream(self) -> None:
        self.wfile.write(b"0\r\n\r\n")

    def drop(self) -> None:
        """End the connection as a killed server does."""
        self.close_connection = True
        self.wfile.flush()
        self.connection.shutdown(socket.SHUT_RDWR)

    def client_left(self) -> bool:
        """Whether the client has closed its side."""
        readable, _, _ = select.select([self.connection], [], [], 0.0)
        if not readable:
            return False
        try:
            return self.connection.recv(1, socket.MSG_PEEK) == b""
        except OSError:
            return True

    def stays(self, seconds: float) -> bool:
        """Let time pass as long as the client waits; False when it left first."""
        until_s = time.monotonic() + seconds
        while time.monotonic() < until_s:
            if self.client_left():
                return False
            time.sleep(_LOOK_S)
        return True
