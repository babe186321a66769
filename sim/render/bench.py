"""Pictures per second and core, OpenGL against PyBullet: `python -m sim.render.bench --json`."""

import argparse
import json
import os
import sys
import time
from statistics import median
from typing import Any

import numpy as np

from sim.generator import make_home
from sim.models import parts
from sim.render.choose import make_renderer
from sim.render.picture import Camera, Renderer
from sim.render.still import ROBOTS, named_cameras
from sim.scene import Scene


def compare(scene: Scene, rounds: int) -> dict[str, Any]:
    """Processor time per 640x480 picture with ids for both renderers, and how far they agree about every pixel."""
    cameras = list(named_cameras(scene).values())
    pair = {name: make_renderer(scene, name, parts) for name in ("gl", "bullet")}
    for renderer in pair.values():
        for number, (start_m, yaw_rad) in enumerate(scene.robot_starts[:ROBOTS], start=1):
            renderer.set_robot(f"dog-{number}", (*start_m, 0.0), yaw_rad)
    equal = [_equal_part(pair["gl"], pair["bullet"], camera) for camera in cameras]
    cpu_s = {
        "gl": _cpu_per_picture_s(pair["gl"], cameras, rounds),
        "bullet": _cpu_per_picture_s(pair["bullet"], cameras, 1),
    }
    for renderer in pair.values():
        renderer.close()
    return {
        "seed": scene.seed,
        "pictures": f"640x480 colour and ids, {len(cameras)} views",
        "bodies": len(scene.bodies),
        "primitives": sum(len(parts(body)) for body in scene.bodies.values()),
        "gl_pictures_per_core_s": round(1.0 / cpu_s["gl"], 1),
        "bullet_pictures_per_core_s": round(1.0 / cpu_s["bullet"], 2),
        "ratio": round(cpu_s["bullet"] / cpu_s["gl"], 1),
        "equal_ids": round(float(np.mean(equal)), 5),
        "equal_ids_worst_view": round(float(np.min(equal)), 5),
    }


def _equal_part(one: Renderer, other: Renderer, camera: Camera) -> float:
    """Part of the pixels that both give to the same thing; also the warm-up."""
    ids, other_ids = (renderer.render(camera, with_ids=True).ids for renderer in (one, other))
    return float(np.mean(np.asarray(ids) == np.asarray(other_ids)))


def _cpu_per_picture_s(renderer: Renderer, cameras: list[Camera], rounds: int) -> float:
    """Median over the rounds, so that neighbours on the machine matter little."""
    spent = []
    for _ in range(rounds):
        start_s = time.process_time()
        for camera in cameras:
            renderer.render(camera, with_ids=True)
        spent.append((time.process_time() - start_s) / len(cameras))
    return median(spent)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="sim.render.bench", description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--json", action="store_true", help="one JSON object instead of lines")
    chosen = parser.parse_args(arguments)
    # Software OpenGL would spread over all cores; the figure is per core.
    os.environ["LP_NUM_THREADS"] = "1"
    figures = compare(make_home(chosen.seed), chosen.rounds)
    lines = [json.dumps(figures)] if chosen.json else [f"{name}: {value}" for name, value in figures.items()]
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
