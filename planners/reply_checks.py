"""Whether what a model server sent is a whole answer to the whole question. Pure: sizes, counts and texts."""

import json
from dataclasses import dataclass

from planners.asking import Question
from wire.messages.plan import CallOutcome

_CHARACTERS_PER_TOKEN = 3.0
"""Few, so that what is estimated is rather too much."""
_PICTURE_TOKENS = 1200
_MISSING = 0.5
"""Fewer tokens than this part of the estimate cannot have been the whole prompt."""
_HALF_WINDOW = 0.8
"""The same, where the count is the one that a server leaves of a prompt that does not fit."""


@dataclass
class Heard:
    """What has come of an answer so far."""

    text: str = ""
    thinking: str = ""
    pieces: int = 0
    done: bool = False
    done_reason: str = ""
    prompt_tokens: int | None = None
    completion_tokens: int | None = None


@dataclass(frozen=True)
class Fault:
    """Why there is no answer, for programs and for people; `again`: another try may get one."""

    outcome: CallOutcome
    text: str
    again: bool = True


def estimate(question: Question) -> int:
    """Tokens of the prompt, rather too many than too few."""
    characters = len(question.system) + len(question.user)
    return int(characters / _CHARACTERS_PER_TOKEN) + _PICTURE_TOKENS * len(question.pictures)


def misfit(question: Question, num_ctx: int) -> Fault | None:
    """A prompt too long for the context is cut without a word by the server: it is not sent."""
    tokens = estimate(question)
    if tokens + question.max_tokens <= num_ctx:
        return None
    return Fault(
        "truncated",
        f"about {tokens} tokens of prompt and {question.max_tokens} of answer do not fit into a context of {num_ctx}: "
        "set a larger planner.num_ctx in the site file",
        again=False,
    )


def fault_of(heard: Heard, question: Question, num_ctx: int) -> Fault | None:
    """What is wrong with an answer that has come to its end."""
    if not heard.done:
        return Fault("looping", f"its answer came to no end after {heard.pieces} pieces: it repeated itself")
    if _was_cut(heard.prompt_tokens, question, num_ctx):
        return Fault(
            "truncated",
            f"the server read only {heard.prompt_tokens} tokens of a prompt of about {estimate(question)}: its context "
            "is shorter than planner.num_ctx says",
            again=False,
        )
    if heard.done_reason == "length":
        return Fault("truncated", f"the answer was cut after {question.max_tokens} tokens", again=False)
    if not text_of(heard, question):
        thought = " after it had thought" if heard.thinking else ""
        return Fault("empty", f"the model said nothing{thought}")
    return None


def text_of(heard: Heard, question: Question) -> str:
    """The answer: the text, or where that is empty a JSON that a model has put into its thoughts by mistake."""
    if heard.text.strip() or question.schema is None:
        return heard.text.strip() and heard.text
    try:
        json.loads(heard.thinking)
    except ValueError:
        return ""
    return heard.thinking


def _was_cut(prompt_tokens: int | None, question: Question, num_ctx: int) -> bool:
    """By the count alone: it is made after the cutting, so it never exceeds the context."""
    expected = estimate(question)
    if prompt_tokens is None or question.pictures or expected < 40:
        return False
    left_by_cutting = abs(prompt_tokens - (num_ctx // 2 + 2)) <= 2
    return prompt_tokens < expected * (_HALF_WINDOW if left_by_cutting else _MISSING)
