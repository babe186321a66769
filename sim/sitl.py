"""`python -m sim.sitl`: simulated drones by the wall clock, for any MAVLink ground station or library."""

import logging
import signal
import sys

from sim.sitl_options import parse


def main(argv: list[str] | None = None) -> int:
    options = parse(argv)
    # Only now, so that help and what is wrong with the arguments come at once and without PyBullet's own line.
    from sim.mavlink.links import LeavesMachine, LinkError
    from sim.sitl_flight import Sitl

    logging.basicConfig(level=logging.INFO, format="%(message)s")
    logging.getLogger("pymavlink").setLevel(logging.WARNING)
    try:
        sitl = Sitl(options)
    except LinkError as error:
        remedy = ": add --bind ADDRESS, its own there" if isinstance(error, LeavesMachine) else ""
        sys.stderr.write(f"error: {error}{remedy}\n")
        return 1
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, sitl.stop)
    try:
        sys.stdout.write("\n".join([*sitl.lines(), "ready; Ctrl-C ends it"]) + "\n")
        sys.stdout.flush()
        sitl.run()
    finally:
        sitl.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
