"""The wrapper: a command that there is not, is answered with where the others are listed."""

import re
import signal
import socket
import subprocess
from itertools import takewhile
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


@pytest.mark.walk
def test_ending_the_simulated_drone_leaves_none_behind() -> None:
    """A service manager ends what it started, which is just: the simulator itself must hear of it."""
    if not (ROOT / ".tools" / "bin" / "just").exists():
        pytest.skip("just is fetched by ./justw, which was not used to start this run")
    command = [ROOT / "justw", "sitl", "--tcp", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        lines = list(takewhile(lambda line: not line.startswith("ready"), process.stdout))
        found = re.search(r"TCP on 127\.0\.0\.1:(\d+)", "".join(lines))
        assert found, lines
        process.send_signal(signal.SIGTERM)
        process.stdout.read()  # to its end, which comes when the last that writes there is gone
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", int(found[1])), 1.0)
