"""`python -m sim.generator --seed N --out FILE`: the site file of a generated home."""

import argparse
import sys
import tomllib
from pathlib import Path

from sim.generator.home import make_home
from sim.generator.site_file import MAVLINK_PORT, Options, read_fault, write_site
from wire.site import parse_site


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m sim.generator", description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="which home (0 or more)")
    parser.add_argument("--out", type=Path, default=None, help="file to write; standard output when left out")
    parser.add_argument("--name", default=None, help="the site's name; home-N when left out")
    parser.add_argument("--robots", type=int, default=3)
    parser.add_argument("--drones", type=int, default=0)
    parser.add_argument(
        "--firmware", choices=("ardupilot", "px4"), default="ardupilot", help="of the drones' autopilots"
    )
    parser.add_argument("--mavlink-port", type=int, default=MAVLINK_PORT, help="of the first drone")
    parser.add_argument("--spread", action="store_true", help="robots begin all over the home, not side by side")
    parser.add_argument("--no-cctv", dest="cctv", action="store_false", help="leave the fixed cameras out")
    parser.add_argument("--clock", choices=("lockstep", "wall"), default="lockstep")
    parser.add_argument("--planner", default="scripted")
    parser.add_argument("--port", type=int, default=7447, help="of the router")
    parser.add_argument("--view-port", type=int, default=9876, help="where live viewers connect")
    parser.add_argument("--save", default="", help="file that the view records to")
    parser.add_argument("--smart-appliances", action="store_true", help="appliances report their own state")
    parser.add_argument(
        "--fault",
        action="append",
        default=[],
        metavar="DEVICE:KIND[:VALUE]",
        help="what goes wrong on purpose, once for each: cam-1:frame_loss:0.3, cam-1:delay:0.5, "
        "television-1:wrong_state:isToggled",
    )
    arguments = vars(parser.parse_args(argv))
    seed, out = arguments.pop("seed"), arguments.pop("out")
    if seed < 0:
        parser.exit(2, f"error: --seed {seed}: give 0 or more\n")
    try:
        faults = tuple(read_fault(text) for text in arguments.pop("fault"))
        text = write_site(make_home(seed), Options(faults=faults, **arguments))
        parse_site(tomllib.loads(text), "the options")
        if out is None:
            sys.stdout.write(text)
        else:
            out.parent.mkdir(parents=True, exist_ok=True)
            out.write_text(text)
    except ValueError as error:
        parser.exit(2, f"error: {error}\n")
    except OSError as error:
        parser.exit(1, f"error: {error.filename}: cannot be written: {error.strerror}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
