"""A small mesh of real processes for the walk tests: a site file, a router, and cores that keep a diary.

`python -m tests.walk.mesh --site FILE --id ID --diary FILE` runs one of them.
"""

import argparse
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from tests.wire.cores import Clockwork, Diary, Gossip, Walker
from wire.bus import Core, Event, Node
from wire.process import main
from wire.site import Site, load_site

ROOT = Path(__file__).parents[2]
SITE = """
name = "walk"
[router]
endpoint = "tcp/127.0.0.1:{port}"
secured = {secured}
[clock]
mode = "{mode}"
speed = {speed}
[[room]]
id = "room"
name = "Room"
kind = "Other"
polygon_m = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]
"""
ROLES = {"router": "router", "sim": "sim", "hub": "hub", "dog-1": "robot", "dog-2": "robot"}


class Written:
    """Writes its core's diary to a file, line by line, so that nothing is lost when it is killed."""

    def __init__(self, core: Diary, file: Path) -> None:
        self._core = core
        self._file = file.open("a", buffering=1)
        self._written = 0

    def start(self, node: Node) -> None:
        self._core.start(node)

    def step(self, now_s: float, events: Sequence[Event]) -> None:
        self._core.step(now_s, events)
        self._flush()

    def stop(self) -> None:
        self._core.stop()
        self._flush()
        self._file.close()

    def _flush(self) -> None:
        self._file.writelines(f"{line}\n" for line in self._core.lines[self._written :])
        self._written = len(self._core.lines)


def core_for(role: str) -> Diary:
    return {"sim": Clockwork, "hub": Gossip, "robot": Walker}[role]()


def build(site: Site, process: str, diary: Path) -> Core:
    return Written(core_for(ROLES[process]), diary)


def end_all(processes: Iterable["subprocess.Popen[bytes]"], patience_s: float) -> None:
    """Wake, ask, and then kill: none is left. Frozen ones too."""
    running = list(processes)
    for process in running:
        if process.poll() is None:
            process.send_signal(signal.SIGCONT)
            process.terminate()
    for process in running:
        try:
            process.wait(patience_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


class WalkMesh:
    """Starts and ends the processes of one site in a folder."""

    def __init__(self, folder: Path, mode: str = "lockstep", secured: bool = False, speed: float = 0.0) -> None:
        self.folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        text = SITE.format(port=self.port, mode=mode, secured=str(secured).lower(), speed=speed)
        for id, role in ROLES.items():
            text += f'[[process]]\nid = "{id}"\nrole = "{role}"\nmodule = "tests.walk.mesh"\n'
        self.site_file = folder / "site.toml"
        self.site_file.write_text(text)
        self.site = load_site(self.site_file)
        self.processes: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> "WalkMesh":
        self.run("wire.router", "router")
        self.wait(lambda: "routing on" in self.log("router"))
        return self

    def __exit__(self, *_: object) -> None:
        end_all(self.processes.values(), patience_s=5)

    def run(self, module: str, id: str, *args: str) -> "subprocess.Popen[bytes]":
        with (self.folder / f"{id}.log").open("ab") as log:
            self.processes[id] = subprocess.Popen(
                self.command(module, id, *args), cwd=self.folder, env=self.environment, stdout=log, stderr=log
            )
        return self.processes[id]

    def command(self, module: str, id: str, *args: str) -> list[str]:
        return [sys.executable, "-m", module, "--site", str(self.site_file), "--id", id, *args]

    @property
    def environment(self) -> dict[str, str]:
        return {**os.environ, "PYTHONPATH": str(ROOT), "R2X_CREDENTIALS": str(self.folder / "credentials")}

    def run_core(self, id: str) -> None:
        self.run("tests.walk.mesh", id, "--diary", str(self.folder / f"{id}.diary"))

    def log(self, id: str) -> str:
        file = self.folder / f"{id}.log"
        return file.read_text() if file.exists() else ""

    def diary(self, id: str) -> list[str]:
        file = self.folder / f"{id}.diary"
        return file.read_text().splitlines() if file.exists() else []

    def end(self, id: str) -> int:
        self.processes[id].terminate()
        return self.processes[id].wait(10)

    @staticmethod
    def wait(true: Callable[[], bool], limit_s: float = 20.0) -> None:
        """Until the condition holds; fails after the limit."""
        deadline = time.monotonic() + limit_s
        while not true():
            assert time.monotonic() < deadline, "it did not come to pass in time"
            time.sleep(0.02)


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--diary", type=Path, required=True)


if __name__ == "__main__":
    main(build, _arguments)
