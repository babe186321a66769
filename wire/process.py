"""The shell of every process: arguments, site file, logging, signals, the node, and the loop that steps the core.

    if __name__ == "__main__":
        main(build)                     # build(site, process_id) -> Core

Exit codes: 0 stopped as asked, 1 a fault that the core or the mesh names in a sentence, 2 wrong arguments or site file,
70 a fault in the program, with its traceback.
"""

import argparse
import ctypes
import logging
import os
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType, TracebackType
from typing import NoReturn

from wire.bus import CannotRun, Core
from wire.clock import followers_of, owner_of
from wire.drive import drive_follower, drive_owner, drive_spectator, drive_wall
from wire.footprint import limit_arenas, release_startup_memory, settling
from wire.keys import FOLLOWERS, ROLES, Role
from wire.link import MeshError, link_for
from wire.node import ZenohNode
from wire.pulse import Pulse
from wire.site import Site, SiteError, load_site

log = logging.getLogger("process")

Build = Callable[..., Core]
"""build(site, process_id, **further arguments) -> Core; raises SiteError for what no restart mends, else CannotRun"""
EXIT_FAULT, EXIT_USAGE, EXIT_BUG = 1, 2, 70
SUPERVISED_VARIABLE = "R2X_SUPERVISED"
"""Set by a supervisor that leads its own session."""
_PR_SET_PDEATHSIG = 1


class StopFlag:
    """Set by SIGTERM and SIGINT; a second signal ends the process at once."""

    def __init__(self) -> None:
        self._set = False

    def __call__(self) -> bool:
        return self._set

    def install(self) -> None:
        signal.signal(signal.SIGTERM, self._on_signal)
        signal.signal(signal.SIGINT, self._on_signal)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        if self._set:
            os._exit(128 + number)
        self._set = True


def main(
    build: Build,
    add_arguments: Callable[[argparse.ArgumentParser], None] | None = None,
    role: Role | None = None,
    argv: Sequence[str] | None = None,
) -> NoReturn:
    """Run one process until it is stopped. What `add_arguments` adds reaches `build` as keyword arguments.

    `role` is for processes that need not stand in the site's process table.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--site", type=Path, required=True, help="the site file (TOML)")
    parser.add_argument("--id", required=True, help="this process in the site's process table")
    if add_arguments is not None:
        add_arguments(parser)
    arguments = vars(parser.parse_args(argv))
    limit_arenas()
    set_up_logging()
    stopping = StopFlag()
    stopping.install()
    die_with_parent()
    try:
        site = load_site(arguments.pop("site"))
        process = arguments.pop("id")
        process_role = role_of(site, process, role)
        core = build(site, process, **arguments)
    except SiteError as error:
        stop_with(EXIT_USAGE, error)
    except CannotRun as error:
        stop_with(EXIT_FAULT, error)
    try:
        run(site, process, process_role, core, stopping)
    except (CannotRun, MeshError, SiteError) as error:
        stop_with(EXIT_FAULT, error)
    sys.exit(0)


def run(site: Site, process: str, role: Role, core: Core, stopping: Callable[[], bool]) -> None:
    """Step the core on the mesh until `stopping`; then stop it and leave the mesh."""
    owner = owner_of(site)
    leads, follows = process == owner, bool(owner) and role in FOLLOWERS
    with ZenohNode(link_for(site, process), process, role, leads or follows, owner) as node:
        release_startup_memory()
        stopping = settling(stopping)
        pulse = Pulse(node)
        log.info("%s is on the mesh at %s", process, site.router.endpoint)
        try:
            if leads:
                drive_owner(node, core, pulse, stopping, site.clock.step_s, site.clock.speed, followers_of(site))
            elif follows:
                drive_follower(node, core, pulse, stopping)
            elif owner:
                drive_spectator(node, core, pulse, stopping, site.clock.step_s)
            else:
                drive_wall(node, core, pulse, stopping, site.clock.step_s)
        finally:
            core.stop()
    log.info("%s stopped", process)


def role_of(site: Site, process: str, role: Role | None) -> Role:
    for row in site.process:
        if row.id == process and row.role in ROLES:
            return row.role
    if role is not None:
        return role
    known = ", ".join(row.id for row in site.process if row.role in ROLES)
    raise SiteError(f"site {site.name} has no process {process!r}; its processes are {known}")


def set_up_logging() -> None:
    """One format, to stderr; a fault in the program is logged and exits with 70, whatever threads are left."""
    logging.basicConfig(
        stream=sys.stderr,
        level=logging.INFO,
        format="%(asctime)s %(name)s %(levelname)s %(message)s",
        datefmt="%H:%M:%S",
    )

    def on_bug(kind: type[BaseException], error: BaseException, at: TracebackType | None) -> None:
        log.critical("a fault in the program", exc_info=(kind, error, at))
        logging.shutdown()
        os._exit(EXIT_BUG)

    sys.excepthook = on_bug


def die_with_parent() -> None:
    """Have the kernel send SIGTERM when the parent dies, so that a killed supervisor leaves no orphans.

    It may have died while this process was still loading: a supervisor leads the session of its processes.
    """
    supervised = SUPERVISED_VARIABLE in os.environ
    parent = os.getsid(0) if supervised else os.getppid()
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:
        sys.exit("the parent process has died")


def stop_with(code: int, error: Exception) -> NoReturn:
    log.error("%s", error)
    sys.exit(code)
