"""The router process of a site: everybody else is its client, so that its access control cannot be walked around.

`python -m wire.router --site FILE --id router`
"""

import argparse
import logging
import select
import socket
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from wire.access import access_control, write_credentials
from wire.footprint import limit_arenas, settling
from wire.link import MeshError, common_config, credentials_dir
from wire.node import open_session
from wire.process import EXIT_USAGE, StopFlag, die_with_parent, set_up_logging, stop_with
from wire.site import Site, SiteError, load_site

log = logging.getLogger("router")


class PortError(Exception):
    """The router cannot listen where the site says."""


def router_config(site: Site) -> dict[str, Any]:
    config = common_config()
    config["mode"] = "router"
    config["listen"] = {"endpoints": [site.router.endpoint]}
    config["adminspace"] = {"enabled": False}
    config["timestamping"] = {"enabled": {"router": False, "peer": False, "client": False}}
    config["transport"]["unicast"] |= {"accept_pending": 1000, "accept_timeout": 1000, "max_sessions": 256}
    if site.router.secured:
        dictionary = write_credentials(site, credentials_dir(site))
        config["transport"]["auth"] = {"usrpwd": {"dictionary_file": str(dictionary.resolve())}}
        config["access_control"] = access_control(site)
    return config


def check_port(endpoint: str) -> None:
    """Raise PortError with one sentence when somebody else listens there."""
    host, _, port = endpoint.removeprefix("tcp/").rpartition(":")
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host.strip("[]"), int(port)))
        except OSError as error:
            raise PortError(
                f"the router cannot listen on {host}:{port} ({error.strerror}): stop what uses that port "
                f"(`ss -ltnp 'sport = :{port}'` names it), or set another one as router.endpoint in the site file"
            ) from None


def run(site: Site, stopping: Callable[[], bool]) -> None:
    check_port(site.router.endpoint)
    try:
        session = open_session(router_config(site))
    except MeshError as error:
        raise PortError(f"the router cannot listen on {site.router.endpoint}: {error}") from error
    with session:
        log.info("routing on %s, %s", site.router.endpoint, "secured" if site.router.secured else "open to everybody")
        while not stopping():
            select.select([], [], [], 0.2)
    log.info("router stopped")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--site", type=Path, required=True, help="the site file (TOML)")
    parser.add_argument("--id", default="router")
    arguments = parser.parse_args()
    set_up_logging()
    limit_arenas()
    stopping = StopFlag()
    stopping.install()
    die_with_parent()
    try:
        run(load_site(arguments.site), settling(stopping))
    except (SiteError, PortError) as error:
        stop_with(EXIT_USAGE, error)
    sys.exit(0)


if __name__ == "__main__":
    main()
