"""Starts a mesh and waits, with progress, until every process has announced itself."""

import time
from dataclasses import dataclass
from pathlib import Path

from console.client import Client, ClientError
from console.output import terminal
from console.patience import QUIET_S, Patience
from console.places import install_site
from deploy.launch import LaunchError, Mesh, ProcessInfo
from wire.site import Site

_SAY_S = 10.0
_GIVEN_UP = ("FATAL", "EXITED", "UNKNOWN")


@dataclass(frozen=True)
class Ready:
    """A mesh whose processes are all there."""

    site: Site
    mesh: Mesh
    took_s: float


def bring_up(site_file: Path, quiet: bool) -> Ready:
    """Start the site's processes. On a fault everything is stopped again. Raises SiteError, LaunchError."""
    site, mesh = install_site(site_file)
    began = time.monotonic()
    try:
        mesh.start(site)
        _wait_for_all(site, mesh, quiet)
    except ClientError as error:
        stop_if_up(mesh)
        raise LaunchError(str(error)) from None
    except (LaunchError, KeyboardInterrupt):
        stop_if_up(mesh)
        raise
    return Ready(site, mesh, time.monotonic() - began)


def stop_if_up(mesh: Mesh) -> None:
    if mesh.is_up():
        mesh.stop()


def _wait_for_all(site: Site, mesh: Mesh, quiet: bool) -> None:
    wait = _Wait(site, mesh, quiet)
    with wait.connect() as client:
        here = client.present(0.05) | wait.routers
        while wait.goes_on(here):
            here = client.update_presence(here)


class _Wait:
    """What is waited for, and what is said meanwhile."""

    def __init__(self, site: Site, mesh: Mesh, quiet: bool) -> None:
        self._site, self._mesh, self._quiet = site, mesh, quiet
        self.routers = {p.id for p in site.process if p.role == "router"}
        """They announce nothing: who takes a client is there."""
        self._wanted = {p.id for p in site.process if p.autostart and p.host == "localhost"}
        self._began_s = self._said_s = time.monotonic()
        self._patience = Patience(self._began_s)
        self._shown: set[str] = set()

    def connect(self) -> Client:
        """A client, as soon as the router takes one."""
        while True:
            client = Client(self._site, self._mesh.credentials_dir, timeout_s=1.0)
            try:
                client.__enter__()
            except ClientError:
                self.goes_on(set())
            else:
                client.__exit__(None, None, None)
                return Client(self._site, self._mesh.credentials_dir)

    def goes_on(self, here: set[str]) -> bool:
        """Whether somebody is still missing. Raises LaunchError when one has failed, or waiting is in vain."""
        now_s = time.monotonic()
        self._say(here, now_s)
        missing = self._wanted - here
        processes = self._mesh.processes()
        _look_for_failures(self._mesh, processes)
        if missing and self._patience.over(here, [p for p in processes if p.id in missing], now_s):
            first = min(missing)
            raise LaunchError(
                f"{', '.join(sorted(missing))} did not announce themselves, and nothing has moved for {QUIET_S:.0f} s; "
                f"`justw logs {first}` tells more. Everything was stopped again"
            )
        return bool(missing)

    def _say(self, here: set[str], now_s: float) -> None:
        """Who has come, and when that takes long, who is waited for."""
        fresh = (here & self._wanted) - self._shown
        self._shown |= fresh
        lines = [f"  {name} is there" for name in sorted(fresh)]
        if fresh:
            self._said_s = now_s
        elif now_s - self._said_s > _SAY_S:
            self._said_s = now_s
            missing = ", ".join(sorted(self._wanted - here))
            lines = [f"  waiting for {missing} ({now_s - self._began_s:.0f} s so far)"]
        for line in lines if not self._quiet else ():
            terminal.print(line, markup=False)


def _look_for_failures(mesh: Mesh, processes: list[ProcessInfo]) -> None:
    """Raise with the last words of a process that the supervisor has given up."""
    for process in processes:
        if process.state in _GIVEN_UP:
            code = f" with code {process.exit_code}" if process.exit_code else ""
            raise LaunchError(f"{process.id} ended{code}: {mesh.last_words(process.id) or process.text}")
