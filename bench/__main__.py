"""`python -m bench NAME [...]`: the experiments that compare configurations. `perf` measures the machine instead."""

import runpy
import signal
import sys

EXPERIMENTS = {"reasoning": "planners beside each other on the same episodes, over a model's error rate"}


def main() -> None:
    name = sys.argv[1] if len(sys.argv) > 1 else ""
    if name not in EXPERIMENTS:
        listed = "\n".join(f"  {known}: {about}" for known, about in EXPERIMENTS.items())
        known = name in ("", "-h", "--help")
        print(f"{'' if known else f'there is no experiment {name!r}; '}there are\n{listed}", file=sys.stderr)
        sys.exit(0 if known else 2)
    # Also where it was begun in the background, by a shell that has interrupts ignored there.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    sys.argv = sys.argv[1:]
    runpy.run_module(f"bench.{name}", run_name="__main__")


if __name__ == "__main__":
    main()
