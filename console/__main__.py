"""`python -m console`: the operator's commands."""

import signal
import sys

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # while nothing has begun, there is nothing to say about its end
    from console.app import run

    # Whoever ends a command, or the terminal that it runs in, means what Ctrl-C means: nothing is left behind.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    sys.exit(run(sys.argv[1:]))
