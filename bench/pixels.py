"""How fast the demo's mesh runs when every picture is rendered, sent and looked at: 5 cameras, 3 robots, 2 Hz each.

`python -m bench.pixels --json`
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
from wire.site import load_site

MEASURE_S = 20.0
WARM_UP_S = 4.0
CAMERAS = 5


def measure() -> dict[str, Any]:
    with TemporaryDirectory(prefix="r2x-pixels-") as folder:
        site_file = _home_with(CAMERAS, Path(folder) / "site.toml")
        ready = bring_up(site_file, quiet=True)
        try:
            with Client(ready.site, ready.mesh.credentials_dir, "evaluator") as evaluator:
                time.sleep(WARM_UP_S)
                began, before_s = time.monotonic(), evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
                time.sleep(MEASURE_S)
                after_s = evaluator.ask("judge", JudgeRequest(), JudgeReply).sim_s
                took_s = time.monotonic() - began
        finally:
            ready.mesh.stop()
    return {"times_real_time": (after_s - before_s) / took_s, "cameras": CAMERAS, "robots": len(ready.site.robot)}


def _home_with(cameras: int, out: Path) -> Path:
    """The first home that has this many cameras."""
    for seed in range(100):
        generate_home(seed, out, "--name", "pixels", "--port", str(free_port()), "--view-port", str(free_port()))
        if len(load_site(out).camera) == cameras:
            return out
    raise LookupError(f"no home of the first hundred has {cameras} cameras")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
