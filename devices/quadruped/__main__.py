"""`python -m devices.quadruped --site FILE --id ROBOT`: one robot on the mesh."""

import argparse
from pathlib import Path

from devices.goals_journal import open_journal
from devices.quadruped.core import QuadrupedCore
from devices.quadruped.look import Eyes
from wire.process import main
from wire.site import Site, state_dir


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--journal",
        type=Path,
        help="where goals are remembered; <id>.sqlite in the state folder of the site by default",
    )
    parser.add_argument("--no-vision", action="store_true", help="walk by the lidar only; saves 65 MB")


def build(site: Site, process_id: str, journal: Path | None = None, no_vision: bool = False) -> QuadrupedCore:
    path = journal or state_dir(site) / f"{process_id}.sqlite"
    eyes = None if no_vision else open_eyes(site, process_id)
    return QuadrupedCore(site, process_id, open_journal(path), eyes)


def open_eyes(site: Site, robot: str) -> Eyes:
    """Own perception with the shipped detector. Imported only here: a robot without vision does without its memory."""
    from devices.quadruped.eyes import PictureEyes
    from devices.vision.detector import EmbeddedDetector

    return PictureEyes(site, robot, EmbeddedDetector())


if __name__ == "__main__":
    main(build, add_arguments)
