"""How a process reaches the mesh: the router's endpoint, its name and password, and Zenoh's settings for it."""

import os
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wire.site import Site

LEASE_MS = 900
BLOCKED_READER_US = 3_000_000
"""The router cuts off a reader that takes nothing for this long while its queue is full: it would hold up all others."""
BLOCKED_ROUTER_US = 10_000_000
"""A sender waits longer for the router than the router for its slowest reader, and so keeps its own link."""
SOCKET_BYTES = 262_144
"""A sender that waits for a full socket is woken when a third of it is free. With the megabytes that the kernel gives by
itself, that takes a slow reader of small messages longer than a lease, and the link is taken for dead."""
MAX_MESSAGE_BYTES = 16_000_000
LEAN_RUNTIME = "(acc: (handover: tx), app: (handover: tx), net: (handover: tx))"
"""Zenoh's rare tasks in the thread that sends, where no callback of this program can hold it up: less switching between
threads. Only what is received keeps threads of its own, so that a blocked reader never stops the sending. For clients
alone: a router on a busy machine that lets many in at once waits in that thread for itself, and stops reading some."""
CREDENTIALS_VARIABLE = "R2X_CREDENTIALS"


class MeshError(Exception):
    """The mesh cannot be reached or entered; one sentence with the place and the remedy."""


@dataclass(frozen=True)
class Link:
    endpoint: str
    realm: str
    user: str = ""
    password: str = ""
    timeout_s: float = 10.0


def credentials_dir(site: Site) -> Path:
    """Where the names and passwords of a secured site lie on this machine."""
    return Path(os.environ.get(CREDENTIALS_VARIABLE) or Path(".run") / site.name / "credentials")


def link_for(site: Site, process: str, timeout_s: float = 10.0, credentials: Path | None = None) -> Link:
    """The link of one process of this site; `credentials` where its password lies elsewhere than usual."""
    if not site.router.secured:
        return Link(site.router.endpoint, site.realm, timeout_s=timeout_s)
    folder = credentials or credentials_dir(site)
    # a console's id is `console-<something>`; all of them share the user `console`
    candidates = (process, process.partition("-")[0])
    for user in candidates:
        file = folder / user
        if file.is_file():
            return Link(site.router.endpoint, site.realm, user, _password(file), timeout_s)
    raise MeshError(
        f"site {site.name} is secured and there is no password for {process} in {folder}; "
        f"start the mesh there, or set {CREDENTIALS_VARIABLE} to the folder with this host's passwords"
    )


def _password(file: Path) -> str:
    if stat.S_IMODE(file.stat().st_mode) & 0o077:
        raise MeshError(f"{file} can be read by others; `chmod 600 {file}` first")
    return file.read_text().strip()


def common_config(blocked_us: int = BLOCKED_READER_US) -> dict[str, Any]:
    """What routers and clients share. Without priorities, whatever is sent first arrives first: lockstep needs that."""
    return {
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "transport": {
            "unicast": {"qos": {"enabled": False}},
            "shared_memory": {"enabled": False},
            "link": {
                "protocols": ["tcp"],
                "tcp": {"so_sndbuf": SOCKET_BYTES, "so_rcvbuf": SOCKET_BYTES},
                "tx": {
                    "lease": LEASE_MS,
                    "keep_alive": 4,
                    "queue": {"congestion_control": {"block": {"wait_before_close": blocked_us}}},
                },
                "rx": {"max_message_size": MAX_MESSAGE_BYTES},
            },
        },
    }


def client_config(link: Link) -> dict[str, Any]:
    """A client of the one router: it listens on nothing and looks for nobody else."""
    config = common_config(BLOCKED_ROUTER_US)
    config["mode"] = "client"
    config["connect"] = {
        "endpoints": [link.endpoint],
        "timeout_ms": round(link.timeout_s * 1000),
        "exit_on_failure": True,
        "retry": {"period_init_ms": 100, "period_max_ms": 500, "period_increase_factor": 1.5},
    }
    config["listen"] = {"endpoints": []}
    if link.user:
        config["transport"]["auth"] = {"usrpwd": {"user": link.user, "password": link.password}}
    return config
