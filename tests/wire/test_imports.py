"""The contract stays light: what every process imports, and what the pure parts do not."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HEAVY = {"numpy", "cv2", "scipy", "pybullet", "rerun", "torch", "supervisor", "typer", "rich", "lark", "asyncio"}


def imported_with(module: str) -> set[str]:
    """Names of everything that importing this module brings along."""
    code = f"import {module}, json, sys; print(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout))


@pytest.mark.parametrize("module", ["wire.process", "wire.router", "wire.recorder"])
def test_a_process_brings_nothing_heavy(module: str) -> None:
    assert imported_with(module) & HEAVY == set()


@pytest.mark.parametrize("module", ["wire.loopback", "wire.bus", "wire.goals", "wire.frames", "wire.site"])
def test_the_pure_parts_open_no_sessions(module: str) -> None:
    assert "zenoh" not in imported_with(module)


def test_zenoh_is_imported_in_one_place() -> None:
    importers = [
        path.name for path in (ROOT / "wire").rglob("*.py") if "import zenoh" in path.read_text(encoding="utf-8")
    ]
    assert importers == ["node.py"]
