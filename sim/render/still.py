"""A picture of a generated home: `python -m sim.render.still --seed 0 --camera cam-1 --out room.png`."""

import argparse
import sys
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from sim.generator import make_home
from sim.models import parts
from sim.render.choose import make_renderer
from sim.render.picture import Camera, Renderer
from sim.render.robot import CAMERA_FORWARD_M, CAMERA_HEIGHT_M
from sim.scene import Scene
from wire.catalogue import PROP_FLAG, catalogue
from wire.frames import body_to_enu

MAST_TILT_RAD = 0.45
MAST_TURNS = 3
ROBOTS = 2


def named_cameras(scene: Scene) -> dict[str, Camera]:
    """The fixed cameras, and a robot's mast at each start looking round in thirds (`mast-1a`, `mast-1b`, ...)."""
    found = {pose.id: Camera.fixed(pose) for pose in scene.cameras}
    for number, (start_m, yaw_rad) in enumerate(scene.robot_starts[:ROBOTS], start=1):
        for turn in range(MAST_TURNS):
            heading_rad = yaw_rad + turn * 2.0 * np.pi / MAST_TURNS
            eye_m = body_to_enu((CAMERA_FORWARD_M, 0.0, CAMERA_HEIGHT_M), (*start_m, 0.0), heading_rad)
            camera = Camera(eye_m, heading_rad, MAST_TILT_RAD, 640, 480, 320.0, f"dog-{number}")
            found[f"mast-{number}{'abc'[turn]}"] = camera
    return found


def take(renderer: Renderer, scene: Scene, cameras: list[Camera]) -> list[NDArray[np.uint8]]:
    """Pictures with the robots at their starts; a mast's own robot turns with it."""
    stills = []
    for camera in cameras:
        for number, (start_m, yaw_rad) in enumerate(scene.robot_starts[:ROBOTS], start=1):
            own = camera.carrier == f"dog-{number}"
            renderer.set_robot(f"dog-{number}", (*start_m, 0.0), camera.yaw_rad if own else yaw_rad)
        stills.append(renderer.render(camera).rgb)
    return stills


def set_everywhere(scene: Scene, prop: str) -> None:
    """Open, switch on, soil or slice all that can be."""
    for body in scene.bodies.values():
        if catalogue()[body.type].can(PROP_FLAG[prop]):
            body.props[prop] = True


def sheet(stills: list[NDArray[np.uint8]], labels: list[str], across: int = 3) -> NDArray[np.uint8]:
    """Pictures side by side, each with its name."""
    tiles = []
    for still, label in zip(stills, labels, strict=True):
        tile = still.copy()
        cv2.putText(tile, label, (8, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, (0, 0, 0), 4, cv2.LINE_AA)
        cv2.putText(tile, label, (8, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, (255, 255, 255), 1, cv2.LINE_AA)
        tiles.append(tile)
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % across)
    return np.vstack([np.hstack(tiles[i : i + across]) for i in range(0, len(tiles), across)])


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="sim.render.still", description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--camera", default="cam-1", help="cam-1, cam-2, ... or mast-1a, mast-1b, mast-1c, mast-2a, ..."
    )
    parser.add_argument("--contact-sheet", action="store_true", help="all cameras in one picture")
    parser.add_argument("--set", action="append", default=[], choices=sorted(PROP_FLAG), help="true wherever it can be")
    parser.add_argument("--renderer", default="auto", choices=("auto", "gl", "bullet"))
    parser.add_argument("--out", type=Path, required=True)
    chosen = parser.parse_args(arguments)
    scene = make_home(chosen.seed)
    for prop in chosen.set:
        set_everywhere(scene, prop)
    cameras = named_cameras(scene)
    names = list(cameras) if chosen.contact_sheet else [chosen.camera]
    if not set(names) <= set(cameras):
        parser.error(f"no camera {chosen.camera} in home {chosen.seed}; there are {', '.join(cameras)}")
    renderer = make_renderer(scene, chosen.renderer, parts)
    stills = take(renderer, scene, [cameras[name] for name in names])
    renderer.close()
    image = sheet(stills, names) if chosen.contact_sheet else stills[0]
    if not cv2.imwrite(str(chosen.out), image[..., ::-1]):
        parser.error(f"cannot write {chosen.out}; give a file in an existing folder that ends in .png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
