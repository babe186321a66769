"""How much memory each process holds, and how long eight of them take to be there.

`python -m bench.footprint --json`
"""

import argparse
import json
import re
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.lockstep import without_vision
from console.bring_up import bring_up
from console.places import free_port, generate_home

SETTLE_S = 10.0
LIMIT_MB = {"hub": 100, "sim": 300, "cctv": 150, "robot": 150}
"""What each role's process must stay under, resident. Robots look at pictures here."""


def resident_mb(pid: int) -> float:
    """Resident set of a process."""
    found = re.search(r"VmRSS:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text())
    return int(found.group(1)) / 1024.0 if found else 0.0


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
                    "resident_mb": round(resident_mb(p.pid), 1),
                    "limit_mb": LIMIT_MB.get(roles[p.id]),
                }
                for p in ready.mesh.processes()
            ]
        finally:
            ready.mesh.stop()
    return {"processes": rows, "announced_s": round(ready.took_s, 2), "count": len(rows), **measure_light()}


def measure_light() -> dict[str, float]:
    """Eight processes without pictures: router, simulator, hub, planner and four robots that walk by lidar."""
    with TemporaryDirectory(prefix="r2x-footprint-") as folder:
        site_file = generate_home(
            1, Path(folder) / "site.toml", "--name", "light", "--port", str(free_port()), "--robots", "4", "--no-cctv"
        )
        site_file.write_text(without_vision(site_file.read_text()))
        ready = bring_up(site_file, quiet=True)
        try:
            time.sleep(2.0)
            robots = [resident_mb(p.pid) for p in ready.mesh.processes() if p.id.startswith("dog")]
        finally:
            ready.mesh.stop()
    return {"eight_announced_s": round(ready.took_s, 2), "robot_without_vision_mb": round(max(robots), 1)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
