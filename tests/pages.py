"""The code blocks of a page of docs/, for the tests that follow it."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def files(page: str) -> dict[str, str]:
    """File name -> text, of every block under a line that names a file: "`devices/lift/core.py`:"."""
    found = re.findall(r"^`([\w./]+)`:\n\n```\w+\n(.*?)^```$", _text(page), re.M | re.S)
    return dict(found)


def blocks(page: str, language: str) -> list[str]:
    """All blocks in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", _text(page), re.M | re.S)


def _text(page: str) -> str:
    return (ROOT / "docs" / page).read_text()
