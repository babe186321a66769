"""How fast simulated time runs through the mesh: the simulator without cameras, six robots without vision at 20 Hz.

`python -m bench.lockstep --json`
"""

import argparse
import json
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from console.bring_up import bring_up
from console.client import Client
from console.places import free_port, generate_home
from wire.messages.truth import JudgeReply, JudgeRequest

MEASURE_S = 10.0
DEVICES = 6


def measure() -> dict[str, Any]:
    with TemporaryDirectory(prefix="r2x-lockstep-") as folder:
        site_file = generate_home(
            1, Path(folder) / "site.toml", "--name", "lockstep", "--port", str(free_port()), "--view-port", str(free_port()),
            "--robots", str(DEVICES), "--no-cctv",
        )  # fmt: skip
        site_file.write_text(without_vision(site_file.read_text()))
        ready = bring_up(site_file, quiet=True)
        try:
            with Client(ready.site, ready.mesh.credentials_dir, "evaluator") as evaluator:
                began, before_s = time.monotonic(), evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
                time.sleep(MEASURE_S)
                after_s = evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
                took_s = time.monotonic() - began
        finally:
            ready.mesh.stop()
    return {"times_real_time": (after_s - before_s) / took_s, "devices": DEVICES, "simulated_s": after_s - before_s}


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
