"""A simulated autopilot as a real process, and ground stations that others wrote at the other end of its links."""

import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CLIENTS = ROOT / ".clients" / "bin"
FIRMWARES = ("ardupilot", "px4")
needs_clients = pytest.mark.skipif(
    not (CLIENTS / "python").exists(), reason="deploy/install_clients.sh, part of `./justw test`, was not run"
)


class Autopilot:
    """`python -m sim.sitl` with a TCP and a UDP port of its own."""

    def __init__(self, folder: Path, firmware: str, *args: str) -> None:
        self._log = folder / "sitl.log"
        self._command = [sys.executable, "-m", "sim.sitl", "--firmware", firmware, "--tcp", "0", "--udp-in", "0", *args]

    def __enter__(self) -> "Autopilot":
        with self._log.open("wb") as log:
            environment = {**os.environ, "PYTHONPATH": str(ROOT)}
            self._process = subprocess.Popen(self._command, env=environment, stdout=log, stderr=log)
        wait_for(lambda: "ready" in self.log(), 30.0, self.log)
        self.tcp_port, self.udp_port = (self._port(kind) for kind in ("TCP", "UDP"))
        return self

    def __exit__(self, *_: object) -> None:
        end(self._process)

    def log(self) -> str:
        return self._log.read_text()

    def _port(self, kind: str) -> int:
        found = re.search(rf"^{kind} on 127\.0\.0\.1:(\d+)", self.log(), re.MULTILINE)
        assert found, self.log()
        return int(found[1])


class Session:
    """A program that is talked to line by line: what it says is waited for."""

    def __init__(self, folder: Path, *command: str) -> None:
        self._log = folder / "session.log"
        self._heard = 0
        with self._log.open("wb") as log:
            environment = {**os.environ, "HOME": str(folder), "PYTHONUNBUFFERED": "1"}
            self._process = subprocess.Popen(
                command, cwd=folder, env=environment, stdin=subprocess.PIPE, stdout=log, stderr=log
            )

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *_: object) -> None:
        end(self._process)

    def say(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(f"{line}\n".encode())
        self._process.stdin.flush()

    def hear(self, pattern: str, limit_s: float = 15.0) -> re.Match[str]:
        """The next that matches, after what was heard before."""
        found: list[re.Match[str]] = []

        def there() -> bool:
            found.extend(re.compile(pattern, re.MULTILINE).finditer(self.log(), self._heard))
            return bool(found)

        wait_for(there, limit_s, lambda: f"not heard: {pattern}\n{self.log()}")
        self._heard = found[0].end()
        return found[0]

    def do(self, line: str, pattern: str, limit_s: float = 15.0) -> re.Match[str]:
        self.say(line)
        return self.hear(pattern, limit_s)

    def log(self) -> str:
        return self._log.read_text(errors="replace")


def fly(script: str, *args: str, folder: Path, limit_s: float = 60.0) -> str:
    """Runs one of tests/clients/; what it printed, of which the last line is OK."""
    command = [str(CLIENTS / "python"), str(ROOT / "tests" / "clients" / script), *args]
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=limit_s)
    except subprocess.TimeoutExpired as late:
        pytest.fail(f"{script} took longer than {limit_s} s:\n{late.stdout!r}\n{late.stderr!r}")
    assert done.returncode == 0, f"{script}:\n{done.stdout}\n{done.stderr}"
    assert done.stdout.endswith("OK\n"), done.stdout
    return done.stdout


def end(process: "subprocess.Popen[bytes]") -> None:
    """A session ends when there is nothing more to read; other programs when they are told."""
    if process.stdin is not None:
        process.stdin.close()
    else:
        process.terminate()
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def wait_for(true: Callable[[], bool], limit_s: float, what: Callable[[], str]) -> None:
    deadline = time.monotonic() + limit_s
    while not true():
        assert time.monotonic() < deadline, what()
        time.sleep(0.05)
