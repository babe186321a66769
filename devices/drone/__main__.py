"""`python -m devices.drone --site FILE --id ROBOT`: one drone on the mesh."""

import argparse
from pathlib import Path

from devices.drone.client import MavsdkPilot
from devices.drone.core import DroneCore
from devices.drone.frame import frame_of
from devices.goals_journal import open_journal
from wire.process import main
from wire.site import Robot, Site, state_dir


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--journal",
        type=Path,
        help="where goals are remembered; <id>.sqlite in the state folder of the site by default",
    )


def build(site: Site, process_id: str, journal: Path | None = None) -> DroneCore:
    path = journal or state_dir(site) / f"{process_id}.sqlite"
    return DroneCore(site, process_id, open_journal(path), open_pilot)


def open_pilot(row: Robot) -> MavsdkPilot:
    return MavsdkPilot(row.link or "", frame_of(row), row.flight_height_m, row.id)


if __name__ == "__main__":
    main(build, add_arguments)
