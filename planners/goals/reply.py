"""What a model replied, as plain values: checked for its shape, not yet for its sense."""

import json

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from planners.goals.offered import MOST_GOALS
from planners.prompt import one_line


class Wish(BaseModel):
    """One goal, or one restraint, in the words of the prompt."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    of: str = Field(min_length=1, max_length=400)
    """The words of the instruction that ask for it."""
    p: str = Field(max_length=32)
    a: str = Field(max_length=40)
    b: str | None = Field(default=None, max_length=40)
    a_in: str | None = Field(default=None, max_length=40)
    b_in: str | None = Field(default=None, max_length=40)
    all: bool = False
    n: int | None = Field(default=None, ge=1, le=12)
    out: tuple[str, ...] = Field(default=(), alias="except", max_length=6, strict=False)
    step: int | None = Field(default=None, ge=1, le=MOST_GOALS)


class Reply(BaseModel):
    """The whole of it."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    goals: tuple[Wish, ...] = Field(max_length=MOST_GOALS, strict=False)
    keep: tuple[Wish, ...] = Field(default=(), max_length=MOST_GOALS, strict=False)
    talk: tuple[str, ...] = Field(default=(), max_length=8, strict=False)
    unknown: tuple[str, ...] = Field(default=(), max_length=8, strict=False)
    ask: str = Field(default="", max_length=400)

    def wishes(self) -> list[tuple[Wish, bool]]:
        """Goals, then restraints; with True for a restraint."""
        return [*((wish, False) for wish in self.goals), *((wish, True) for wish in self.keep)]


class Misshapen(Exception):
    """No such object is in the reply; the text is a sentence for the model."""


def read_reply(text: str) -> Reply:
    """The JSON object of a reply, with or without prose around it. Raises Misshapen."""
    found = _object(text)
    if found is None:
        raise Misshapen("there is no whole JSON object with a list of goals in it")
    try:
        return Reply.model_validate(found)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        raise Misshapen(f"{one_line(where, 60)}: {one_line(first['msg'], 80)}") from None


def _object(text: str) -> object:
    decoder = json.JSONDecoder()
    at = text.find("{")
    while at >= 0:
        try:
            value, _ = decoder.raw_decode(text, at)
        except (ValueError, RecursionError):
            value = None
        if isinstance(value, dict) and "goals" in value:
            return value
        at = text.find("{", at + 1)
    return None
