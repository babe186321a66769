"""The operator's commands. Each is a few lines here; the work is in the module it calls."""

from collections.abc import Sequence
from typing import cast

import typer

from console import cost_commands, doctor_commands, mesh_commands, operate_commands, watch_commands
from console.output import say_failure

_UsageError = cast("type[typer.BadParameter]", typer.BadParameter.__base__)
"""Of all that can be typed wrong; typer does not export it."""
app = typer.Typer(add_completion=False, pretty_exceptions_enable=False, help="The R2X console.")
mesh_commands.register(app)
operate_commands.register(app)
watch_commands.register(app)
cost_commands.register(app)
doctor_commands.register(app)


def run(words: Sequence[str]) -> int:
    """One command line; returns the exit code. What was typed wrong is one sentence, and with --json a document."""
    try:
        return int(app(words, prog_name="justw", standalone_mode=False) or 0)
    except _UsageError as error:
        command = error.ctx.command_path if error.ctx is not None else "justw"
        say_failure(f"{error.format_message().removesuffix('.')} (`{command} --help` tells more)", "--json" in words)
        return error.exit_code
