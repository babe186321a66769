"""The operator's commands. Each is a few lines here; the work is in the module it calls."""

import typer

from console import mesh_commands, operate_commands, watch_commands

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False, help="The R2X console.")
mesh_commands.register(app)
operate_commands.register(app)
watch_commands.register(app)
