"""Hands a merged checkpoint to an Ollama server over its HTTP interface, and checks that what came of it can see.

The server turns the checkpoint into its own format (`FROM` a folder of safetensors, quantised on request). Where a server
cannot do that for this architecture, llama.cpp's `convert_hf_to_gguf.py` can: once plainly and once with `--mmproj`;
`files` then are the two GGUF files.
"""

import hashlib
import json
import urllib.error
import urllib.request
from base64 import b64encode
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from devices.vision.gridmask import cell_m, fov_rad, grid_for
from devices.vision.prompt import BIRDS_EYE, answer_schema, system_text, user_text
from devices.vision.reply import read
from sim.training.cubes.dataset import Example
from sim.training.cubes.score import Tally

PARAMETERS = {"temperature": 0, "num_ctx": 4096, "num_predict": 768}
SUFFIXES = (".safetensors", ".json", ".txt", ".jinja", ".gguf", ".model")
UPLOAD_S, CREATE_S, ANSWER_S = 3600.0, 3600.0, 600.0
GOLDEN_CELLS = 0.5
"""Half of what is in the golden picture must be found, no further off than this in the median."""


class PublishError(RuntimeError):
    """The server did not take the model, or what it made of it cannot see; one sentence."""


def files_of(folder: Path) -> list[Path]:
    """What of a checkpoint the server needs."""
    found = sorted(p for p in folder.iterdir() if p.suffix in SUFFIXES)
    if not any(p.suffix in (".safetensors", ".gguf") for p in found):
        raise PublishError(f"{folder} holds no .safetensors and no .gguf file; give the folder of a merged checkpoint")
    return found


def modelfile(folder: Path) -> str:
    """The same for `ollama create NAME -f Modelfile`, for people who would rather do it by hand."""
    weights = [p for p in files_of(folder) if p.suffix == ".gguf"]
    lines = [f"FROM ./{p.name}" for p in weights] or ["FROM ."]
    lines += [f"PARAMETER {name} {value}" for name, value in PARAMETERS.items()]
    return "\n".join([*lines, f'SYSTEM """{system_text(BIRDS_EYE)}"""', ""])


def create(host: str, name: str, folder: Path, quantize: str = "") -> str:
    """Upload and create; returns the server's last word. Raises PublishError."""
    files = {}
    for path in files_of(folder):
        digest = f"sha256:{_sha256(path)}"
        _upload(host, digest, path)
        files[path.name] = digest
    body = {"model": name, "files": files, "parameters": PARAMETERS, "system": system_text(BIRDS_EYE)}
    if quantize:
        body["quantize"] = quantize
    last = ""
    for line in _lines(host, "/api/create", body, CREATE_S):
        if "error" in line:
            raise PublishError(f"the server made no model of {folder}: {line['error']}")
        last = str(line.get("status", last))
    if last != "success":
        raise PublishError(f"the server stopped at {last!r} and not at 'success'")
    return last


def check(host: str, name: str, golden: Example, picture: bytes) -> dict[str, Any]:
    """The new model has eyes, and finds in a picture it never saw what is there. Raises PublishError."""
    shown = _ask(host, "/api/show", {"model": name}, ANSWER_S)
    if "vision" not in shown.get("capabilities", []):
        raise PublishError(f"{name} cannot see: the server made a model without its projector")
    message = {"role": "user", "content": user_text(BIRDS_EYE, grid_for(golden.lens), golden.lens, golden.task)}
    message["images"] = [b64encode(picture).decode()]  # type: ignore[assignment]
    messages = [{"role": "system", "content": system_text(BIRDS_EYE)}, message]
    body = {"model": name, "messages": messages, "stream": False, "format": json.loads(answer_schema(BIRDS_EYE))}
    text = str(_ask(host, "/api/chat", body | {"options": PARAMETERS}, ANSWER_S).get("message", {}).get("content", ""))
    grid = grid_for(golden.lens)
    length_m = cell_m(golden.lens.position_enu_m[2], fov_rad(golden.lens), grid.divisions)
    tally = Tally()
    tally.add(golden, read(text, BIRDS_EYE, grid, length_m))
    figures = tally.summary()
    far = figures["deviation_cells_median"]
    if 2 * tally.found < tally.there or far is None or far > GOLDEN_CELLS:
        raise PublishError(f"{name} finds {tally.found} of {tally.there} things in the golden picture, {far} cells off")
    return {**figures, "stand_in": shown.get("details", {}).get("family") == "stand-in"}


def _upload(host: str, digest: str, path: Path) -> None:
    head = urllib.request.Request(f"{host}/api/blobs/{digest}", method="HEAD")
    try:
        with urllib.request.urlopen(head, timeout=ANSWER_S):
            return
    except urllib.error.HTTPError as error:
        if error.code != 404:
            raise PublishError(f"the server at {host} says {error.code} to {path.name}") from None
    except OSError as error:
        raise PublishError(f"no model server answers at {host}: {error}") from None
    with path.open("rb") as data:
        headers = {"Content-Length": str(path.stat().st_size), "Content-Type": "application/octet-stream"}
        put = urllib.request.Request(f"{host}/api/blobs/{digest}", data=data, headers=headers, method="POST")
        try:
            with urllib.request.urlopen(put, timeout=UPLOAD_S):
                return
        except OSError as error:
            raise PublishError(f"{path.name} could not be sent to {host}: {error}") from None


def _lines(host: str, path: str, body: dict[str, Any], timeout_s: float) -> Iterator[dict[str, Any]]:
    request = urllib.request.Request(
        f"{host}{path}", data=json.dumps(body).encode(), headers={"Content-Type": "application/json"}
    )
    try:
        with urllib.request.urlopen(request, timeout=timeout_s) as answer:
            for line in answer:
                if line.strip():
                    yield json.loads(line)
    except urllib.error.HTTPError as error:
        raise PublishError(f"{path}: {error.code}: {error.read(500).decode(errors='replace')}") from None
    except OSError as error:
        raise PublishError(f"{path}: no answer from {host}: {error}") from None


def _ask(host: str, path: str, body: dict[str, Any], timeout_s: float) -> dict[str, Any]:
    whole: dict[str, Any] = {}
    for line in _lines(host, path, body, timeout_s):
        whole = line
    return whole


def _sha256(path: Path) -> str:
    with path.open("rb") as data:
        return hashlib.file_digest(data, "sha256").hexdigest()
