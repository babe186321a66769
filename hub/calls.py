"""The calls of a model that were made for a task, from the journal."""

import json
from collections.abc import Sequence

from hub.journal import Journal
from wire.messages.operator import CallsReply, TimedCall
from wire.messages.plan import ModelCall

_SHOWN = 256


def calls_of(task: str | None, known: Sequence[str], journal: Journal) -> CallsReply:
    """Of the task named, or of the newest one."""
    wanted = task or (known[-1] if known else "none")
    if wanted not in known:
        text = f"there is no such task; known are: {', '.join(known) or 'none yet'}"
        return CallsReply(task=wanted, known=False, text=text[:2000])
    calls = []
    for stamp_s, body in journal.bodies("call"):
        row = json.loads(body)
        if row["task"] == wanted:
            calls.append(TimedCall(stamp_s=stamp_s, call=ModelCall.model_validate(row["call"])))
    return CallsReply(
        task=wanted,
        known=True,
        calls=tuple(calls[-_SHOWN:]),
        left_out=max(len(calls) - _SHOWN, 0),
        prompt_tokens=sum(row.call.prompt_tokens for row in calls),
        completion_tokens=sum(row.call.completion_tokens for row in calls),
        stand_in=any(row.call.stand_in for row in calls),
    )
