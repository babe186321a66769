"""How fast the demo's mesh runs when every picture is rendered, sent and looked at: 5 cameras, 3 robots, 2 Hz each.

`python -m bench.pixels --json`
"""

import argparse
import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.pace import times_real_time
from console.places import free_port, generate_home
from wire.site import load_site

MEASURE_S = 20.0
WARM_UP_S = 4.0
CAMERAS, ROBOTS = 5, 3


def measure() -> dict[str, Any]:
    with TemporaryDirectory(prefix="r2x-pixels-") as folder:
        site_file = _home_with(CAMERAS, Path(folder) / "site.toml")
        factor = times_real_time(site_file, WARM_UP_S, MEASURE_S)
    return {"times_real_time": factor, "cameras": CAMERAS, "robots": ROBOTS}


def _home_with(cameras: int, out: Path) -> Path:
    """The first home that has this many cameras."""
    for seed in range(100):
        generate_home(
            seed,
            out,
            "--name",
            "pixels",
            "--port",
            str(free_port()),
            "--view-port",
            str(free_port()),
            "--robots",
            str(ROBOTS),
        )
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
