"""What every message on the wire has in common: frozen, strict, no unknown fields, finite numbers."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Id = Annotated[
    str,
    StringConstraints(pattern=r"^[a-z0-9][a-z0-9-]{0,31}$"),
    Field(description="an id: at most 32 lower-case letters, digits and hyphens"),
]
"""An identifier that is also one chunk of a key expression: no wildcard, no slash."""

Word = Annotated[
    str,
    StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,31}$"),
    Field(description="one word: at most 32 letters, digits and underscores, a letter first"),
]
"""An entry of a closed vocabulary: an object type, a property, an action."""

Text = Annotated[str, StringConstraints(max_length=2000)]
"""Free text for people. Never an instruction to a program."""

Vec2 = tuple[float, float]
Vec3 = tuple[float, float, float]
Probability = Annotated[float, Field(ge=0.0, le=1.0)]
Stamp = Annotated[float, Field(ge=0.0)]
"""Seconds on the mesh's clock (simulated or wall)."""


def unset(value: object) -> bool:
    """For `exclude_if`: a field that only some robots have is left out of the bytes of the others."""
    return value is None or value is False or value == ()


class Message(BaseModel):
    """A value on the wire. Validation is strict: no coercion of strings to numbers, no extra fields.

    What checks a message is built when the first one comes: every process knows all of them and few see more than a few.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False, defer_build=True)
