"""The wrapper: a command that there is not, is answered with where the others are listed."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_an_unknown_command_is_told_where_the_others_are() -> None:
    if not (ROOT / ".tools" / "bin" / "just").exists():
        pytest.skip("just is fetched by ./justw, which was not used to start this run")
    done = subprocess.run([ROOT / "justw", "staus"], capture_output=True, text=True)
    assert done.returncode == 1
    assert "Did you mean `status`?" in done.stderr
    assert "`./justw` lists the commands" in done.stderr
