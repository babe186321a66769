"""`/api/blobs` and `/api/create` of the stand-in: files are checked against their digests, models are made of none.

A model gets eyes when what was sent describes some: a `vision_config` in its `config.json`, or a second GGUF file.
"""

import hashlib
import json
from typing import TYPE_CHECKING, Any

from tests.ollama_double.bodies import StandIn
from tests.ollama_double.wire import Speaker

if TYPE_CHECKING:
    from tests.ollama_double.server import State

BLOBS = "/api/blobs/"


class Creating(Speaker):
    """See tests.ollama_double.server.Handler."""

    state: "State"

    def do_HEAD(self) -> None:
        self.send(200 if self.path.removeprefix(BLOBS) in self.state.blobs else 404, b"")

    def blob(self) -> None:
        """One uploaded file."""
        data = self.rfile.read(int(self.headers.get("content-length") or 0))
        digest = f"sha256:{hashlib.sha256(data).hexdigest()}"
        if self.path != BLOBS + digest:
            self.fail(400, f"digest mismatch, expected {self.path.removeprefix(BLOBS)}, got {digest}")
            return
        self.state.blobs[digest] = data
        self.send(201, b"")

    def create(self, asked: dict[str, Any]) -> None:
        files = {str(name): str(digest) for name, digest in (asked.get("files") or {}).items()}
        lost = [digest for digest in files.values() if digest not in self.state.blobs]
        if not files or lost:
            self.fail(400, f"file {lost[0]} not found" if lost else "neither 'from' or 'files' was specified")
            return
        name = str(asked["model"])
        full = name if ":" in name else f"{name}:latest"
        eyes = ("vision",) if self._has_eyes(files) else ()
        self.state.models.append(StandIn(full, ("completion", *eyes)))
        self.begin_stream()
        for status in ("converting model", "parsing GGUF", "writing manifest", "success"):
            self.line({"status": status})
        self.end_stream()

    def _has_eyes(self, files: dict[str, str]) -> bool:
        if sum(name.endswith(".gguf") for name in files) > 1:
            return True
        config = self.state.blobs.get(files.get("config.json", ""), b"{}")
        return "vision_config" in json.loads(config)
