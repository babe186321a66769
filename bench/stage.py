"""A router and child processes for one measurement, gone when it ends."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from console.places import free_port
from wire.access import write_credentials
from wire.link import CREDENTIALS_VARIABLE
from wire.site import Site, load_site

_SITE = """\
name = "bench"
[router]
endpoint = "tcp/127.0.0.1:{port}"
secured = {secured}
[clock]
mode = "wall"
[[room]]
id = "hall"
name = "hall"
kind = "Other"
polygon_m = [[0.0, 0.0], [8.0, 0.0], [8.0, 6.0], [0.0, 6.0]]
[[camera]]
id = "cam-1"
position_enu_m = [0.0, 0.0, 2.3]
yaw_deg = 45.0
tilt_down_deg = 30.0
width_px = 640
height_px = 480
focal_px = 320.0
[[robot]]
id = "dog-1"
kind = "quadruped"
start_m = [1.0, 1.0]
"""
_PROCESS = """\
[[process]]
id = "{id}"
role = "{role}"
module = "{module}"
"""
PROCESSES = (
    ("router", "router", "wire.router"),
    ("hub", "hub", "hub"),
    ("planner", "planner", "planners"),
    ("view", "view", "hub.view"),
    ("cctv-1", "cctv", "devices.cctv"),
    ("dog-1", "robot", "devices.quadruped"),
)


class Stage:
    """One site file in a folder of its own, and what runs on it."""

    def __init__(self, folder: Path, *, secured: bool) -> None:
        self.folder = folder
        self.site_file = folder / "site.toml"
        rows = "".join(_PROCESS.format(id=i, role=r, module=m) for i, r, m in PROCESSES)
        self.site_file.write_text(_SITE.format(port=free_port(), secured=str(secured).lower()) + rows)
        self.site: Site = load_site(self.site_file)
        os.environ[CREDENTIALS_VARIABLE] = str(folder / "credentials")
        write_credentials(self.site, folder / "credentials")
        self._running: list[subprocess.Popen[str]] = []

    def run(self, module: str, id: str) -> subprocess.Popen[str]:
        """Start one of the mesh's own processes."""
        return self._start([sys.executable, "-m", module, "--site", str(self.site_file), "--id", id])

    def child(self, name: str) -> subprocess.Popen[str]:
        """Start one of `bench.children` and wait until it is ready."""
        child = self._start([sys.executable, "-m", "bench.children", name, "--site", str(self.site_file)])
        assert child.stdout is not None
        if child.stdout.readline().strip() != "ready":
            raise RuntimeError(f"the child {name} did not start; see {self.folder}/stderr.log")
        return child

    def _start(self, command: list[str]) -> subprocess.Popen[str]:
        with (self.folder / "stderr.log").open("a") as log:
            child = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log, text=True, cwd=Path.cwd()
            )
        self._running.append(child)
        return child

    def close(self) -> None:
        for child in reversed(self._running):
            child.kill()
            child.wait()
            for stream in (child.stdin, child.stdout):
                if stream is not None:
                    stream.close()


@contextmanager
def stage(*, secured: bool = False) -> Iterator[Stage]:
    """A stage with its router running."""
    with TemporaryDirectory(prefix="r2x-bench-") as folder:
        place = Stage(Path(folder), secured=secured)
        try:
            place.run("wire.router", "router")
            yield place
        finally:
            place.close()
