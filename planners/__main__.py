"""`python -m planners --site FILE --id ID [--planner NAME]`."""

from argparse import ArgumentParser

from planners.core import build
from planners.planner import PLANNERS
from wire.process import main


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("--planner", choices=sorted(PLANNERS), help="instead of the site file's planner.name")


if __name__ == "__main__":
    main(build, add_arguments, role="planner")
