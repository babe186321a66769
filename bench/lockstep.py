"""How fast simulated time runs through the mesh: the simulator without cameras, six robots without vision at 20 Hz.

Once with robots that stand and nobody asks for anything, which are the figures at the top; once with robots that are
sent from room to room by one task after the other. Beside them, before and after in the same run, the same exchange of
ticks with as many followers that do nothing, through the same router: what is over that is the work of this mesh.

`python -m bench.lockstep --json`
"""

import argparse
import json
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.children import DONE, TICK
from bench.errands import Errands
from bench.pace import Pace, pace
from bench.stage import stage
from console.places import free_port, generate_home
from wire.clock import followers_of
from wire.link import LEAN_RUNTIME, client_config, link_for
from wire.node import open_session
from wire.site import load_site

MEASURE_S = 10.0
STEP_S = 0.05
BARE_TICKS = 1000
DEVICES = 6


def measure() -> dict[str, Any]:
    with TemporaryDirectory(prefix="r2x-lockstep-") as folder:
        site_file = generate_home(
            1, Path(folder) / "site.toml", "--name", "lockstep", "--port", str(free_port()), "--view-port", str(free_port()),
            "--robots", str(DEVICES), "--no-cctv",
        )  # fmt: skip
        site_file.write_text(without_vision(site_file.read_text()))
        followers = len(followers_of(load_site(site_file)))
        bare_ms = bare_tick_ms(followers)
        standing = pace(site_file, warm_up_s=1.0, measure_s=MEASURE_S)
        errands = Errands()
        site_file.write_text(with_tours(site_file.read_text()))
        driving = pace(site_file, warm_up_s=1.0, measure_s=MEASURE_S, meanwhile=errands)
        bare_ms = (bare_ms + bare_tick_ms(followers)) / 2.0
    at_work = round(errands.robots_at_work(driving.simulated_s), 2)
    return {
        "devices": DEVICES,
        "followers": followers,
        "bare_tick_ms": bare_ms,
        **figures(standing, bare_ms),
        "driving": {"robots_at_work": at_work, "tasks": errands.tasks, **figures(driving, bare_ms)},
    }


def figures(mesh: Pace, bare_ms: float) -> dict[str, Any]:
    """Of one tick: its length on the wall, beside the bare exchange, and the processor time of every process."""
    tick_ms = 1000.0 * STEP_S / mesh.times_real_time
    cpu_ms = {id: round(1000.0 * STEP_S * share, 3) for id, share in sorted(mesh.cpu_share.items())}
    return {
        "times_real_time": mesh.times_real_time,
        "tick_ms": tick_ms,
        "over_bare": tick_ms / bare_ms,
        "cpu_ms_per_tick": cpu_ms,
        "cpu_ms_per_tick_sum": round(sum(cpu_ms.values()), 3),
    }


def bare_tick_ms(followers: int) -> float:
    """Mean time of one empty tick: told to all, answered by all."""
    with stage() as place:
        for _ in range(followers):
            place.child("bare_follower")
        with open_session(client_config(link_for(place.site, "hub")), LEAN_RUNTIME) as session:
            answers = session.declare_subscriber(f"{place.site.realm}/{DONE}/*")
            ticks = session.declare_publisher(f"{place.site.realm}/{TICK}")
            time.sleep(0.5)  # declarations travel on their own
            began = time.perf_counter()
            for _ in range(BARE_TICKS):
                ticks.put(b"x" * 32)
                for _ in range(followers):
                    answers.recv()
            return 1000.0 * (time.perf_counter() - began) / BARE_TICKS


def without_vision(toml: str) -> str:
    """Robots that walk by lidar alone and a simulator that draws nothing; no view."""
    lines = toml.replace("[sim]\n", '[sim]\nrenderer = "none"\n').split("[[process]]")
    rows = [
        row.rstrip() + '\nargs = ["--no-vision"]\n' if 'module = "devices.quadruped"' in row else row
        for row in lines
        if 'module = "hub.view"' not in row
    ]
    return "[[process]]".join(rows)


def with_tours(toml: str) -> str:
    """A planner that sends robots from room to room, whatever is asked. Raises ValueError where there is none."""
    planner = 'module = "planners"'
    if planner not in toml:
        raise ValueError(f"the generated site has no process with {planner}")
    return toml.replace(planner, 'module = "bench.tour"')


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.parse_args()
    print(json.dumps(measure(), indent=2, sort_keys=True))


if __name__ == "__main__":
    main()
