"""Which ports of this machine are taken, and by whom."""

import os
import socket
from pathlib import Path

from wire.site import Site, SiteError, load_site

_LISTENING = "0A"


def is_free(port: int, host: str = "127.0.0.1") -> bool:
    """Whether a server could listen there now."""
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except OSError:
            return False
    return True


def taken_ports(site: Site) -> str:
    """A sentence when somebody else has a port that a process of this site needs here; else nothing."""
    here = {process.role for process in site.process if process.host == "localhost" and process.autostart}
    host, _, port = site.router.endpoint.removeprefix("tcp/").rpartition(":")
    wanted = [("router", "router.endpoint", host.strip("[]"), int(port))]
    wanted.append(("view", "view.grpc_port", "127.0.0.1", site.view.grpc_port))
    taken = [
        f"port {number} ({place}) is taken by {holder(number)}"
        for role, place, address, number in wanted
        if role in here and not is_free(number, address)
    ]
    if not taken:
        return ""
    return f"{'; '.join(taken)}; stop that, or take other ports: `justw up --port N`, or in the site file"


def holder(port: int) -> str:
    """Who listens on a port, in words; a mesh by its name."""
    sockets = {f"socket:[{inode}]" for inode in _listening(port)}
    for process in Path("/proc").glob("[0-9]*"):
        if sockets & _open_sockets(process):
            return _described(process)
    return f"another user's program (`sudo ss -ltnp 'sport = :{port}'` names it)"


def _listening(port: int) -> set[str]:
    """Inodes of the sockets that listen on a port."""
    found = set()
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        rows = Path(table).read_text().splitlines()[1:] if Path(table).exists() else []
        for _, local, _, state, *rest in (row.split() for row in rows):
            if state == _LISTENING and int(local.rpartition(":")[2], 16) == port:
                found.add(rest[5])
    return found


def _open_sockets(process: Path) -> set[str]:
    """What its descriptors point to; nothing of a process that has ended or is another user's."""
    links = set()
    try:
        for descriptor in (process / "fd").iterdir():
            links.add(os.readlink(descriptor))
    except OSError:
        return links
    return links


def _described(process: Path) -> str:
    try:
        words = (process / "cmdline").read_text(errors="replace").split("\0")
    except OSError:
        return f"process {process.name}, which has just ended"
    if "--site" in words[:-1]:
        file = Path(words[words.index("--site") + 1])
        try:
            return f"the mesh of {load_site(file).name}, which runs from {file.parent}"
        except SiteError:
            return f"a mesh with the site file {file}"
    return f"`{' '.join(words).strip()[:120]}` (process {process.name})"
