"""`python -m hub --site FILE --id hub [--journal FILE]`."""

import argparse
from pathlib import Path

from hub.coordinator import build
from wire.process import main


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--journal",
        type=Path,
        default=None,
        help="what a restarted hub goes on from; <id>.sqlite in the state folder of the site by default",
    )


if __name__ == "__main__":
    main(build, _arguments)
