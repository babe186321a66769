"""Hand-written replies from a file, chosen by a piece of the prompt.

[[reply]]
prompt = "turn off every TV"         # the first entry whose piece stands in the prompt answers
text = '{"goals": []}'
"""

import tomllib
from pathlib import Path

from tests.ollama_double.brain import NOTHING_TO_SAY, ChatRequest


class Replay:
    """See tests.ollama_double.brain.Brain."""

    def __init__(self, replies: list[tuple[str, str]]) -> None:
        self._replies = replies

    def reply(self, request: ChatRequest) -> str:
        found = (text for piece, text in self._replies if piece in request.prompt)
        return next(found, NOTHING_TO_SAY)


def read_replies(file: Path) -> Replay:
    """Raises ValueError with one sentence when the file is not what it should be."""
    try:
        rows = tomllib.loads(file.read_text()).get("reply", [])
        replies = [(str(row["prompt"]), str(row["text"])) for row in rows]
    except (OSError, tomllib.TOMLDecodeError, TypeError, KeyError) as error:
        raise ValueError(f"{file}: [[reply]] tables with prompt and text are expected: {error!r}") from None
    if not replies:
        raise ValueError(f"{file}: there is no [[reply]] in it")
    return Replay(replies)
