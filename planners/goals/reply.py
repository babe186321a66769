"""What a model replied, as plain values: checked for its shape, not yet for its sense."""

import json
import re
from collections.abc import Iterator

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from planners.goals.offered import MOST_GOALS
from planners.prompt import one_line

_LIST_END = re.compile(r"\}\s*\]")


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
    """The JSON object of a reply, with or without prose around it; of one that broke off what is whole. Raises Misshapen.

    Whether that is all of it the critics see: they hold it against the instruction.
    """
    found = _object(text) or _whole_parts(text)
    if found is None:
        raise Misshapen("there is no JSON object with a list of goals in it")
    try:
        return Reply.model_validate(found)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        raise Misshapen(f"{one_line(where, 60)}: {one_line(first['msg'], 80)}") from None


def _object(text: str) -> dict[str, object] | None:
    """The first whole object that has goals."""
    return next((value for value in _objects(text) if "goals" in value), None)


def _whole_parts(text: str) -> dict[str, object] | None:
    """Of a reply that broke off after its list of goals: these, and the whole restraints."""
    goals, _, rest = text.partition('"goals"')[2].partition('"keep"')
    found = [value for value in _objects(goals) if "of" in value]
    if not found or _LIST_END.search(goals) is None:
        return None
    return {"goals": found, "keep": [value for value in _objects(rest) if "of" in value]}


def _objects(text: str) -> Iterator[dict[str, object]]:
    """Every whole JSON object, from the left; none within another."""
    decoder = json.JSONDecoder()
    at = text.find("{")
    while at >= 0:
        try:
            value, end = decoder.raw_decode(text, at)
        except (ValueError, RecursionError):
            end = at + 1
        else:
            yield value
        at = text.find("{", end)
