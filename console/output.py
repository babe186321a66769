"""How commands speak: text for people, one JSON document with --json, one sentence for what went wrong."""

import json
from typing import Any, NoReturn, TypeVar

import typer
from pydantic import ValidationError
from rich.console import Console

from wire.faults import describe
from wire.model import Message

M = TypeVar("M", bound=Message)


class WordsError(ValueError):
    """What was typed cannot be sent: empty, too long, or no id; the text says what and why."""


terminal = Console(highlight=False, soft_wrap=True)


def emit(document: dict[str, Any], text: str, as_json: bool) -> None:
    """Print one answer: the document for programs or the text for people."""
    if as_json:
        print(json.dumps(document, indent=2, sort_keys=True))
    else:
        terminal.print(text, markup=False)


def checked(message: type[M], **fields: object) -> M:
    """The message with these fields; what a person typed wrong ends the command with one sentence."""
    try:
        return message(**fields)
    except ValidationError as error:
        raise WordsError(describe(error, message)) from None


def fail(sentence: str, as_json: bool = False, code: int = 1) -> NoReturn:
    """End with one clear sentence and a non-zero exit."""
    say_failure(sentence, as_json)
    raise typer.Exit(code)


def say_failure(sentence: str, as_json: bool) -> None:
    if as_json:
        print(json.dumps({"ok": False, "error": sentence}))
    else:
        typer.echo(f"error: {sentence}", err=True)
