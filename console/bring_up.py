"""Starts a mesh and waits, with progress, until every process has announced itself."""

import time
from dataclasses import dataclass
from pathlib import Path

from console.client import Client, ClientError
from console.output import terminal
from console.places import install_site
from deploy.launch import LaunchError, Mesh
from wire.site import Site

_LIMIT_S = 60.0
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
    wanted = {p.id for p in site.process if p.autostart and p.role != "router" and p.host == "localhost"}
    deadline = time.monotonic() + _LIMIT_S
    with _connect(site, mesh, deadline) as client:
        here = client.present(0.05)
        while missing := wanted - here:
            _look_for_failures(mesh)
            if time.monotonic() > deadline:
                raise LaunchError(
                    f"not announced within {_LIMIT_S:.0f} s: {', '.join(sorted(missing))}; `justw logs` tells more"
                )
            before = here
            here = client.update_presence(here)
            if not quiet:
                for name in sorted((here - before) & wanted):
                    terminal.print(f"  {name} is there", markup=False)


def _connect(site: Site, mesh: Mesh, deadline: float) -> Client:
    """A client, as soon as the router takes one."""
    while True:
        client = Client(site, mesh.credentials_dir, timeout_s=1.0)
        try:
            client.__enter__()
        except ClientError as error:
            _look_for_failures(mesh)
            if time.monotonic() > deadline:
                raise LaunchError(str(error)) from None
        else:
            client.__exit__(None, None, None)
            return Client(site, mesh.credentials_dir)


def _look_for_failures(mesh: Mesh) -> None:
    """Raise with the last words of a process that the supervisor has given up."""
    for process in mesh.processes():
        if process.state in _GIVEN_UP:
            code = f" with code {process.exit_code}" if process.exit_code else ""
            raise LaunchError(f"{process.id} ended{code}: {mesh.last_words(process.id) or process.text}")
