"""`python -m tests.ollama_double --port N [--scenario busy,busy,ok] [--replies FILE | --dial invented_id=0.1 ...]`.

Serves until Ctrl-C at 127.0.0.1. Nothing of what it says comes from a model, and it says so: the family of its models is
`stand-in`.
"""

import argparse
import sys
from pathlib import Path

from tests.ollama_double.brain import Brain, emulated
from tests.ollama_double.dials import dials_from
from tests.ollama_double.replay import read_replies
from tests.ollama_double.scenarios import SCENARIOS, Sequence
from tests.ollama_double.server import State, serve


def _arguments() -> argparse.Namespace:
    scenarios = "; ".join(f"{name}: {about}" for name, about in SCENARIOS.items())
    parser = argparse.ArgumentParser(
        prog="ollama-double", description="A stand-in for an Ollama server, without a model."
    )
    parser.add_argument("--port", type=int, default=11434)
    parser.add_argument("--scenario", default="ok", help=f"one or a sequence with commas. {scenarios}")
    parser.add_argument("--replies", type=Path, help="hand-written replies (TOML) instead of the emulated planner")
    parser.add_argument("--dial", action="append", default=[], help="an error of the emulated planner: NAME=RATE")
    parser.add_argument("--seed", type=int, default=0, help="of those errors")
    parser.add_argument("--cold-load-s", type=float, default=0.0, help="how long the first use of a model takes")
    parser.add_argument("--token-s", type=float, default=0.0, help="how long each piece of an answer takes")
    parser.add_argument("--largest-context", type=int, default=1_000_000, help="no more is allocated")
    return parser.parse_args()


def main() -> None:
    arguments = _arguments()
    try:
        dials = dials_from(arguments.dial, arguments.seed)
        brain: Brain = read_replies(arguments.replies) if arguments.replies else emulated(dials)
        state = State(
            brain,
            Sequence(arguments.scenario),
            cold_load_s=arguments.cold_load_s,
            token_s=arguments.token_s,
            largest_context=arguments.largest_context,
        )
        server = serve(state, arguments.port)
    except (ValueError, OSError, OverflowError) as error:
        sys.exit(f"error: {error}")
    port = server.server_address[1]
    models = ", ".join(model.name for model in state.models)
    sys.stdout.write(
        f"a stand-in for Ollama at http://127.0.0.1:{port}, without a model; it answers as {models}\n"
        f"tokens are counted by {state.counter.name}; Ctrl-C ends it\n"
    )
    sys.stdout.flush()
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        server.server_close()


if __name__ == "__main__":
    main()
