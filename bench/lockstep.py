"""How fast simulated time runs through the mesh: the simulator without cameras, six robots without vision at 20 Hz.

`python -m bench.lockstep --json`
"""

import argparse
import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.pace import times_real_time
from console.places import free_port, generate_home

MEASURE_S = 10.0
DEVICES = 6


def measure() -> dict[str, Any]:
    with TemporaryDirectory(prefix="r2x-lockstep-") as folder:
        site_file = generate_home(
            1, Path(folder) / "site.toml", "--name", "lockstep", "--port", str(free_port()), "--view-port", str(free_port()),
            "--robots", str(DEVICES), "--no-cctv",
        )  # fmt: skip
        site_file.write_text(without_vision(site_file.read_text()))
        factor = times_real_time(site_file, warm_up_s=1.0, measure_s=MEASURE_S)
    return {"times_real_time": factor, "devices": DEVICES}


def without_vision(toml: str) -> str:
    """Robots that walk by lidar alone and a simulator that draws nothing; no view."""
    lines = toml.replace("[sim]\n", '[sim]\nrenderer = "none"\n').split("[[process]]")
    rows = [
        row.rstrip() + '\nargs = ["--no-vision"]\n' if 'module = "devices.quadruped"' in row else row
        for row in lines
        if 'module = "hub.view"' not in row
    ]
    return "[[process]]".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
