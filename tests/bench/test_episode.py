"""The promise that a whole episode, pictures and all, says the same bytes in every run."""

import json
import os
import subprocess
import sys
from itertools import zip_longest
from pathlib import Path
from typing import Any

import pytest

from wire.recording import Record, read_recording

HOME, ROBOTS, WORDS = "37", "2", "put the pot on the side table and turn on the TV"
"""A small home, two robots, twenty simulated seconds: a search, two plans anew, a grasp, and a switch."""


def episode(recording: Path, hash_seed: str) -> dict[str, Any]:
    """One run in a process of its own, with its own order of sets."""
    done = subprocess.run(
        [
            sys.executable, "-m", "bench.episode", "--seed", HOME, "--robots", ROBOTS, "--instruction", WORDS,
            "--limit-s", "60", "--record", str(recording), "--json",
        ],
        env={**os.environ, "PYTHONPATH": str(Path.cwd()), "PYTHONHASHSEED": hash_seed},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    result: dict[str, Any] = json.loads(done.stdout[done.stdout.index("{") :])
    return result


def first_difference(one: Path, other: Path) -> tuple[Record | None, Record | None] | None:
    pairs = zip_longest(read_recording(one), read_recording(other))
    return next((pair for pair in pairs if pair[0] != pair[1]), None)


@pytest.mark.timeout(400)
def test_two_runs_of_an_episode_say_and_remember_the_same_bytes(tmp_path: Path) -> None:
    one, other = episode(tmp_path / "one", "1"), episode(tmp_path / "other", "2")
    assert first_difference(tmp_path / "one", tmp_path / "other") is None
    for run in (one, other):
        for clocked in ("wall_s", "times_real_time"):
            del run[clocked]
    assert one == other
    assert one["task"]["status"] == "done", one["task"]["log"]
    assert one["task"]["replans"] > 0
    senders = {row.sender for row in read_recording(tmp_path / "one") if row.key.startswith("observation/")}
    assert {"dog-1", "dog-2", "cctv-1"} <= senders, "what was seen in pictures is among what was said"
