"""Make training pictures: `python -m sim.training.frames --homes 1000-1099 --out DIR`. One shard for each home."""

import argparse
import logging
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from devices.vision.lens import Depth, Lens
from devices.vision.picture import encode_jpeg
from sim.generator import make_home
from sim.models import parts
from sim.render import Camera, make_renderer
from sim.render.picture import ROBOT_ID
from sim.training.labels import LABEL, Labels, label_picture
from sim.training.poses import cctv_lens, mast_lens
from sim.training.scenery import Scenery
from sim.training.shards import Shard, write_shard
from wire.site import Door, Wall

log = logging.getLogger("frames")
HELD_OUT = 9000
"""Homes from this seed on are never trained on."""


@dataclass(frozen=True)
class Shot:
    """One picture as a device gets it, and what is true of it."""

    camera: str
    """cctv, mast or home: a fixed camera or a robot's in a home in disorder, or a home's own camera."""
    jpeg: bytes
    depth_m: Depth
    lens: Lens
    labels: Labels
    walls: tuple[Wall, ...]
    doors: tuple[Door, ...]


class Studio:
    """A home and its renderer."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.scene = make_home(seed)
        self.renderer = make_renderer(self.scene, "auto", parts)
        self.scenery = Scenery(self.scene, self.renderer, self.rng)
        self._walls = tuple(Wall(start_m=w.start_m, end_m=w.end_m) for w in self.scene.walls)
        self._doors = tuple(Door(id=d.id, rooms=d.rooms, start_m=d.start_m, end_m=d.end_m) for d in self.scene.doors)
        self._taken = 0

    def shoot(self, camera: str, lens: Lens) -> Shot:
        """One picture of the home as it is."""
        view = Camera(
            lens.position_enu_m, lens.yaw_rad, lens.tilt_down_rad, lens.width_px, lens.height_px, lens.focal_px
        )
        picture = self.renderer.render(view, with_ids=True, with_depth=True)
        assert picture.ids is not None
        assert picture.depth_m is not None
        things = self.scenery.things(ROBOT_ID)
        labels = label_picture(picture.ids, picture.depth_m, lens, things, self._taken)
        self._taken += 1
        jpeg = encode_jpeg(picture.rgb, int(self.rng.integers(70, 96)))
        return Shot(camera, jpeg, picture.depth_m, lens, labels, self._walls, self._doors)


def shoot_home(seed: int, cctv: int, mast: int, tidy: int = 0) -> Iterator[Shot]:
    """Pictures of one home from both kinds of camera, half and half of the first `tidy` of the home as it is.

    For the others it is put in new disorder, every other time.
    """
    studio = Studio(seed)
    for number in range(tidy + cctv + mast):
        if number >= tidy and number % 2 == 0:
            studio.scenery.shuffle()
        elif number < tidy and number % 4 == 0:
            studio.scenery.place_robots()
        fixed = number % 2 == 0 if number < tidy else number < tidy + cctv
        lens = cctv_lens(studio.scene, studio.rng) if fixed else mast_lens(studio.scene, studio.rng)
        if lens is not None:
            yield studio.shoot("cctv" if fixed else "mast", lens)
    studio.renderer.close()


def shoot_tidy(seed: int) -> Iterator[Shot]:
    """A home as its generator left it, from its own cameras."""
    studio = Studio(seed)
    for pose in studio.scene.cameras:
        size = (pose.width_px, pose.height_px, pose.focal_px)
        yield studio.shoot("home", Lens(*size, pose.position_m, pose.yaw_rad, pose.tilt_down_rad))
    studio.renderer.close()


def render_home(seed: int, cctv: int, mast: int, tidy: int) -> Shard:
    """All of a home's pictures, to be kept."""
    shots = list(shoot_home(seed, cctv, mast, tidy))
    labels = np.concatenate([np.zeros(0, dtype=LABEL), *(shot.labels for shot in shots)])
    return Shard([shot.jpeg for shot in shots], [shot.lens for shot in shots], labels)


def span(text: str) -> range:
    """`1000-1099` or `1000` as a range of seeds."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--homes", type=span, required=True, help=f"seeds, below {HELD_OUT}")
    parser.add_argument("--cctv", type=int, default=24, help="pictures of fixed cameras in each home")
    parser.add_argument("--mast", type=int, default=20, help="pictures of a robot's camera in each home")
    parser.add_argument("--tidy", type=int, default=16, help="pictures of both in each home as it is")
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    if arguments.homes.stop > HELD_OUT:
        parser.error(f"homes from seed {HELD_OUT} on are held out for measuring; choose lower seeds")
    arguments.out.mkdir(parents=True, exist_ok=True)
    for seed in arguments.homes:
        path = arguments.out / f"home-{seed}.npz"
        if not path.exists():
            write_shard(path, render_home(seed, arguments.cctv, arguments.mast, arguments.tidy))
            log.info("%s", path)


if __name__ == "__main__":
    main()
