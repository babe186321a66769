"""How much memory each process holds, and how long eight of them take to be there.

Beside them stands a bare client: the same libraries and one open session, without a line of this project.

`python -m bench.footprint --json`
"""

import argparse
import json
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.lockstep import without_vision
from console.bring_up import bring_up
from console.places import free_port, generate_home
from wire.link import client_config, link_for
from wire.site import Site

SETTLE_S = 10.0
LIMIT_MB = {"hub": 100, "sim": 300, "cctv": 150, "robot": 150, "view": 450}
"""What each role's process must stay under, resident. Robots look at pictures here."""
_BARE = """
import json, sys
import msgpack, pydantic, zenoh

class Message(pydantic.BaseModel):
    stamp_s: float

session = zenoh.open(zenoh.Config.from_json5(sys.argv[1]))
Message.model_validate(msgpack.unpackb(msgpack.packb({"stamp_s": 0.0})))
print("ready", flush=True)
sys.stdin.read()
"""
"""A process of the three libraries that every process here stands on, and nothing else: the floor under each."""
_COUNTED = {"resident_mb": "Rss", "anonymous_mb": "Anonymous", "proportional_mb": "Pss"}


def memory(pid: int) -> dict[str, float]:
    """What a process holds: all that is mapped, of that its own, and all with shared pages split among their users.

    How much of a library is mapped beside what is used of it is up to the kernel and the page cache; the process's
    own memory is not.
    """
    text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    kilobytes = {key: int(value) for key, value in re.findall(r"^(\w+):\s+(\d+) kB", text, re.MULTILINE)}
    return {name: round(kilobytes[key] / 1024.0, 1) for name, key in _COUNTED.items()}


def measure(seed: int = 7) -> dict[str, Any]:
    """Bring a home up, let it look around for a while, read what each process holds."""
    with TemporaryDirectory(prefix="r2x-footprint-") as folder:
        site_file = generate_home(
            seed, Path(folder) / "site.toml", "--name", "footprint", "--port", str(free_port()), "--view-port", str(free_port())
        )  # fmt: skip
        ready = bring_up(site_file, quiet=True)
        try:
            time.sleep(SETTLE_S)  # pictures have been looked at by then: what is measured is memory in use
            roles = {p.id: p.role for p in ready.site.process}
            rows = [
                {
                    "id": p.id,
                    "role": roles[p.id],
                    **memory(p.pid),
                    "limit_mb": LIMIT_MB.get(roles[p.id]),
                }
                for p in ready.mesh.processes()
            ]
        finally:
            ready.mesh.stop()
    return {"processes": rows, "announced_s": round(ready.took_s, 2), "count": len(rows), **measure_light()}


def measure_light() -> dict[str, Any]:
    """Eight processes without pictures: router, simulator, hub, planner and four robots that walk by lidar."""
    with TemporaryDirectory(prefix="r2x-footprint-") as folder:
        site_file = generate_home(
            1, Path(folder) / "site.toml", "--name", "light", "--port", str(free_port()), "--robots", "4", "--no-cctv"
        )
        site_file.write_text(without_vision(site_file.read_text()))
        ready = bring_up(site_file, quiet=True)
        try:
            with bare_client(ready.site) as bare_pid:
                time.sleep(SETTLE_S)
                bare = memory(bare_pid)
                light = {p.id: memory(p.pid) for p in ready.mesh.processes()}
        finally:
            ready.mesh.stop()
    most = max((light[id] for id in light if id.startswith("dog")), key=lambda robot: robot["resident_mb"])
    return {
        "eight_announced_s": round(ready.took_s, 2),
        "robot_without_vision": most,
        "bare_client": bare,
        "light_processes": light,
    }


@contextmanager
def bare_client(site: Site) -> Iterator[int]:
    """The process id of a bare client of the site's router."""
    config = json.dumps(client_config(link_for(site, "console-bare")))
    with subprocess.Popen(
        [sys.executable, "-c", _BARE, config], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as child:
        assert child.stdout is not None
        if child.stdout.readline().strip() != "ready":
            raise RuntimeError("the bare client did not reach the router; what it says stands above")
        try:
            yield child.pid
        finally:
            child.kill()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
