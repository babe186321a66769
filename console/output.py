"""How commands speak: text for people, one JSON document with --json, one sentence for what went wrong."""

import json
from typing import Any, NoReturn

import typer
from rich.console import Console

terminal = Console(highlight=False, soft_wrap=True)


def emit(document: dict[str, Any], text: str, as_json: bool) -> None:
    """Print one answer: the document for programs or the text for people."""
    if as_json:
        print(json.dumps(document, indent=2, sort_keys=True))
    else:
        terminal.print(text, markup=False)


def fail(sentence: str, as_json: bool = False, code: int = 1) -> NoReturn:
    """End with one clear sentence and a non-zero exit."""
    if as_json:
        print(json.dumps({"ok": False, "error": sentence}))
    else:
        typer.echo(f"error: {sentence}", err=True)
    raise typer.Exit(code)
