"""tokens: what a task has cost the language model, call by call."""

from typing import Annotated, Any

import typer

from console.mesh_commands import Json
from console.operate_commands import FAULTS, open_client
from console.output import checked, emit, fail
from wire.costs import STAND_IN
from wire.messages.operator import CallsReply, CallsRequest, TimedCall


def register(app: typer.Typer) -> None:
    app.command()(tokens)


def tokens(
    task: Annotated[str | None, typer.Argument(help="the task's id; the newest one when left out")] = None,
    json_: Json = False,
) -> None:
    """Every call of the language model that was made for a task, and the sums."""
    try:
        with open_client() as client:
            reply = client.ask("calls", checked(CallsRequest, task=task), CallsReply)
    except FAULTS as error:
        fail(str(error), json_)
    if not reply.known:
        fail(f"{reply.task}: {reply.text}", json_)
    emit(tokens_document(reply), tokens_text(reply), json_)


def tokens_document(reply: CallsReply) -> dict[str, Any]:
    return {"ok": True, **reply.model_dump(mode="json")}


def tokens_text(reply: CallsReply) -> str:
    """A line for each call, and one for the sums."""
    if not reply.calls:
        return f"{reply.task}: no language model was asked"
    head = (
        f"{'s':>9}  {'purpose':<12} {'model':<18} {'outcome':<12} {'prompt':>7} {'answer':>7} {'took':>8}  counted by"
    )
    lines = [head, *(_line(row) for row in reply.calls)]
    if reply.left_out:
        lines.append(f"and {reply.left_out} earlier calls, which the sums have")
    calls = len(reply.calls) + reply.left_out
    total = (
        f"{reply.prompt_tokens} + {reply.completion_tokens} = {reply.prompt_tokens + reply.completion_tokens} tokens"
    )
    stand_in = f" {STAND_IN}" if reply.stand_in else ""
    return "\n".join([*lines, f"{reply.task}: {total} in {calls} call{'s' if calls != 1 else ''}{stand_in}"])


def _line(row: TimedCall) -> str:
    call = row.call
    took = "kept" if call.cached else f"{call.latency_s:.1f} s"
    mark = f"  {STAND_IN}" if call.stand_in else ""
    counted_by = call.counted_by if call.prompt_tokens or call.completion_tokens else "-"
    return (
        f"{row.stamp_s:>9.1f}  {call.purpose:<12} {call.model:<18} {call.outcome:<12} {call.prompt_tokens:>7} "
        f"{call.completion_tokens:>7} {took:>8}  {counted_by}{mark}"
    )
