"""Runs a site's processes on this machine under supervision: start, stop, status, restart, logs.

The supervisor is `supervisord`, its configuration rendered from the site file's process table. Every process asks the
kernel to be stopped when its parent dies (`wire.process`), so that a killed supervisor leaves no orphans.
"""

import hashlib
import os
import subprocess
import sys
import tempfile
import time
import xmlrpc.client
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from supervisor.xmlrpc import SupervisorTransport

from deploy.modules import missing_modules
from deploy.ports import taken_ports
from deploy.supervisord import Places, render
from wire.access import write_credentials
from wire.site import Site

UP_STATES = ("STARTING", "RUNNING", "BACKOFF")


class LaunchError(RuntimeError):
    """The mesh cannot be started, reached or stopped; one sentence with the remedy."""


@dataclass(frozen=True)
class ProcessInfo:
    """What the supervisor knows of one process."""

    id: str
    state: str
    pid: int
    up_s: float
    cpu_s: float
    """Processor time so far."""
    exit_code: int
    text: str


class Mesh:
    """The supervised processes of one site, found again through their run directory."""

    def __init__(self, run_dir: Path) -> None:
        self.run_dir = run_dir.resolve()
        # A unix socket's path is limited to 107 bytes; the run directory may lie deep.
        name = hashlib.sha256(str(self.run_dir).encode()).hexdigest()[:12]
        self._socket_dir = Path(tempfile.gettempdir()) / f"r2x-{os.getuid()}-{name}"

        self._old_log_bytes: dict[str, int] = {}

    @property
    def site_file(self) -> Path:
        return self.run_dir / "site.toml"

    @property
    def log_dir(self) -> Path:
        return self.run_dir / "log"

    @property
    def credentials_dir(self) -> Path:
        return self.run_dir / "credentials"

    @property
    def _socket(self) -> Path:
        return self._socket_dir / "supervisor.sock"

    def start(self, site: Site) -> None:
        """Start every `autostart` process of the site whose host is this one."""
        if self.is_up():
            raise LaunchError(f"a mesh already runs from {self.run_dir}; `justw down` stops it")
        if fault := missing_modules(site) or taken_ports(site):
            raise LaunchError(fault)
        self.log_dir.mkdir(parents=True, exist_ok=True)
        self._socket_dir.mkdir(mode=0o700, exist_ok=True)
        self._socket.unlink(missing_ok=True)
        write_credentials(site, self.credentials_dir)  # before anybody looks for its password
        self._old_log_bytes = {file.stem: file.stat().st_size for file in self.log_dir.glob("*.log")}
        config = self.run_dir / "supervisord.conf"
        places = Places(self.site_file, self.run_dir, self._socket, self.credentials_dir, sys.executable)
        config.write_text(render(site, places))
        done = subprocess.run(
            [sys.executable, "-m", "supervisor.supervisord", "-c", str(config)],
            capture_output=True, text=True, check=False, env={**os.environ, "PYTHONWARNINGS": "ignore"},
        )  # fmt: skip
        if done.returncode != 0:
            raise LaunchError(f"the supervisor did not start: {(done.stderr or done.stdout).strip()[-300:]}")
        self._wait_for_supervisor()

    def _wait_for_supervisor(self, limit_s: float = 10.0) -> None:
        deadline = time.monotonic() + limit_s
        while not self.is_up():
            if time.monotonic() > deadline:
                raise LaunchError(f"the supervisor did not answer within {limit_s:.0f} s; see {self.run_dir}")
            time.sleep(0.05)

    def is_up(self) -> bool:
        if not self._socket.exists():
            return False
        try:
            return bool(self._ask("getState")["statename"] == "RUNNING")
        except (OSError, xmlrpc.client.Error):
            return False

    def processes(self) -> list[ProcessInfo]:
        rows = self._call("getAllProcessInfo")
        return [
            ProcessInfo(
                id=row["name"], state=row["statename"], pid=row["pid"],
                up_s=float(row["now"] - row["start"]) if row["statename"] == "RUNNING" else 0.0,
                cpu_s=_cpu_s(row["pid"]), exit_code=row["exitstatus"],
                text=row["description"] or row["spawnerr"],
            )
            for row in rows
        ]  # fmt: skip

    def last_words(self, name: str) -> str:
        """The last line that a process has logged since the start of this mesh."""
        log = self.log_dir / f"{name}.log"
        if not log.exists():
            return ""
        with log.open(errors="replace") as stream:
            stream.seek(self._old_log_bytes.get(name, 0))
            return "".join(stream.read().strip().splitlines()[-1:])

    def restart(self, name: str) -> None:
        self._known(name)
        if self._state(name) in UP_STATES:
            self._call("stopProcess", name, True)
        self._call("startProcess", name, True)

    def stop_process(self, name: str) -> None:
        self._known(name)
        self._call("stopProcess", name, True)

    def stop(self, limit_s: float = 20.0) -> list[ProcessInfo]:
        """Stop everything, the supervisor last; returns how each process ended."""
        self._call("stopAllProcesses", True)
        ended = self.processes()
        self._call("shutdown")
        deadline = time.monotonic() + limit_s
        while self.is_up() and time.monotonic() < deadline:
            time.sleep(0.05)
        return ended

    def _state(self, name: str) -> str:
        row = self._call("getProcessInfo", name)
        return str(row["statename"])

    def _known(self, name: str) -> None:
        names = [p.id for p in self.processes()]
        if name not in names:
            raise LaunchError(f"no process '{name}' in this mesh; there are: {', '.join(sorted(names))}")

    def _ask(self, method: str, *args: object) -> Any:
        transport = SupervisorTransport(None, None, f"unix://{self._socket}")
        with xmlrpc.client.ServerProxy("http://127.0.0.1", transport=transport) as proxy:
            return getattr(proxy.supervisor, method)(*args)

    def _call(self, method: str, *args: object) -> Any:
        if not self._socket.exists():
            raise LaunchError(f"no mesh runs from {self.run_dir}; `justw up` starts one")
        try:
            return self._ask(method, *args)
        except xmlrpc.client.Fault as fault:
            raise LaunchError(
                f"the supervisor refused {method} {' '.join(map(str, args))}: {fault.faultString}"
            ) from None
        except OSError:
            raise LaunchError(f"no mesh runs from {self.run_dir} any more; `justw up` starts one") from None


def _cpu_s(pid: int) -> float:
    """Processor time of a process so far; 0 for one that has ended."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
