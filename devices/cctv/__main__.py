"""The process of one fixed camera: `python -m devices.cctv --site FILE --id cctv-1 [cam-1]`."""

import argparse

from devices.cctv.build import build
from wire.process import main


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("camera", nargs="?", help="the camera in the site file; cam-N for cctv-N when left out")


if __name__ == "__main__":
    main(build, add_arguments)
