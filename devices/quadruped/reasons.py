"""What a gripper driver's words mean: the first pattern that is found in them names the code."""

from wire.messages.command import ReasonCode

_MEANINGS: tuple[tuple[str, ReasonCode], ...] = (
    ("already", "already"),
    ("hand is full", "hand_full"),
    ("not holding", "not_holding"),
    ("hand is empty", "not_holding"),
    ("closed", "closed"),
    ("out of reach", "unreachable"),
    ("blocked", "blocked"),
    ("in the way", "blocked"),
    ("no free spot", "blocked"),
    ("out of sight", "blocked"),
    ("nothing", "not_there"),
    ("there is no ", "not_there"),
    ("not there", "not_there"),
    ("still busy", "driver"),
)


def code_of(reason: str) -> ReasonCode:
    """`precondition` when the words say none of the others: the thing is there, but this cannot be done to it."""
    words = reason.lower()
    return next((code for pattern, code in _MEANINGS if pattern in words), "precondition")
