"""`python -m console`: the operator's commands."""

import signal

from console.app import app

if __name__ == "__main__":
    # Whoever ends a command, or the terminal that it runs in, means what Ctrl-C means: nothing is left behind.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.default_int_handler)
    app(prog_name="justw")
