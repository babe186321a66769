"""What a device asks a vision model, through the planner's process: one picture, and how it is to be read."""

from typing import Annotated

from pydantic import Field, StringConstraints

from wire.messages.plan import ModelCall
from wire.model import Id, Message, Text, Word

PICTURE_BYTES = 600_000
"""Of one picture that a model is shown: a 1280x960 JPEG of high quality."""
Prompt = Annotated[str, StringConstraints(max_length=8000)]


class LookRequest(Message):
    """One question about one picture. The planner's process puts it to its model as it is."""

    asker: Id
    """The camera or robot: each has at most one question waiting, and a newer one takes its place."""
    purpose: Word = "look"
    picture: bytes = Field(min_length=1, max_length=PICTURE_BYTES)
    """A JPEG or PNG file."""
    system: Prompt
    user: Prompt
    answer_schema: Annotated[str, StringConstraints(max_length=32_000)] = ""
    """JSON schema, as text, that the reply is held to; empty for free text."""
    max_tokens: int = Field(default=768, ge=1, le=4096)
    seed: int = Field(default=0, ge=0)


class LookReply(Message):
    """What the model said, word by word and not yet believed, or why it said nothing."""

    text: Annotated[str, StringConstraints(max_length=32_000)] = ""
    reason: Text = ""
    """Empty when there is a text."""
    call: ModelCall | None = None
    """None when no model was asked."""
